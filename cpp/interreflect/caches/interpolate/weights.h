/// How much a cache counts for a pixel.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "caches/interpolate/pixel_views.h"
#include "data/technique.h"

namespace interreflect {

struct WeightKnobs {
    double radius = 2.0;
    double world_radius = 1.0;
    double max_angle = 60.0;
    std::string uncovered = "nearest";

    bool operator==(const WeightKnobs&) const = default;
    static constexpr auto params = std::tuple{
        Param{"radius", &WeightKnobs::radius, "how far from a cache pixels are served on the screen", Unit::tiles,
              between(0, 64)},
        Param{"world_radius", &WeightKnobs::world_radius,
              "how far in space, in lengths of a tile on the surface where the cache stands", Unit::tiles, between(0, 1e3)},
        Param{"max_angle", &WeightKnobs::max_angle, "largest angle between a pixel's normal and a cache's", Unit::degrees,
              above_up_to(0, 180)},
        Param{"uncovered", &WeightKnobs::uncovered,
              "what lights pixels that no cache serves: the `nearest` one on their side (or, where there is none, their own), or "
              "their `own`",
              Unit::none, one_of("nearest|own")}};
};

/// w_w = (1 - |p - c|^2 / r_w^2)^+ in space and w_s, the same on the screen [Rehfeld et al. 2014, 3.3; of the printed squares of
/// vectors, their squared norms: ERRATA], the lesser of the two, or w_w alone; times how far the normals agree: from 1 down to 0
/// at the largest angle [Scherzer et al. 2012], so that no weight ends with an edge.
class CacheWeights {
  public:
    CacheWeights(const WeightKnobs& knobs, const CachePlaces& places, bool world_alone);

    /// Pixels; infinite where the screen does not matter.
    float screen_radius() const { return screen_radius_; }
    float world_radius(std::size_t cache) const { return world_radius_ * places_.footprint[cache]; }

    /// One cache's: 1 - squared distance * inverse, and cosine * slope + start. Both fall short everywhere for one without reach.
    struct Terms {
        Frame frame;  // about its normal
        vec3 position;
        vec2 screen;
        float world_inverse, screen_inverse, slope, start;
    };
    const Terms& of(std::size_t cache) const { return terms_[cache]; }
    float weight(std::size_t cache, const PixelViews::View& view) const {
        const Terms& terms = of(cache);
        const vec3 away = view.position - terms.position;
        const vec2 aside = view.screen - terms.screen;
        const float weight =
            std::min(1.0f - glm::dot(away, away) * terms.world_inverse, 1.0f - glm::dot(aside, aside) * terms.screen_inverse);
        const float agreement = glm::dot(view.normal, terms.frame.normal) * terms.slope + terms.start;
        return std::max(weight, 0.0f) * std::clamp(agreement, 0.0f, 1.0f);
    }

  private:
    const CachePlaces& places_;
    float world_radius_, screen_radius_;
    Buffer<Terms> terms_;
};

}  // namespace interreflect
