#include "visibility/sphere_hierarchy.h"

#include <algorithm>

#include "visibility/ray_device.h"

namespace interreflect {
namespace {

// Boxes and distances are rounded; what reaches exactly must be found.
constexpr float slack = 1e-5f;

float largest(const vec3& v) { return max_component(glm::abs(v)); }

}  // namespace

struct SphereHierarchy::Implementation {
    std::vector<vec4> spheres;  // centre, radius with its slack
    RTCScene scene = nullptr;

    struct Query {
        const Implementation& in;
        vec3 point;
        float distance;
        std::vector<std::uint32_t>& found;
    };
    static void bounds(const RTCBoundsFunctionArguments* args) {
        const vec4 sphere = static_cast<const Implementation*>(args->geometryUserPtr)->spheres[args->primID];
        const vec3 lower = vec3(sphere) - sphere.w, upper = vec3(sphere) + sphere.w;
        args->bounds_o->lower_x = lower.x, args->bounds_o->lower_y = lower.y, args->bounds_o->lower_z = lower.z;
        args->bounds_o->upper_x = upper.x, args->bounds_o->upper_y = upper.y, args->bounds_o->upper_z = upper.z;
    }
    /// Returns whether the query shrank: never.
    static bool look(RTCPointQueryFunctionArguments* args) {
        const auto& query = *static_cast<const Query*>(args->userPtr);
        const vec4 sphere = query.in.spheres[args->primID];
        const vec3 away = vec3(sphere) - query.point;
        const float reach = query.distance + sphere.w;
        if (glm::dot(away, away) <= reach * reach) query.found.push_back(args->primID);
        return false;
    }
};

SphereHierarchy::SphereHierarchy(std::span<const vec3> centres, std::span<const float> radii)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& in = *implementation_;
    in.spheres.reserve(centres.size());
    for (std::size_t i = 0; i < centres.size(); ++i)
        in.spheres.emplace_back(centres[i], radii[i] + slack * (radii[i] + largest(centres[i])));
    if (in.spheres.empty()) return;
    in.scene = rtcNewScene(ray_device());
    const RTCGeometry geometry = rtcNewGeometry(ray_device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(in.spheres.size()));
    rtcSetGeometryUserData(geometry, &in);
    rtcSetGeometryBoundsFunction(geometry, Implementation::bounds, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(in.scene, geometry);
    rtcReleaseGeometry(geometry);
    // Few primitives, used for one picture.
    rtcSetSceneBuildQuality(in.scene, RTC_BUILD_QUALITY_LOW);
    rtcCommitScene(in.scene);
    check_ray_device();
}

SphereHierarchy::~SphereHierarchy() {
    if (implementation_->scene != nullptr) rtcReleaseScene(implementation_->scene);
}

void SphereHierarchy::reach(const vec3& point, float distance, std::vector<std::uint32_t>& found) const {
    found.clear();
    if (implementation_->scene == nullptr) return;
    const float wide = distance + slack * (distance + largest(point));
    Implementation::Query of{*implementation_, point, wide, found};
    RTCPointQuery query{point.x, point.y, point.z, 0.0f, wide};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(implementation_->scene, &query, &context, Implementation::look, &of);
    std::sort(found.begin(), found.end());
}

}  // namespace interreflect
