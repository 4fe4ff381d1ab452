#include "visibility/intersector.h"

#include <embree3/rtcore.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace interreflect {
namespace {

/// One device for the process: it holds threads and settings, no scene.
RTCDevice device() {
    static const RTCDevice shared = [] {
        const RTCDevice made = rtcNewDevice(nullptr);
        if (made == nullptr) throw std::runtime_error("the ray library has no device on this machine");
        return made;
    }();
    return shared;
}

void check_device() {
    const RTCError error = rtcGetDeviceError(device());
    if (error != RTC_ERROR_NONE) throw std::runtime_error("the ray library failed with error " + std::to_string(error));
}

/// One hierarchy: a group's solid triangles and, apart, those with a mask.
struct Hierarchy {
    RTCScene scene = nullptr;
    std::shared_ptr<const GeometryArrays> arrays;  // Embree reads the shared buffers for as long as it lives
    std::vector<std::shared_ptr<const Mask>> masks;
    std::vector<int> mask_of_material;
    std::vector<std::uint32_t> triangle_of_primitive[2];  // global triangle numbers, solid and masked
    std::vector<uvec3> indices[2];

    Hierarchy() = default;
    ~Hierarchy() {
        if (scene != nullptr) rtcReleaseScene(scene);
    }
    Hierarchy(const Hierarchy&) = delete;
    Hierarchy& operator=(const Hierarchy&) = delete;
};

/// Drops hits on the holes of a mask, for packets of any width.
void mask_filter(const RTCFilterFunctionNArguments* args) {
    const auto& hierarchy = *static_cast<const Hierarchy*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const float u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
        const std::uint32_t triangle = hierarchy.triangle_of_primitive[1][RTCHitN_primID(args->hit, args->N, i)];
        const uvec3 t = hierarchy.arrays->triangles[triangle];
        const auto& uv = hierarchy.arrays->texcoords;
        const Mask& mask = *hierarchy.masks[hierarchy.mask_of_material[hierarchy.arrays->materials[triangle]]];
        if (!mask.solid(uv[t.x] * (1.0f - u - v) + uv[t.y] * u + uv[t.z] * v)) args->valid[i] = 0;
    }
}

void attach_triangles(Hierarchy& hierarchy, int masked, RTCBuildQuality quality) {
    const auto& indices = hierarchy.indices[masked];
    const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, hierarchy.arrays->positions.data(), 0,
                               sizeof(vec3), hierarchy.arrays->positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices.data(), 0, sizeof(uvec3),
                               indices.size());
    rtcSetGeometryUserData(geometry, &hierarchy);
    if (masked != 0) {
        rtcSetGeometryIntersectFilterFunction(geometry, mask_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, mask_filter);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(hierarchy.scene, geometry, masked);
    rtcReleaseGeometry(geometry);
}

std::shared_ptr<const Hierarchy> build_group(const Geometry& geometry, const Group& group,
                                             const std::vector<int>& mask_of_material,
                                             std::span<const std::shared_ptr<const Mask>> masks, RTCBuildQuality quality) {
    auto hierarchy = std::make_shared<Hierarchy>();
    hierarchy->arrays = geometry.arrays;
    hierarchy->masks.assign(masks.begin(), masks.end());
    hierarchy->mask_of_material = mask_of_material;
    for (std::uint32_t i = 0; i < group.triangle_count; ++i) {
        const std::uint32_t triangle = group.first_triangle + i;
        const int kind = mask_of_material[geometry.arrays->materials[triangle]] >= 0 ? 1 : 0;
        hierarchy->triangle_of_primitive[kind].push_back(triangle);
        hierarchy->indices[kind].push_back(geometry.arrays->triangles[triangle]);
    }
    hierarchy->scene = rtcNewScene(device());
    rtcSetSceneBuildQuality(hierarchy->scene, quality);
    for (const int kind : {0, 1})
        if (!hierarchy->indices[kind].empty()) attach_triangles(*hierarchy, kind, quality);
    rtcCommitScene(hierarchy->scene);
    check_device();
    return hierarchy;
}

}  // namespace

