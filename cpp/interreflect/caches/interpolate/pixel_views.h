/// Pixels as caches serve them: where, about which normal, and over which glossy lobe.
#pragma once
#include <span>

#include "data/caches.h"
#include "data/gbuffer.h"
#include "data/scene.h"
#include "voxels/glossy/reflections.h"

namespace interreflect {

struct PixelViews {
    static constexpr int capacity = Reflections::capacity;

    struct View {
        std::uint32_t pixel = no_cache;
        vec3 position{0}, normal{0};
        vec2 screen{0};       // pixels from the upper left corner
        bool glossy = false;  // whether there is a lobe; what follows is its
        vec3 direction{0};    // unit
        float level = 0.0f;   // of the maps, between the first and the last
        vec3 albedo{0};       // directional albedo at this view
    };
    int count = 0;
    View view[capacity];
};

/// The way from pixels to what they look up, in maps of one kind.
class PixelViewer {
  public:
    PixelViewer(const GBuffer& gbuffer, const Scene& scene, const ConvolvedCaches& caches);
    /// Up to PixelViews::capacity pixels that see a surface.
    void look(std::span<const std::uint32_t> pixels, PixelViews& views) const;

  private:
    float level_of(std::size_t pixel, float half_angle) const;

    const GBuffer& gbuffer_;
    const Scene& scene_;
    const ConvolvedCaches& caches_;
    LobeTables tables_;
};

/// cos of the angle from its middle at which a lobe, seen from straight above, has fallen to 1 % of its peak: Phong's about the
/// mirrored view, cos^n = .01 [Rehfeld et al. 2014, 3.3]; those of microfacets twice as far as their half vectors do; 0 at least.
float one_percent_cosine(Lobe lobe, float alpha, float exponent);

}  // namespace interreflect
