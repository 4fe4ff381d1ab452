#include "direct/reflective_shadow_map.h"

#include <stdexcept>
#include <string>

#include "visibility/surface.h"

namespace interreflect {
namespace {

LightView single_view(const Scene& scene, int light, int size) {
    const int points = static_cast<int>(scene.point_lights.size()), spots = static_cast<int>(scene.spot_lights.size());
    const int directions = static_cast<int>(scene.directional_lights.size());
    if (light < points || light >= points + spots + directions)
        throw std::invalid_argument("light must name a spot or directional light, a number in [" + std::to_string(points) + ", " +
                                    std::to_string(points + spots + directions) + "), got " + std::to_string(light));
    if (light >= points + spots) return view_of(scene.directional_lights[light - points - spots], scene.geometry->bounds(), size);
    const auto views = views_of(scene.spot_lights[light - points], size);
    if (views.size() != 1)
        throw std::invalid_argument("light: a spot with a reflective shadow map must be narrower than 75 degrees");
    return views[0];
}

}  // namespace

ReflectiveShadowMap reflective_shadow_map(const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                                          int light, int size) {
    constexpr int most = 1 << 14;
    if (size < 1 || size > most)
        throw std::invalid_argument("size must lie in [1, " + std::to_string(most) + "] texels, got " + std::to_string(size));
    const LightView view = single_view(scene, light, size);
    const auto n = static_cast<std::size_t>(size) * size;
    ReflectiveShadowMap map{
        view, Buffer<vec3>(n), Buffer<vec3>(n), Buffer<vec3>(n), Buffer<vec3>(n), Buffer<vec3>(n), Buffer<float>(n), {}};
    map.counts.rays = n;
    trace_view(view, intersector, [&](int x, int y, const Hit& hit) {
        const std::size_t texel = static_cast<std::size_t>(y) * size + x;
        const float cx = static_cast<float>(x) + 0.5f, cy = static_cast<float>(y) + 0.5f;
        if (!hit.valid()) {
            map.position[texel] = map.normal[texel] = map.incident[texel] = map.flux[texel] = map.specular[texel] = vec3(0);
            map.alpha[texel] = 1.0f;
            return;
        }
        const SurfacePoint point = surface_at(scene, hit, view.ray(cx, cy).direction);
        const LightSampler::Delta delta = lights.delta(light, point.position);
        // A spot's irradiance times the squared distance is its intensity; the texel spans a solid angle of it.
        const float reach = view.perspective ? delta.distance * delta.distance : 1.0f;
        map.position[texel] = point.position;
        map.normal[texel] = point.normal;
        map.incident[texel] = delta.irradiance * (reach * view.texel_measure(cx, cy));
        map.flux[texel] = map.incident[texel] * point.albedo;
        map.specular[texel] = point.specular;
        map.alpha[texel] = point.alpha;
    });
    return map;
}

}  // namespace interreflect
