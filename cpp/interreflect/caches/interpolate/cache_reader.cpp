#include "caches/interpolate/cache_reader.h"

#include <algorithm>

#include "caches/fill/texels.h"
#include "math/hemisphere_map.h"
#include "math/owen_sobol.h"
#include "shading/brdf.h"
#include "shading/pixel_lobe.h"

namespace interreflect {

vec4 read_map(const std::uint16_t* texels, int n, const vec2& square) {
    const vec2 p = glm::clamp(square * static_cast<float>(n) - 0.5f, 0.0f, static_cast<float>(n - 1));
    const int x = std::min(static_cast<int>(p.x), std::max(n - 2, 0)), y = std::min(static_cast<int>(p.y), std::max(n - 2, 0));
    const int right = n > 1 ? 4 : 0, below = n > 1 ? 4 * n : 0;
    const std::uint16_t* corner = texels + 4 * (y * n + x);
    const vec2 f = p - vec2(static_cast<float>(x), static_cast<float>(y));
    return glm::mix(glm::mix(read_texel(corner), read_texel(corner + right), f.x),
                    glm::mix(read_texel(corner + below), read_texel(corner + below + right), f.x), f.y);
}

namespace {
vec4 at_level(const LayerMaps& maps, int level, const vec2& square) {
    return read_map(maps.level(level), maps.caches.level_sizes[static_cast<std::size_t>(level)], square);
}
}  // namespace

CacheSum CacheReader::read(std::size_t cache, const PixelViews::View& view) const {
    if (caches_.samples > 0) return sample(cache, view);
    const FilledCaches& filled = *caches_.filled;
    const Frame frame(filled.places->normal[cache]);
    const LayerMaps light(caches_, filled.texels, caches_.light, cache), sky(caches_, filled.sky, caches_.sky, cache);
    const bool image = !filled.sky.empty();
    CacheSum sum;
    sum.weight = 1.0f;
    const vec2 normal = hemisphere_square(frame.to_local(view.normal));
    sum.diffuse = read_map(light.table, caches_.table_size, normal);
    if (image) sum.diffuse_sky = read_map(sky.table, caches_.table_size, normal);
    if (!view.glossy) return sum;
    const vec2 lobe = hemisphere_square(frame.to_local(view.direction));
    const int finer = std::min(static_cast<int>(view.level), caches_.levels() - 1);
    const int coarser = std::min(finer + 1, caches_.levels() - 1);
    const float between = view.level - static_cast<float>(finer);
    sum.glossy = glm::mix(at_level(light, finer, lobe), at_level(light, coarser, lobe), between);
    if (image) sum.glossy_sky = glm::mix(vec3(at_level(sky, finer, lobe)), vec3(at_level(sky, coarser, lobe)), between);
    return sum;
}

namespace {
/// A mean that leaves out what lies below the horizon.
struct MeanOfSamples {
    vec4 light{0};
    vec3 sky{0};
    float weight = 0;
};
}  // namespace

CacheSum CacheReader::sample(std::size_t cache, const PixelViews::View& view) const {
    const FilledCaches& filled = *caches_.filled;
    const Frame frame(filled.places->normal[cache]), own(view.normal);
    const LayerMaps light(caches_, filled.texels, caches_.light, cache), sky(caches_, filled.sky, caches_.sky, cache);
    const auto add = [&](const vec3& direction, float weight, MeanOfSamples& to) {
        const vec3 local = frame.to_local(direction);
        if (local.z <= 0.0f || weight <= 0.0f) return;
        const vec2 square = hemisphere_square(local);
        to.light += read_map(light.filled, filled.resolution, square) * weight;
        if (!filled.sky.empty()) to.sky += vec3(read_map(sky.filled, filled.resolution, square)) * weight;
        to.weight += weight;
    };
    MeanOfSamples diffuse, glossy;
    const vec3 wo = glm::normalize(gbuffer_.camera.position - view.position);
    const SurfacePoint surface = view.glossy ? glossy_surface(gbuffer_, scene_, view.pixel) : SurfacePoint{};
    for (int i = 0; i < caches_.samples; ++i) {
        const Bits2 bits = owen_sobol(static_cast<std::uint32_t>(i), view.pixel);
        const vec2 u(unit_float(bits.x), unit_float(bits.y));
        add(own.to_world(cosine_hemisphere(u)), 1.0f, diffuse);
        if (!view.glossy) continue;
        const BrdfSample chosen = sample_brdf(surface, wo, 0.0f, u);
        add(chosen.wi, luminance(chosen.weight), glossy);
    }
    CacheSum sum;
    sum.weight = 1.0f;
    if (diffuse.weight > 0.0f) sum.diffuse = diffuse.light / diffuse.weight, sum.diffuse_sky = diffuse.sky / diffuse.weight;
    if (glossy.weight > 0.0f) sum.glossy = glossy.light / glossy.weight, sum.glossy_sky = glossy.sky / glossy.weight;
    return sum;
}

}  // namespace interreflect
