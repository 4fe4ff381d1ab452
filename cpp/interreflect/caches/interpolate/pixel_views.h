/// Pixels as caches serve them: where, about which normal, and over which glossy lobe.
#pragma once
#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "data/caches.h"
#include "data/gbuffer.h"
#include "data/scene.h"
#include "math/parallel.h"
#include "voxels/glossy/reflections.h"

namespace interreflect {

/// Parallel arrays. Beyond `count`, up to a whole vector of lanes, stand pixels that no cache reaches.
struct PixelViews {
    static constexpr int capacity = Reflections::capacity, block_size = 16, most_lanes = 16;
    static constexpr int group = most_lanes, groups = capacity / group;
    static constexpr float no_lobe = -2.0f;  // further than a level below the first
    static constexpr int most_levels = 32;
    static_assert(block_size * block_size <= capacity && capacity % most_lanes == 0);

    /// One of them.
    struct View {
        std::uint32_t pixel;
        vec3 position, normal;
        vec2 screen;  // pixels from the upper left corner
        bool glossy;  // whether there is a lobe; what follows is its
        vec3 direction, albedo;
        float level;
    };
    View view(int i) const {
        return {pixel[i],
                {position[0][i], position[1][i], position[2][i]},
                {normal[0][i], normal[1][i], normal[2][i]},
                {screen[0][i], screen[1][i]},
                level[i] >= 0.0f,
                {direction[0][i], direction[1][i], direction[2][i]},
                {albedo[0][i], albedo[1][i], albedo[2][i]},
                level[i]};
    }

    alignas(64) std::uint32_t pixel[capacity];
    alignas(64) float position[3][capacity], normal[3][capacity], screen[2][capacity];
    alignas(64) float direction[3][capacity];  // unit; 0 without a lobe, as is the next
    alignas(64) float albedo[3][capacity];     // directional albedo at this view
    alignas(64) float level[capacity];         // of the maps, between the first and the last; no_lobe

    /// Of one coordinate within each group of pixels; empty where there are none. What is not finite is left out.
    struct Bounds {
        alignas(64) float lower[groups], upper[groups];
        void clear() {
            std::fill_n(lower, groups, std::numeric_limits<float>::infinity());
            std::fill_n(upper, groups, -std::numeric_limits<float>::infinity());
        }
    };
    Bounds position_bounds[3], normal_bounds[3], screen_bounds[2];
    int count = 0;
    int finest = 0, coarsest = -1;  // levels that lobes are read from
};

/// The way from pixels to what they look up, in maps of one kind.
class PixelViewer {
  public:
    PixelViewer(const GBuffer& gbuffer, const Scene& scene, const ConvolvedCaches& caches);
    /// Up to PixelViews::capacity pixels that see a surface.
    void look(std::span<const std::uint32_t> pixels, PixelViews& views) const;
    /// Those of a block of PixelViews::block_size, 4 x 4 at a time: caches tend to reach all lanes of a vector or none.
    void look(const Tile& block, PixelViews& views) const;

  private:
    void look_up(PixelViews& views) const;
    void find_levels(const Reflections& lobes, PixelViews& views) const;
    float level_of(float cosine) const;

    const GBuffer& gbuffer_;
    const Scene& scene_;
    const ConvolvedCaches& caches_;
    LobeTables tables_;
    std::optional<float> only_level_;  // where all lobes are read from the same
};

/// cos of the angle from its middle at which a lobe, seen from straight above, has fallen to 1 % of its peak: Phong's about the
/// mirrored view, cos^n = .01 [Rehfeld et al. 2014, 3.3]; those of microfacets twice as far as their half vectors do; 0 at least.
float one_percent_cosine(Lobe lobe, float alpha, float exponent);

}  // namespace interreflect
