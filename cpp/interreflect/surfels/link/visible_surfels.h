/// What a cache sees of the surfels.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "data/light_caches.h"
#include "data/scene.h"
#include "surfels/cluster/post_order.h"
#include "surfels/place/surfel_grid.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Rays to surfels, a few of each disk, as in the paper, tell which are seen; equation 2, with the sender's cosine turned round
/// (ERRATA), what solid angle. That sum over surfels holds where they are many to the distance. What is nearer than four of
/// their spacings is looked for by rays in fixed directions (equation 8), each of which counts for the surfel next to what it
/// meets.
struct Sampling {
    int rays = 1;         // to each surfel
    int near_rays = 512;  // directions over the sphere; 0: rays to surfels alone
};

/// A direction in which a surfel was found.
struct NearHit {
    std::uint32_t surfel;
    vec3 direction;
};

/// What a cache sees; kept from one cache to the next, for its memory.
struct SeenSurfels {
    vec3 from{0};                    // where rays start
    std::vector<float> solid_angle;  // of every surfel, sr
    std::vector<NearHit> near;       // by surfel; each stands for `near_weight` of the surfel's solid angle
    float near_weight = 0;

    explicit SeenSurfels(std::size_t surfels) : solid_angle(surfels) {}
    /// Calls add(direction, solid angle) so that the surfel's whole solid angle is spread over the directions in which it was
    /// seen.
    template <class Add>
    void for_each_direction(std::uint32_t surfel, const vec3& position, const Add& add) const {
        float rest = solid_angle[surfel];
        if (!(rest > 0.0f)) return;
        auto hit = std::ranges::lower_bound(near, surfel, {}, &NearHit::surfel);
        for (; hit != near.end() && hit->surfel == surfel; ++hit) {
            add(hit->direction, near_weight);
            rest -= near_weight;
        }
        // More than is left over by rounding: rays to the surfel itself met it.
        if (rest > 1e-3f * solid_angle[surfel]) add(glm::normalize(position - from), rest);
    }
};

class VisibleSurfels {
  public:
    VisibleSurfels(const ClusteredSurfels& surfels, const Scene& scene, const Intersector& intersector, const Sampling& sampling);

    /// Caches with a normal see their hemisphere alone. `only`: the surfels to which rays are sent, for all of which each of
    /// them counts `weight` times; none: all.
    void look(const CacheSites& sites, std::size_t cache, std::span<const std::uint32_t> only, float weight, SeenSurfels& seen,
              Counts& counts) const;

  private:
    void look_near(const vec3& normal, SeenSurfels& seen, Counts& counts) const;
    std::uint32_t surfel_at(const Hit& hit, const vec3& direction) const;

    const Surfels& surfels_;
    const Scene& scene_;
    const Intersector& intersector_;
    std::vector<vec2> disk_;
    std::vector<vec3> directions_;
    std::vector<float> offset_;  // of every surfel: how far off it rays end
    float near_ = 0;             // scene units
    SurfelGrid grid_;
};

}  // namespace interreflect