struct Intersector::Implementation {
    std::shared_ptr<const Geometry> geometry;
    std::vector<std::shared_ptr<const Hierarchy>> groups;
    RTCScene root = nullptr;                    // groups[0]'s scene where nothing else is placed
    std::vector<std::uint32_t> instance_of_id;  // by instID of the root; empty where the root is groups[0]'s
    bool owns_root = false;

    ~Implementation() {
        if (owns_root) rtcReleaseScene(root);
    }
    void build_root();
    Hit make_hit(std::uint32_t instance_id, std::uint32_t geometry_id, std::uint32_t primitive, float distance, float u,
                 float v) const;
};

void Intersector::Implementation::build_root() {
    if (geometry->instances.size() == 1) {
        root = groups[0]->scene;
        return;
    }
    root = rtcNewScene(device());
    owns_root = true;
    for (std::uint32_t i = 0; i < geometry->instances.size(); ++i) {
        const Instance& instance = geometry->instances[i];
        if (geometry->groups[instance.group].triangle_count == 0) continue;
        const RTCGeometry placed = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(placed, groups[instance.group]->scene);
        rtcSetGeometryTransform(placed, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &instance.world_from_local);
        rtcCommitGeometry(placed);
        rtcAttachGeometryByID(root, placed, static_cast<unsigned>(instance_of_id.size()));
        instance_of_id.push_back(i);
        rtcReleaseGeometry(placed);
    }
    rtcCommitScene(root);
    check_device();
}

Hit Intersector::Implementation::make_hit(std::uint32_t instance_id, std::uint32_t geometry_id, std::uint32_t primitive,
                                          float distance, float u, float v) const {
    Hit hit;
    if (geometry_id == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.instance = owns_root ? instance_of_id[instance_id] : 0;
    hit.triangle = groups[geometry->instances[hit.instance].group]->triangle_of_primitive[geometry_id][primitive];
    hit.distance = distance;
    hit.u = u;
    hit.v = v;
    return hit;
}

Intersector::Intersector(std::shared_ptr<const Geometry> geometry, std::span<const Material> materials,
                         std::span<const std::shared_ptr<const Mask>> masks, BuildQuality quality)
    : implementation_(std::make_unique<Implementation>()) {
    constexpr RTCBuildQuality qualities[] = {RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH};
    std::vector<int> mask_of_material;
    for (const auto& material : materials) {
        if (material.mask >= static_cast<int>(masks.size())) throw std::invalid_argument("a material's mask names no mask");
        mask_of_material.push_back(material.mask);
    }
    for (const auto material : geometry->arrays->materials)
        if (material >= materials.size()) throw std::invalid_argument("a mesh names a material that is not there");
    implementation_->geometry = std::move(geometry);
    for (const auto& group : implementation_->geometry->groups)
        implementation_->groups.push_back(
            build_group(*implementation_->geometry, group, mask_of_material, masks, qualities[static_cast<int>(quality)]));
    implementation_->build_root();
}

Intersector::Intersector(const Intersector& still, std::shared_ptr<const Geometry> geometry)
    : implementation_(std::make_unique<Implementation>()) {
    if (geometry->arrays != still.geometry()->arrays) throw std::invalid_argument("moved: the geometry is another one");
    implementation_->geometry = std::move(geometry);
    implementation_->groups = still.implementation_->groups;
    implementation_->build_root();
}

Intersector::~Intersector() = default;

const std::shared_ptr<const Geometry>& Intersector::geometry() const { return implementation_->geometry; }

std::size_t Intersector::bytes() const { return 0; }

Hit Intersector::nearest(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = {ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 ray.near,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0,
                 ray.far,
                 ~0U,
                 0,
                 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(implementation_->root, &context, &query);
    return implementation_->make_hit(query.hit.instID[0], query.hit.geomID, query.hit.primID, query.ray.tfar, query.hit.u,
                                     query.hit.v);
}

bool Intersector::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query{ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 ray.near,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0,
                 ray.far,
                 ~0U,
                 0,
                 0};
    rtcOccluded1(implementation_->root, &context, &query);
    return query.tfar < 0.0f;
}

void Intersector::nearest_coherent(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = nearest(rays[i]);
}
void Intersector::occluded_coherent(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = occluded(rays[i]);
}
void Intersector::nearest_incoherent(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = nearest(rays[i]);
}
void Intersector::occluded_incoherent(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = occluded(rays[i]);
}

}  // namespace interreflect
