#include "visibility/light_view.h"

#include <limits>

namespace interreflect {
namespace {

LightView perspective_view(const vec3& eye, const vec3& forward, const vec3& right, float half, int size) {
    LightView view;
    view.size = size;
    view.origin = eye;
    view.forward = forward;
    view.right = right;
    view.down = glm::cross(forward, right);
    view.half_x = view.half_y = half;
    return view;
}

std::vector<LightView> cube_views(const vec3& eye, int size) {
    const float half = 1.0f + 2.0f / static_cast<float>(size);
    std::vector<LightView> views;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            vec3 forward(0), right(0);
            forward[axis] = sign;
            right[(axis + 1) % 3] = 1.0f;
            views.push_back(perspective_view(eye, forward, right, half, size));
        }
    return views;
}

}  // namespace

float LightView::texel_measure(float x, float y) const {
    const float area = 4.0f * half_x * half_y / (static_cast<float>(size) * static_cast<float>(size));
    if (!perspective) return area;
    const float sx = half_x * (2.0f * x / static_cast<float>(size) - 1.0f);
    const float sy = half_y * (2.0f * y / static_cast<float>(size) - 1.0f);
    const float squared = 1.0f + sx * sx + sy * sy;
    return area / (squared * std::sqrt(squared));
}

void LightView::rays(int x0, int y0, RayPacket& packet) const {
    // Plain loops over lanes, for the compiler to make vectors of; the order of operations is that of `ray`.
    constexpr int lanes = RayPacket::width;
    alignas(64) RayPacket::Lanes column, row, inverse_length;
    RayPacket::Lanes* const origins[3] = {&packet.origin_x, &packet.origin_y, &packet.origin_z};
    RayPacket::Lanes* const directions[3] = {&packet.direction_x, &packet.direction_y, &packet.direction_z};
    const float width = static_cast<float>(size);
    for (int i = 0; i < lanes; ++i) {
        const int x = x0 + i % 4, y = y0 + i / 4;
        column[i] = half_x * (2.0f * (static_cast<float>(x) + 0.5f) / width - 1.0f);
        row[i] = half_y * (2.0f * (static_cast<float>(y) + 0.5f) / width - 1.0f);
        packet.near[i] = 0.0f;
        packet.far[i] = std::numeric_limits<float>::infinity();
    }
    const vec3& from = perspective ? forward : origin;
    const vec3& constant = perspective ? origin : forward;
    for (int k = 0; k < 3; ++k) {
        auto& moved = *(perspective ? directions : origins)[k];
        auto& same = *(perspective ? origins : directions)[k];
        for (int i = 0; i < lanes; ++i) moved[i] = from[k] + (right[k] * column[i] + down[k] * row[i]), same[i] = constant[k];
    }
    if (!perspective) return;
    const auto& [x, y, z] = directions;
    for (int i = 0; i < lanes; ++i)
        inverse_length[i] = 1.0f / std::sqrt((*x)[i] * (*x)[i] + (*y)[i] * (*y)[i] + (*z)[i] * (*z)[i]);
    for (auto* direction : directions)
        for (int i = 0; i < lanes; ++i) (*direction)[i] *= inverse_length[i];
}

LightView view_of(const DirectionalLight& light, const Bounds& bounds, int size) {
    LightView view;
    view.perspective = false;
    view.size = size;
    view.forward = glm::normalize(light.direction);
    const Frame frame(view.forward);
    view.right = frame.tangent;
    view.down = frame.bitangent;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    vec3 lower(infinity), upper(-infinity);
    const vec3 centre = 0.5f * (bounds.lower + bounds.upper);
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 p{(corner & 1) != 0 ? bounds.upper.x : bounds.lower.x, (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                     (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z};
        const vec3 local = frame.to_local(p - centre);
        lower = glm::min(lower, local);
        upper = glm::max(upper, local);
    }
    // A texel of margin, so that what lies on the border is inside; flat scenes seen edge-on still have some width.
    const float margin = 1.0f + 2.0f / static_cast<float>(size);
    const float least = 1e-6f * glm::length(upper - lower);
    view.half_x = std::fmax(0.5f * (upper.x - lower.x) * margin, least);
    view.half_y = std::fmax(0.5f * (upper.y - lower.y) * margin, least);
    view.origin = centre + frame.to_world({0.5f * (lower.x + upper.x), 0.5f * (lower.y + upper.y), lower.z}) -
                  view.forward * (0.01f * (upper.z - lower.z) + least);
    return view;
}

std::vector<LightView> views_of(const SpotLight& light, int size) {
    constexpr float widest = 75.0f;
    if (light.outer >= widest) return cube_views(light.position, size);
    const vec3 forward = glm::normalize(light.direction);
    const float half = std::fmax(std::tan(light.outer * degrees_to_radians), 1e-4f) * (1.0f + 2.0f / static_cast<float>(size));
    return {perspective_view(light.position, forward, Frame(forward).tangent, half, size)};
}

std::vector<LightView> views_of(const PointLight& light, int size) { return cube_views(light.position, size); }

std::vector<LightView> views_of_light(const Scene& scene, int i, int size) {
    const int points = static_cast<int>(scene.point_lights.size()), spots = static_cast<int>(scene.spot_lights.size());
    if (i < points) return views_of(scene.point_lights[i], size);
    if (i < points + spots) return views_of(scene.spot_lights[i - points], size);
    return {view_of(scene.directional_lights[i - points - spots], scene.geometry->bounds(), size)};
}

}  // namespace interreflect
