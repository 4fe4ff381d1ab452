#include "caches/fill/cone_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "caches/fill/texels.h"
#include "math/hemisphere_map.h"
#include "math/parallel.h"
#include "voxels/march/cone_caster.h"
#include "voxels/march/cone_environment.h"

namespace interreflect {
namespace {

/// Of one texel: a uniform cone of half angle a covers 2 pi (1 - cos a), the texel 2 pi / n^2. No wider than the knob allows: a
/// cone that is a half space advances without end at its first step.
float texel_half_angle(int resolution) {
    constexpr float widest = 70.0f * degrees_to_radians;
    return std::min(std::acos(1.0f - 1.0f / (static_cast<float>(resolution) * static_cast<float>(resolution))), widest);
}

struct Texel {
    std::uint32_t number;  // row * resolution + column
    vec3 direction;        // about +z
};

constexpr float no_end = std::numeric_limits<float>::infinity();

/// Bits of x and y in turn.
std::uint32_t interleaved(std::uint32_t x, std::uint32_t y) {
    std::uint32_t code = 0;
    for (unsigned bit = 0; bit < 8; ++bit) code |= ((x >> bit & 1) << 2 * bit) | ((y >> bit & 1) << (2 * bit + 1));
    return code;
}

/// Along a Z-shaped curve: cones that are marched together are neighbours, which read the same texels and end alike.
std::vector<Texel> texels_in_order(int resolution) {
    std::vector<Texel> texels;
    for (int y = 0; y < resolution; ++y)
        for (int x = 0; x < resolution; ++x)
            texels.push_back(
                {static_cast<std::uint32_t>(y * resolution + x), hemisphere_direction(map_texel_centre(x, y, resolution))});
    const auto width = static_cast<std::uint32_t>(resolution);
    std::sort(texels.begin(), texels.end(), [=](const Texel& a, const Texel& b) {
        return interleaved(a.number % width, a.number / width) < interleaved(b.number % width, b.number / width);
    });
    return texels;
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
    const std::vector<Texel> texels = texels_in_order(technique.resolution);
    const std::size_t each = texels.size(), cones = at.size() * each;
    std::vector<Counts> counts((cones + ConeBatch::capacity - 1) / ConeBatch::capacity);
    parallel_blocks(cones, ConeBatch::capacity, [&](std::size_t begin, std::size_t end) {
        thread_local ConeBatch batch;
        std::array<ConeCaster::Cone, ConeBatch::capacity> chosen;
        const auto own = std::span(chosen).first(end - begin);
        for (std::size_t i = begin; i < end;) {
            const std::size_t cache = i / each, last = std::min(end, (cache + 1) * each);
            const Frame frame(at.normal[cache]);
            for (; i < last; ++i) {
                const vec3 direction = frame.to_world(texels[i % each].direction);
                chosen[i - begin] = {at.position[cache], at.geometric_normal[cache], direction, no_end, at.body[cache]};
            }
        }
        counts[begin / ConeBatch::capacity] = caster.cast(own, batch);
        std::array<std::uint16_t, 4 * ConeBatch::capacity> packed;
        pack_texels(batch.r, batch.g, batch.b, batch.open, own.size(), packed.data());
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t k = i - begin, place = 4 * (i - i % each + texels[i % each].number);
            std::copy_n(packed.data() + 4 * k, 4, filled.texels.data() + place);
            if (!filled.sky.empty())
                write_texel(filled.sky.data() + place, environment.mean(own[k].direction) * (batch.open[k] / filled.sky_scale),
                            0.0f);
        }
    });
    for (const auto& one : counts) filled.counts += one;
    return filled;
}

}  // namespace interreflect
