#include "voxels/grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace interreflect {
namespace {

/// What a grid is placed by.
struct Setting {
    const Grid& grid;
    const Camera* camera;
    Bounds bounds;
    float aspect, extent;  // extent: the bounds' longest side

    const Camera& needed_camera(const char* what) const {
        if (camera == nullptr) throw std::invalid_argument(std::string(what) + " needs a camera");
        return *camera;
    }
};

/// Evenly spread voxels over a box, `air` voxels of it around on both sides together.
Domain spread(const vec3& lower, const vec3& extent, int count, float air) {
    Domain domain;
    const auto resolution = static_cast<float>(count);
    domain.voxel_size = max_component(extent) / (resolution - air);
    for (int axis = 0; axis < 3; ++axis) {
        // The tolerance keeps an extent that is a whole number of voxels but for rounding from taking one more.
        const float voxels = std::ceil(extent[axis] / domain.voxel_size + air - 1e-3f);
        domain.cells[axis] = std::clamp(static_cast<int>(voxels), 1, count);
    }
    domain.lower = lower + 0.5f * extent - vec3(domain.cells) * (0.5f * domain.voxel_size);
    return domain;
}

Domain cover(const SceneBounds&, const Setting& at) {
    const vec3 extent = at.bounds.upper - at.bounds.lower;
    if (!(min_component(extent) >= 0.0f) || !(max_component(extent) > 0.0f)) return {};
    return spread(at.bounds.lower, extent, at.grid.resolution, 1.0f);
}

Domain cover(const Box& box, const Setting& at) {
    const vec3 lower(box.lower_x, box.lower_y, box.lower_z), extent = vec3(box.upper_x, box.upper_y, box.upper_z) - lower;
    if (!(min_component(extent) > 0.0f))
        throw std::invalid_argument("Box: upper must lie above lower along every axis; the extents are " +
                                    std::to_string(extent.x) + ", " + std::to_string(extent.y) + ", " + std::to_string(extent.z));
    return spread(lower, extent, at.grid.resolution, 0.0f);
}

Domain cover(const AroundCamera& region, const Setting& at) {
    if (!(at.extent > 0.0f)) return {};
    Domain domain;
    domain.cells = ivec3(at.grid.resolution);
    domain.voxel_size = static_cast<float>(region.width) * at.extent / static_cast<float>(at.grid.resolution);
    vec3 middle = at.needed_camera("AroundCamera").position;
    if (region.step > 0) {
        const float step = domain.voxel_size * static_cast<float>(region.step);
        middle = glm::round(middle / step) * step;
    }
    domain.lower = middle - 0.5f * domain.voxel_size * vec3(domain.cells);
    return domain;
}

void spread_about(const Setting& at, Warp::Kind kind, float steepness, Domain& domain) {
    domain.warp.kind = kind;
    domain.warp.steepness = steepness;
    const bool middle = at.camera == nullptr || std::holds_alternative<AroundCamera>(at.grid.region);
    domain.warp.centre =
        middle ? 0.5f * vec3(domain.cells) : glm::clamp(domain.to_linear(at.camera->position), vec3(0), vec3(domain.cells));
}

/// Nested grids about the camera; each but the outermost begins at an even voxel of its own, so that two of its voxels make one
/// of the next, and moves by such pairs.
void nest(const Setting& at, Domain& domain) {
    const int count = at.grid.cascades;
    domain.cascades = count;
    for (int axis = 0; axis < 3; ++axis) domain.cells[axis] += domain.cells[axis] % 2;
    domain.voxel_size /= static_cast<float>(1 << (count - 1));
    const vec3 middle = domain.to_linear(at.needed_camera("a grid of cascades").position);
    for (int k = count - 2; k >= 0; --k) {
        const ivec3 parent = 2 * domain.origin[static_cast<std::size_t>(k) + 1];
        const vec3 first = (middle / static_cast<float>(1 << k) - 0.5f * vec3(domain.cells)) * 0.5f;
        domain.origin[static_cast<std::size_t>(k)] = glm::clamp(2 * ivec3(glm::round(first)), parent, parent + domain.cells);
    }
}

/// A hair beyond the scene's farthest corner, lest that lie on the outermost face: the same wherever the camera looks.
float farthest(const Setting& at, const vec3& eye) {
    const vec3 away = glm::max(glm::abs(at.bounds.lower - eye), glm::abs(at.bounds.upper - eye));
    return 1.001f * glm::length(away);
}

/// A grid whose linear voxels have the eye at 0 and the volume's depth over `resolution` as their size.
Domain view_volume(const ViewVolume& volume, const Setting& at, const Camera& camera) {
    const float near = static_cast<float>(volume.near) * at.extent;
    const float far = volume.far > 0.0 ? static_cast<float>(volume.far) * at.extent : farthest(at, camera.position);
    if (!(far > near))
        throw std::invalid_argument("a view volume's far must lie beyond its near; in scene units they are " +
                                    std::to_string(far) + " and " + std::to_string(near));
    Domain domain;
    domain.lower = camera.position;
    domain.cells = ivec3(at.grid.resolution);
    const float narrow = at.aspect > 1.0f ? 1.0f / at.aspect : at.aspect;
    domain.cells[at.aspect > 1.0f ? 1 : 0] =
        std::max(1, static_cast<int>(std::lround(static_cast<float>(at.grid.resolution) * narrow)));
    domain.voxel_size = (far - near) / static_cast<float>(at.grid.resolution);
    domain.warp.near = near / domain.voxel_size;
    domain.warp.far = far / domain.voxel_size;
    return domain;
}

float half_tangent(const ViewVolume& volume, const Camera& camera) {
    return static_cast<float>(volume.widening) * std::tan(0.5f * camera.fov_x * degrees_to_radians);
}

Domain view_domain(const Perspective& technique, const Setting& at, const Camera& camera) {
    Domain domain = view_volume(technique, at, camera);
    Warp& warp = domain.warp;
    warp.kind = Warp::Kind::perspective;
    warp.linear_depth = technique.linear_depth;
    warp.forward = glm::normalize(camera.target - camera.position);
    warp.right = glm::normalize(glm::cross(warp.forward, camera.up));
    warp.up = glm::cross(warp.right, warp.forward);
    warp.half_x = half_tangent(technique, camera);
    warp.half_y = warp.half_x / at.aspect;
    return domain;
}

/// An axis across `up` that does not depend on where the camera looks.
vec3 fixed_direction(const vec3& up) {
    const vec3 size = glm::abs(up);
    const vec3 axis = size.z <= size.x && size.z <= size.y ? vec3(0, 0, 1) : size.x <= size.y ? vec3(1, 0, 0) : vec3(0, 1, 0);
    return glm::normalize(axis - up * glm::dot(axis, up));
}

Domain view_domain(const Spherical& technique, const Setting& at, const Camera& camera) {
    Domain domain = view_volume(technique, at, camera);
    Warp& warp = domain.warp;
    warp.kind = Warp::Kind::spherical;
    warp.up = glm::normalize(camera.up);
    const float widest = 85.0f * degrees_to_radians;  // poles of elevation lie at 90 degrees
    const float tangent = half_tangent(technique, camera);
    warp.half_x = std::min(std::atan(tangent), widest);
    warp.half_y = std::min(std::atan(tangent / at.aspect), widest);
    const vec3 look = glm::normalize(camera.target - camera.position);
    const vec3 ahead = fixed_direction(warp.up), aside = glm::cross(ahead, warp.up);
    float azimuth = std::atan2(glm::dot(look, aside), glm::dot(look, ahead));
    float elevation = std::asin(std::clamp(glm::dot(look, warp.up), -1.0f, 1.0f));
    if (technique.snap) {
        const vec2 step = 2.0f * vec2(warp.half_x, warp.half_y) / vec2(domain.cells);
        azimuth = std::round(azimuth / step.x) * step.x;
        elevation = std::round(elevation / step.y) * step.y;
    }
    const float most = widest - warp.half_y;
    warp.elevation = std::clamp(elevation, -most, most);
    warp.forward = ahead * std::cos(azimuth) + aside * std::sin(azimuth);
    warp.right = glm::cross(warp.forward, warp.up);
    return domain;
}

template <class Volume>
Domain view_domain(const Volume& volume, const Setting& at) {
    if (!std::holds_alternative<SceneBounds>(at.grid.region))
        throw std::invalid_argument(std::string(Volume::description.name) + " brings its own region: leave region=SceneBounds()");
    if (!(at.extent > 0.0f)) return {};
    return view_domain(volume, at, at.needed_camera(Volume::description.name.data()));
}

}  // namespace

Domain place(const Grid& grid, const Scene& scene, const Camera* camera, float aspect) {
    const auto bounds = scene.geometry->bounds();
    const Setting at{grid, camera, bounds, aspect, max_component(bounds.upper - bounds.lower)};
    if (grid.cascades > 1 && !std::holds_alternative<Linear>(grid.warp))
        throw std::invalid_argument("Grid: cascades are nested grids without a warp: warp must be Linear(), or cascades 1");
    if (const auto* volume = std::get_if<Perspective>(&grid.warp)) return view_domain(*volume, at);
    if (const auto* volume = std::get_if<Spherical>(&grid.warp)) return view_domain(*volume, at);
    Domain domain = std::visit([&](const auto& region) { return cover(region, at); }, grid.region);
    if (const auto* warp = std::get_if<CubicSpline>(&grid.warp))
        spread_about(at, Warp::Kind::cubic, 1.5f - 0.5f * static_cast<float>(warp->alpha), domain);
    if (const auto* warp = std::get_if<Logistic>(&grid.warp))
        spread_about(at, Warp::Kind::logistic, 0.25f * static_cast<float>(warp->steepness), domain);
    if (grid.cascades > 1) nest(at, domain);
    return domain;
}

}  // namespace interreflect
