#include "caches/fill/traced_fill.h"

#include <vector>

#include "caches/fill/texels.h"
#include "data/environment.h"
#include "math/hemisphere_map.h"
#include "math/owen_sobol.h"
#include "math/parallel.h"
#include "voxels/march/voxel_lookup.h"

namespace interreflect {
namespace {

/// What the rays of one texel sum up.
struct Seen {
    vec3 radiance{0}, sky{0};
    float open = 0;
};

/// Rays below the cache's surface meet it: they see nothing, and are not traced.
struct TexelTracer {
    const TracedFill& technique;
    const CachePlaces& at;
    Pyramids pyramids;
    const Scene& scene;
    const Intersector& intersector;
    std::uint32_t seed;

    Seen trace(std::size_t cache, int x, int y, std::vector<Ray>& rays, std::vector<Hit>& hits) const {
        const Frame frame(at.normal[cache]);
        const vec3 origin = at.position[cache] + at.geometric_normal[cache] * at.offset[cache];
        const int n = technique.resolution;
        const std::uint32_t key = hash_combine(hash_combine(seed, at.pixel[cache]), static_cast<std::uint32_t>(y * n + x));
        rays.clear();
        for (int i = 0; i < technique.samples; ++i) {
            const Bits2 bits = owen_sobol(static_cast<std::uint32_t>(i), key);
            const vec2 inside(static_cast<float>(x) + unit_float(bits.x), static_cast<float>(y) + unit_float(bits.y));
            const vec3 direction = frame.to_world(hemisphere_direction(inside / static_cast<float>(n)));
            if (glm::dot(direction, at.geometric_normal[cache]) > 0.0f) rays.push_back({origin, 0.0f, direction});
        }
        hits.resize(rays.size());
        intersector.nearest_coherent(rays, hits);
        Seen seen;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (hits[i].valid()) {
                seen.radiance += radiance_at_hit(pyramids, scene, hits[i], rays[i].direction);
            } else {
                seen.open += 1.0f;
                seen.sky += environment_radiance(scene, rays[i].direction);
            }
        }
        return seen;
    }
};

}  // namespace

FilledCaches fill(const TracedFill& technique, std::shared_ptr<const CachePlaces> places, Pyramids pyramids, const Scene& scene,
                  const Intersector& intersector, std::uint32_t seed) {
    FilledCaches filled = empty_maps(std::move(places), technique.resolution, pyramids.front()->scale, scene);
    const TexelTracer tracer{technique, *filled.places, pyramids, scene, intersector, seed};
    const float each = 1.0f / static_cast<float>(technique.samples);
    std::vector<std::uint64_t> rays(filled.places->size(), 0);
    parallel_pieces(filled.places->size(), [&](std::size_t cache) {
        thread_local std::vector<Ray> bundle;
        thread_local std::vector<Hit> hits;
        std::size_t texel = 4 * cache * filled.texels_each();
        for (int y = 0; y < technique.resolution; ++y)
            for (int x = 0; x < technique.resolution; ++x, texel += 4) {
                const Seen seen = tracer.trace(cache, x, y, bundle, hits);
                rays[cache] += bundle.size();
                write_texel(filled.texels.data() + texel, seen.radiance * (each / filled.scale), seen.open * each);
                if (!filled.sky.empty()) write_texel(filled.sky.data() + texel, seen.sky * (each / filled.sky_scale), 0.0f);
            }
    });
    for (const auto one : rays) filled.counts.rays += one;
    return filled;
}

}  // namespace interreflect
