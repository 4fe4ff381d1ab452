#include "caches/fill/traced_fill.h"

#include <algorithm>
#include <vector>

#include "caches/fill/texels.h"
#include "data/environment.h"
#include "math/hemisphere_map.h"
#include "math/owen_sobol.h"
#include "math/parallel.h"
#include "voxels/march/voxel_lookup.h"

namespace interreflect {
namespace {

constexpr float least_cosine = 1e-6f;  // a ray on the rim itself

/// What the rays of one texel see on average, weighted by their cosines.
struct Seen {
    vec3 radiance{0}, sky{0};
    float open = 0;
};

/// The directions of one texel that are traced, and their weights, which sum up to 1 with those below the cache's surface: these
/// meet it, and see nothing.
struct Bundle {
    std::vector<Ray> rays;
    std::vector<float> weights;
    std::vector<Hit> hits;
};

struct TexelTracer {
    const TracedFill& technique;
    const CachePlaces& at;
    Pyramids pyramids;
    const Scene& scene;
    const Intersector& intersector;
    std::uint32_t seed;

    Seen trace(std::size_t cache, int x, int y, Bundle& bundle) const {
        spread(cache, x, y, bundle);
        intersector.nearest_coherent(bundle.rays, bundle.hits);
        Seen seen;
        for (std::size_t i = 0; i < bundle.rays.size(); ++i) {
            const vec3& direction = bundle.rays[i].direction;
            const float weight = bundle.weights[i];
            if (bundle.hits[i].valid()) {
                seen.radiance += radiance_at_hit(pyramids, scene, bundle.hits[i], direction) * weight;
            } else {
                seen.open += weight;
                seen.sky += environment_radiance(scene, direction) * weight;
            }
        }
        return seen;
    }

    void spread(std::size_t cache, int x, int y, Bundle& bundle) const {
        const Frame frame(at.normal[cache]);
        const vec3 origin = at.position[cache] + at.geometric_normal[cache] * at.offset[cache];
        const int n = technique.resolution;
        const std::uint32_t key = hash_combine(hash_combine(seed, at.pixel[cache]), static_cast<std::uint32_t>(y * n + x));
        bundle.rays.clear(), bundle.weights.clear();
        float sum = 0;
        for (int i = 0; i < technique.samples; ++i) {
            const Bits2 bits = owen_sobol(static_cast<std::uint32_t>(i), key);
            const vec2 inside(static_cast<float>(x) + unit_float(bits.x), static_cast<float>(y) + unit_float(bits.y));
            const vec3 local = hemisphere_direction(inside / static_cast<float>(n));
            const float cosine = std::max(local.z, least_cosine);
            sum += cosine;
            const vec3 direction = frame.to_world(local);
            if (glm::dot(direction, at.geometric_normal[cache]) <= 0.0f) continue;
            bundle.rays.push_back({origin, 0.0f, direction}), bundle.weights.push_back(cosine);
        }
        for (float& weight : bundle.weights) weight /= sum;
        bundle.hits.resize(bundle.rays.size());
    }
};

}  // namespace

FilledCaches fill(const TracedFill& technique, std::shared_ptr<const CachePlaces> places, Pyramids pyramids, const Scene& scene,
                  const Intersector& intersector, std::uint32_t seed) {
    FilledCaches filled = empty_maps(std::move(places), technique.resolution, pyramids.front()->scale, scene);
    const TexelTracer tracer{technique, *filled.places, pyramids, scene, intersector, seed};
    std::vector<std::uint64_t> rays(filled.places->size(), 0);
    parallel_pieces(filled.places->size(), [&](std::size_t cache) {
        thread_local Bundle bundle;
        std::size_t texel = 4 * cache * filled.texels_each();
        for (int y = 0; y < technique.resolution; ++y)
            for (int x = 0; x < technique.resolution; ++x, texel += 4) {
                const Seen seen = tracer.trace(cache, x, y, bundle);
                rays[cache] += bundle.rays.size();
                write_texel(filled.texels.data() + texel, seen.radiance / filled.scale, seen.open);
                if (!filled.sky.empty()) write_texel(filled.sky.data() + texel, seen.sky / filled.sky_scale, 0.0f);
            }
    });
    for (const auto one : rays) filled.counts.rays += one;
    return filled;
}

}  // namespace interreflect
