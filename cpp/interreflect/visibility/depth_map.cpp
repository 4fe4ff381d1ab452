#include "visibility/depth_map.h"

#include <algorithm>

namespace interreflect {

DepthMap::DepthMap(const LightView& light_view, const Intersector& intersector)
    : view(light_view), depth(static_cast<std::size_t>(light_view.size) * light_view.size) {
    trace_view(view, intersector,
               [this](int x, int y, const Hit& hit) { depth[static_cast<std::size_t>(y) * view.size + x] = hit.distance; });
}

float DepthMap::lit(const vec3& position, const vec3& normal, float bias, float offset) const {
    const LightView::Projection at = view.project(position);
    const int cx = static_cast<int>(at.x), cy = static_cast<int>(at.y);
    int compared = 0, open = 0;
    for (int j = cy - 1; j <= cy + 1; ++j)
        for (int i = cx - 1; i <= cx + 1; ++i) {
            if (i < 0 || j < 0 || i >= view.size || j >= view.size) continue;
            const Ray ray = view.ray(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f);
            const float facing = glm::dot(ray.direction, normal), height = glm::dot(position - ray.origin, normal);
            if (!(facing < 0.0f && height < 0.0f)) continue;  // this texel looks along the plane or at its back
            const float plane = height / facing;
            const float map = depth[static_cast<std::size_t>(j) * view.size + i];
            ++compared;
            open += map >= plane - bias * view.texel_width(plane) - offset ? 1 : 0;
        }
    return compared > 0 ? static_cast<float>(open) / static_cast<float>(compared) : 0.0f;
}

DepthMaps::DepthMaps(const std::vector<LightView>& views, const Intersector& intersector) {
    maps.reserve(views.size());
    for (const LightView& view : views) maps.emplace_back(view, intersector);
}

float DepthMaps::lit(const vec3& position, const vec3& normal, float bias, float offset) const {
    if (maps.size() == 1) return maps[0].view.project(position).inside ? maps[0].lit(position, normal, bias, offset) : 1.0f;
    const auto towards = [&](const DepthMap& map) { return glm::dot(position - map.view.origin, map.view.forward); };
    const auto nearest =
        std::max_element(maps.begin(), maps.end(), [&](const DepthMap& a, const DepthMap& b) { return towards(a) < towards(b); });
    return nearest->lit(position, normal, bias, offset);
}

std::size_t DepthMaps::texels() const {
    std::size_t sum = 0;
    for (const DepthMap& map : maps) sum += map.depth.size();
    return sum;
}

}  // namespace interreflect
