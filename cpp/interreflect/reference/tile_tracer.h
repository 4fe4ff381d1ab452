/// All paths of one tile at once, stage by stage, so that rays of a kind are traced together.
///
/// Paths go in the order of their pattern: the pixels that share their random numbers follow each other, so their rays leave in
/// about the same direction and fill packets well. Each pixel's own numbers are uniform, so nothing is biased by it.
#pragma once
#include <array>
#include <vector>

#include "data/camera.h"
#include "data/counts.h"
#include "math/parallel.h"
#include "reference/path_tracing.h"
#include "reference/sample_sequence.h"
#include "visibility/surface.h"

namespace interreflect {

inline constexpr int tracing_tile = 32;
inline constexpr int tracing_tile_pixels = tracing_tile * tracing_tile;

/// What is integrated: the same for all tiles of a picture.
struct Integrand {
    const Scene& scene;
    const Intersector& rays;
    const LightSampler& lights;
    CameraRays camera;
    int last_vertex;  // the last one that reflects; `every_vertex`: no end
    PixelFilter pixel;
    int pattern;
    std::uint32_t seed;

    static constexpr int every_vertex = 1 << 30;
};

/// Rays towards lights, and what each adds where nothing is in its way.
struct ShadowBatch {
    std::vector<Ray> rays;
    std::vector<vec3> light;
    std::vector<std::uint32_t> pixel;
    std::vector<std::uint8_t> blocked;

    void add(const SurfacePoint& at, const vec3& direction, float distance, const vec3& radiance, std::uint32_t to);
    /// Traces and empties the batch.
    void trace(const Intersector& intersector, bool coherent, std::vector<vec3>& image, Counts& counts);
};

class TileTracer {
  public:
    explicit TileTracer(const Integrand& integrand);

    /// Samples [first, end) of every pixel of the tile; sums in direct() and indirect(), tracing_tile pixels a row. Through pixel
    /// centres, emission and delta lights of the first hit are the same for every sample: the pass with first = 0 puts them,
    /// once, into certain() instead.
    void trace(const Tile& tile, int first, int end);
    const std::vector<vec3>& certain() const { return certain_; }
    const std::vector<vec3>& direct() const { return direct_; }
    const std::vector<vec3>& indirect() const { return indirect_; }
    const Counts& counts() const { return counts_; }

  private:
    /// Pairs of random numbers: one for the place in the pixel, then so many a vertex.
    enum Pair : std::uint32_t { emitter_point, environment_point, reflection, choices, roulette, pairs_a_vertex };
    struct Path {
        vec3 direction;  // of travel, towards `at`
        vec3 throughput;
        std::uint32_t pixel, pattern;
        const SurfacePoint* at;
    };
    /// A path's next ray.
    struct Step {
        vec3 throughput;
        float pdf;
        std::uint32_t path;
    };

    void make_orders(const Tile& tile);
    void load_pair(Pair which, int vertex, int sample);
    vec2 pair(Pair which, const Path& path) const {
        return SampleSequence::join(of_sample_[which], of_pattern_[which][path.pattern]);
    }
    void trace_primary(const Tile& tile, const SampleSequence& sequence, int sample);
    void trace_sample(int sample);
    bool repeats() const { return in_.pixel == PixelFilter::centre; }
    void add_first_lights(std::vector<vec3>& to);
    void add_delta(int light, const SurfacePoint& at, const vec3& direction, const vec3& throughput, std::uint32_t pixel);
    void add_delta_lights(int vertex);
    void add_emitters(int vertex);
    void add_environment(int vertex);
    void add_light_sample(const Path& path, const LightDirection& light, bool continues);
    bool continues(const SurfacePoint& at, int vertex) const;
    LightDirection sample_environment(const SurfacePoint& at, const vec2& u) const;
    float environment_pdf(const SurfacePoint& at, const vec3& direction) const;
    void choose_steps(int vertex);
    void take_steps(int vertex);
    vec3 emission_met(const Step& step, const Hit& hit, const SurfacePoint* seen) const;
    std::vector<vec3>& image(int vertex) { return vertex == 0 ? direct_ : indirect_; }

    const Integrand& in_;
    const SampleSequence* sequence_ = nullptr;
    std::array<Bits2, pairs_a_vertex> of_sample_;
    std::array<std::vector<Bits2>, pairs_a_vertex> of_pattern_;
    std::vector<Bits2> place_of_pattern_;  // in the pixel
    std::vector<std::uint32_t> pattern_of_pixel_, whole_by_pattern_, whole_by_block_;
    std::vector<std::uint32_t> by_pattern_, by_block_;    // pixels of the current tile
    std::vector<SurfacePoint> first_;                     // by pixel
    std::vector<vec3> first_direction_, first_emission_;  // by pixel
    std::vector<std::uint8_t> first_hit_;
    std::vector<SurfacePoint> surfaces_[2];
    std::vector<Path> paths_, next_paths_;
    std::vector<Step> steps_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    ShadowBatch shadows_;
    std::vector<vec3> direct_, indirect_, certain_;
    Counts counts_;
};

}  // namespace interreflect
