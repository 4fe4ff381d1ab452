/// All paths of one tile at once, stage by stage, so that rays of a kind are traced together and vectors stay full.
///
/// Paths go in the order of their pattern: the pixels that share their random numbers follow each other, so their rays leave in
/// about the same direction and fill packets well. Each pixel's own numbers are uniform, so nothing is biased by it.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "data/camera.h"
#include "data/counts.h"
#include "math/parallel.h"
#include "reference/path_kernel.h"
#include "reference/path_lanes.h"
#include "reference/path_tracing.h"
#include "reference/sample_sequence.h"
#include "visibility/surface_kernel.h"

namespace interreflect {

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
    SurfaceKernel surfaces;

    static constexpr int every_vertex = 1 << 30;
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
    /// Packets between tracing and shading: as many as fit a first-level cache.
    static constexpr int together = 8;
    struct Workspace {
        PathLanes first;  // at the first hits, in the order of blocks
        PathLanes vertices[2];
        StepLanes primary, steps;
        ShadowLanes shadows;
        LightColumns lights;
        PairTable places, pairs[pairs_a_vertex];
        NumberColumn order{};
        RayPacket rays[together];
        SurfacePacket surfaces[together];
    };

    void make_patterns(std::uint32_t n);
    void make_orders(const Tile& tile);
    void load_pairs(int vertex, int sample);
    void load_places(int sample);
    void trace_primary(const Tile& tile, std::vector<vec3>& to);
    void trace_sample(int sample);
    bool repeats() const { return in_.pixel == PixelFilter::centre; }
    bool roulette_at(int vertex) const;
    Connecting connecting(const PathLanes& paths, int vertex, bool weighed);
    void add_delta_lights(const PathLanes& paths, std::vector<vec3>& to);
    void add_emitters(int vertex);
    void add_environment(int vertex);
    void trace_shadows(std::vector<vec3>& to);
    bool continue_all(int vertex) const;
    template <class Meeting>
    void trace_steps(const StepLanes& steps, bool alone, const Meeting& meeting, PathLanes* paths);
    void take_steps(int vertex);
    vec3 emission_met(std::uint32_t step, const Hit& hit, const SurfacePoint* seen) const;
    float environment_pdf(const vec3& normal, const vec3& direction) const;
    std::vector<vec3>& image(int vertex) { return vertex == 0 ? direct_ : indirect_; }

    const Integrand& in_;
    const SampleSequence* sequence_ = nullptr;
    std::vector<std::uint32_t> pattern_of_pixel_, whole_by_pattern_, whole_by_block_;
    std::uint32_t patterns_ = 1;
    std::vector<std::uint32_t> by_pattern_;  // pixels of the current tile
    std::unique_ptr<Workspace> at_;
    PathLanes *paths_, *next_;  // of at_->vertices, in turn
    std::vector<vec3> direct_, indirect_, certain_;
    Counts counts_;
};

}  // namespace interreflect
