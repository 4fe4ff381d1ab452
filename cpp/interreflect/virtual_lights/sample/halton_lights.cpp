#include "virtual_lights/sample/halton_lights.h"

#include "math/radical_inverse.h"
#include "virtual_lights/sample/importance_pyramid.h"
#include "virtual_lights/sample/texel_lights.h"

namespace interreflect {
namespace {

double total_flux(const LightMaps& maps) {
    double sum = 0;
    for (const auto& map : maps.maps)
        for (const vec3& flux : map.flux) sum += luminance(flux);
    return sum;
}
/// Of specular reflectance, of all texels that send light on.
double total_specular(const LightMaps& maps) {
    double sum = 0;
    for (const auto& map : maps.maps)
        for (std::size_t i = 0; i < map.texels(); ++i) sum += sends(map, i) ? luminance(map.specular[i]) : 0.0f;
    return sum;
}

}  // namespace

ImportancePyramid importance_of(const HaltonLights& technique, const LightMaps& maps) {
    if (technique.importance == "none")
        return {maps, [](const ReflectiveShadowMap& map, std::size_t i) { return sends(map, i) ? 1.0f : 0.0f; }};
    const double specular = technique.importance == "specular" ? total_specular(maps) : 0.0;
    if (!(specular > 0)) return {maps, [](const ReflectiveShadowMap& map, std::size_t i) { return luminance(map.flux[i]); }};
    const auto by_flux = static_cast<float>(0.1 / total_flux(maps)), by_specular = static_cast<float>(0.9 / specular);
    return {maps, [=](const ReflectiveShadowMap& map, std::size_t i) {
                return sends(map, i) ? luminance(map.flux[i]) * by_flux + luminance(map.specular[i]) * by_specular : 0.0f;
            }};
}

VirtualLights sample_lights(const HaltonLights& technique, const LightMaps& maps, std::uint32_t) {
    const ImportancePyramid pyramid = importance_of(technique, maps);
    const std::size_t n = pyramid.total() > 0 ? static_cast<std::size_t>(technique.lights) : 0;
    const auto first = first_texels(maps);
    VirtualLights lights = make_virtual_lights(n);
    lights.map_sizes = sizes_of(maps);
    lights.counts.virtual_lights = n;
    for (std::size_t i = 0; i < n; ++i) {
        const auto index = static_cast<std::uint32_t>(i + 1);
        const auto chosen = pyramid.choose(radical_inverse(2, index), radical_inverse(3, index));
        const double share = 1.0 / (chosen.probability * static_cast<double>(n));
        set_texel_light(lights, i, maps.maps[chosen.map], chosen.texel, first[chosen.map], static_cast<float>(share));
    }
    return lights;
}

}  // namespace interreflect
