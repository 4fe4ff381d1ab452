#include "caches/fill/cone_fill.h"

#include <algorithm>
#include <cmath>

#include "caches/fill/texels.h"
#include "math/hemisphere_map.h"
#include "math/parallel.h"
#include "voxels/march/cone_caster.h"
#include "voxels/march/cone_environment.h"

namespace interreflect {
namespace {

/// Of one texel: a uniform cone of half angle a covers 2 pi (1 - cos a), the texel 2 pi / n^2.
float texel_half_angle(int resolution) {
    return std::acos(1.0f - 1.0f / (static_cast<float>(resolution) * static_cast<float>(resolution)));
}

std::vector<vec3> texel_directions(int resolution) {
    std::vector<vec3> directions;
    for (int y = 0; y < resolution; ++y)
        for (int x = 0; x < resolution; ++x) directions.push_back(hemisphere_direction(map_texel_centre(x, y, resolution)));
    return directions;
}

}  // namespace

FilledCaches fill(const ConeFill& technique, std::shared_ptr<const CachePlaces> places, Pyramids pyramids, const Scene& scene,
                  const Intersector&, std::uint32_t) {
    FilledCaches filled = empty_maps(std::move(places), technique.resolution, pyramids.front()->scale, scene);
    const CachePlaces& at = *filled.places;
    const float half_angle = technique.half_angle > 0.0 ? static_cast<float>(technique.half_angle) * degrees_to_radians
                                                        : texel_half_angle(technique.resolution);
    const ConeCaster caster(pyramids, technique, half_angle);
    const ConeEnvironment environment(scene, half_angle);
    const std::vector<vec3> directions = texel_directions(technique.resolution);
    const std::size_t each = directions.size(), cones = at.size() * each;
    std::vector<Counts> counts((cones + ConeBatch::capacity - 1) / ConeBatch::capacity);
    parallel_blocks(cones, ConeBatch::capacity, [&](std::size_t begin, std::size_t end) {
        thread_local ConeBatch batch;
        std::array<ConeCaster::Cone, ConeBatch::capacity> chosen;
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t cache = i / each;
            chosen[i - begin] = {at.position[cache], at.geometric_normal[cache],
                                 Frame(at.normal[cache]).to_world(directions[i % each])};
            chosen[i - begin].body = at.body[cache];
        }
        const auto own = std::span(chosen).first(end - begin);
        counts[begin / ConeBatch::capacity] = caster.cast(own, batch);
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t k = i - begin;
            write_texel(filled.texels.data() + 4 * i, {batch.r[k], batch.g[k], batch.b[k]}, batch.open[k]);
            if (!filled.sky.empty())
                write_texel(filled.sky.data() + 4 * i, environment.mean(own[k].direction) * (batch.open[k] / filled.scale), 0.0f);
        }
    });
    for (const auto& one : counts) filled.counts += one;
    return filled;
}

}  // namespace interreflect
