#include "visibility/intersector.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "visibility/ray_device.h"

namespace interreflect {
namespace {

/// Consecutive triangles with one mask or none: one geometry of the ray library, which reads our arrays in place.
struct Run {
    std::uint32_t first = 0, count = 0;  // global triangle numbers
    int mask = -1;
    const GeometryArrays* arrays = nullptr;
    const Mask* holes = nullptr;
};

/// One hierarchy: a group's triangles.
struct Hierarchy {
    RTCScene scene = nullptr;
    std::shared_ptr<const GeometryArrays> arrays;  // Embree reads the shared buffers for as long as it lives
    std::vector<std::shared_ptr<const Mask>> masks;
    std::vector<Run> runs;  // by geomID
    std::size_t bytes = 0;

    Hierarchy() = default;
    ~Hierarchy() {
        if (scene != nullptr) rtcReleaseScene(scene);
    }
    Hierarchy(const Hierarchy&) = delete;
    Hierarchy& operator=(const Hierarchy&) = delete;
};

/// Drops hits on the holes of a mask, for packets of any width.
void mask_filter(const RTCFilterFunctionNArguments* args) {
    const auto& run = *static_cast<const Run*>(args->geometryUserPtr);
    const auto& vertices = run.arrays->vertices;
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const float u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
        const uvec3 t = run.arrays->triangles[run.first + RTCHitN_primID(args->hit, args->N, i)];
        const vec2 uv = vertices[t.x].texcoord * (1.0f - u - v) + vertices[t.y].texcoord * u + vertices[t.z].texcoord * v;
        if (!run.holes->solid(uv)) args->valid[i] = 0;
    }
}

void attach_run(const Hierarchy& hierarchy, const Group& group, std::size_t number, RTCBuildQuality quality) {
    const Run& run = hierarchy.runs[number];
    const RTCGeometry geometry = rtcNewGeometry(ray_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, hierarchy.arrays->positions.data(), 0,
                               sizeof(vec3), group.first_vertex + group.vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, hierarchy.arrays->triangles.data(),
                               run.first * sizeof(uvec3), sizeof(uvec3), run.count);
    if (run.mask >= 0) {
        rtcSetGeometryUserData(geometry, const_cast<Run*>(&run));
        rtcSetGeometryIntersectFilterFunction(geometry, mask_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, mask_filter);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(hierarchy.scene, geometry, static_cast<unsigned>(number));
    rtcReleaseGeometry(geometry);
}

/// Cuts a group into runs; meshes have one material each, so there are never more runs than meshes.
std::vector<Run> cut_runs(const GeometryArrays& arrays, const Group& group, const std::vector<int>& mask_of_material,
                          std::span<const std::shared_ptr<const Mask>> masks) {
    std::vector<Run> runs;
    for (std::uint32_t i = group.first_triangle; i < group.first_triangle + group.triangle_count; ++i) {
        const int mask = mask_of_material[arrays.materials[i]];
        if (runs.empty() || runs.back().mask != mask)
            runs.push_back({i, 0, mask, &arrays, mask >= 0 ? masks[mask].get() : nullptr});
        ++runs.back().count;
    }
    return runs;
}

std::shared_ptr<const Hierarchy> build_group(const Geometry& geometry, const Group& group,
                                             const std::vector<int>& mask_of_material,
                                             std::span<const std::shared_ptr<const Mask>> masks, RTCBuildQuality quality) {
    auto hierarchy = std::make_shared<Hierarchy>();
    const std::ptrdiff_t before = ray_device_bytes();
    hierarchy->arrays = geometry.arrays;
    hierarchy->masks.assign(masks.begin(), masks.end());
    hierarchy->runs = cut_runs(*geometry.arrays, group, mask_of_material, masks);
    hierarchy->scene = rtcNewScene(ray_device());
    rtcSetSceneBuildQuality(hierarchy->scene, quality);
    for (std::size_t i = 0; i < hierarchy->runs.size(); ++i) attach_run(*hierarchy, group, i, quality);
    rtcCommitScene(hierarchy->scene);
    check_ray_device();
    hierarchy->bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, ray_device_bytes() - before));
    return hierarchy;
}

static_assert(sizeof(RTCRayHit16) == sizeof(RayPacket) && offsetof(RTCRayHit16, ray.tfar) == offsetof(RayPacket, far) &&
              offsetof(RTCRayHit16, hit.primID) == offsetof(RayPacket, triangle) &&
              offsetof(RTCRayHit16, hit.instID) == offsetof(RayPacket, instance));

/// The widest packets that run as such, in lanes. The library takes wider ones, but of those it traces lanes that are not valid
/// too.
int native_lanes() {
    static const int lanes = [] {
        const auto has = [](RTCDeviceProperty property) { return rtcGetDeviceProperty(ray_device(), property) != 0; };
        if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
        return has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
    }();
    return lanes;
}

struct alignas(64) ValidLanes {
    int lane[RayPacket::width];
    explicit ValidLanes(std::uint32_t active) {
        for (int i = 0; i < RayPacket::width; ++i) lane[i] = -static_cast<int>((active >> i) & 1U);
    }
};

/// Calls with pieces of so many lanes, one after the other: a packet is rows of sixteen lanes, a piece of it rows of fewer.
template <int lanes, class Piece, class Call>
void in_pieces(const ValidLanes& valid, RayPacket& packet, const Call& call) {
    constexpr std::size_t bytes = sizeof(float) * lanes, rows = sizeof(Piece) / bytes;
    for (int first = 0; first < RayPacket::width; first += lanes) {
        Piece piece;
        auto* wide = reinterpret_cast<char*>(&packet) + sizeof(float) * static_cast<std::size_t>(first);
        auto* narrow = reinterpret_cast<char*>(&piece);
        for (std::size_t row = 0; row < rows; ++row)
            std::memcpy(narrow + row * bytes, wide + row * sizeof(float) * RayPacket::width, bytes);
        alignas(32) int mask[lanes];
        std::memcpy(mask, valid.lane + first, sizeof(mask));
        call(mask, &piece);
        for (std::size_t row = 0; row < rows; ++row)
            std::memcpy(wide + row * sizeof(float) * RayPacket::width, narrow + row * bytes, bytes);
    }
}

void intersect_packet(RTCScene scene, RTCIntersectContext& context, const ValidLanes& valid, RayPacket& packet) {
    switch (native_lanes()) {
        case 16:
            return rtcIntersect16(valid.lane, scene, &context, reinterpret_cast<RTCRayHit16*>(&packet));
        case 8:
            return in_pieces<8, RTCRayHit8>(
                valid, packet, [&](const int* mask, RTCRayHit8* piece) { rtcIntersect8(mask, scene, &context, piece); });
        default:
            return in_pieces<4, RTCRayHit4>(
                valid, packet, [&](const int* mask, RTCRayHit4* piece) { rtcIntersect4(mask, scene, &context, piece); });
    }
}

void occlude_packet(RTCScene scene, RTCIntersectContext& context, const ValidLanes& valid, RayPacket& packet) {
    switch (native_lanes()) {
        case 16:
            return rtcOccluded16(valid.lane, scene, &context, reinterpret_cast<RTCRay16*>(&packet));
        case 8:
            return in_pieces<8, RTCRay8>(valid, packet,
                                         [&](const int* mask, RTCRay8* piece) { rtcOccluded8(mask, scene, &context, piece); });
        default:
            return in_pieces<4, RTCRay4>(valid, packet,
                                         [&](const int* mask, RTCRay4* piece) { rtcOccluded4(mask, scene, &context, piece); });
    }
}

RTCRay library_ray(const Ray& ray) {
    const vec3 &o = ray.origin, &d = ray.direction;
    return {o.x, o.y, o.z, ray.near, d.x, d.y, d.z, 0, ray.far, ~0U, 0, 0};
}

}  // namespace

struct Intersector::Implementation {
    std::shared_ptr<const Geometry> geometry;
    std::vector<std::shared_ptr<const Hierarchy>> groups;
    RTCScene root = nullptr;                    // groups[0]'s scene where nothing else is placed
    std::vector<std::uint32_t> instance_of_id;  // by instID of the root; empty where the root is groups[0]'s
    bool owns_root = false;
    std::size_t root_bytes = 0;

    ~Implementation() {
        if (owns_root) rtcReleaseScene(root);
    }
    void build_root();
    Hit make_hit(std::uint32_t instance_id, std::uint32_t geometry_id, std::uint32_t primitive, float distance, float u,
                 float v) const;
    void number_hits(RayPacket& packet, std::uint32_t active) const;
};

void Intersector::Implementation::build_root() {
    if (geometry->instances.size() == 1) {
        root = groups[0]->scene;
        return;
    }
    const std::ptrdiff_t before = ray_device_bytes();
    root = rtcNewScene(ray_device());
    owns_root = true;
    for (std::uint32_t i = 0; i < geometry->instances.size(); ++i) {
        const Instance& instance = geometry->instances[i];
        if (geometry->groups[instance.group].triangle_count == 0) continue;
        const RTCGeometry placed = rtcNewGeometry(ray_device(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(placed, groups[instance.group]->scene);
        rtcSetGeometryTransform(placed, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &instance.world_from_local);
        rtcCommitGeometry(placed);
        rtcAttachGeometryByID(root, placed, static_cast<unsigned>(instance_of_id.size()));
        instance_of_id.push_back(i);
        rtcReleaseGeometry(placed);
    }
    rtcCommitScene(root);
    check_ray_device();
    root_bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, ray_device_bytes() - before));
}

Hit Intersector::Implementation::make_hit(std::uint32_t instance_id, std::uint32_t geometry_id, std::uint32_t primitive,
                                          float distance, float u, float v) const {
    Hit hit;
    if (geometry_id == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.instance = owns_root ? instance_of_id[instance_id] : 0;
    hit.triangle = groups[geometry->instances[hit.instance].group]->runs[geometry_id].first + primitive;
    hit.distance = distance;
    hit.u = u;
    hit.v = v;
    return hit;
}

/// Replaces the ray library's numbers by ours.
void Intersector::Implementation::number_hits(RayPacket& packet, std::uint32_t active) const {
    const Run* runs = owns_root ? nullptr : groups[0]->runs.data();
    for (int i = 0; i < RayPacket::width; ++i) {
        if (((active >> i) & 1U) == 0 || packet.geometry[i] == RTC_INVALID_GEOMETRY_ID) {
            packet.triangle[i] = packet.instance[i] = Hit{}.triangle;
            continue;
        }
        packet.instance[i] = owns_root ? instance_of_id[packet.instance[i]] : 0;
        const Run* of_group = owns_root ? groups[geometry->instances[packet.instance[i]].group]->runs.data() : runs;
        packet.triangle[i] += of_group[packet.geometry[i]].first;
    }
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

std::size_t Intersector::bytes() const {
    std::size_t sum = implementation_->root_bytes;
    for (const auto& group : implementation_->groups) sum += group->bytes;
    return sum;
}

Hit Intersector::nearest(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray = library_ray(ray);
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(implementation_->root, &context, &query);
    return implementation_->make_hit(query.hit.instID[0], query.hit.geomID, query.hit.primID, query.ray.tfar, query.hit.u,
                                     query.hit.v);
}

bool Intersector::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = library_ray(ray);
    rtcOccluded1(implementation_->root, &context, &query);
    return query.tfar < 0.0f;
}

void Intersector::nearest(RayPacket& packet, std::uint32_t active) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::fill_n(packet.time, RayPacket::width, 0.0f);
    std::fill_n(packet.reserved[0], RayPacket::width, ~0U);  // the ray mask
    std::fill_n(packet.geometry, RayPacket::width, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet.instance, RayPacket::width, RTC_INVALID_GEOMETRY_ID);
    intersect_packet(implementation_->root, context, ValidLanes(active), packet);
    implementation_->number_hits(packet, active);
}

// Embree 3.13.5, as Debian compiles it for AVX-512, stores 16 bits of a lane mask and reads 64 in its coherent any-hit traversal
// of instances: what lies above them on the stack can keep it from ever ending. Its other traversals do not.
std::uint32_t Intersector::occluded(RayPacket& packet, std::uint32_t active) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = implementation_->owns_root ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::fill_n(packet.time, RayPacket::width, 0.0f);
    std::fill_n(packet.reserved[0], RayPacket::width, ~0U);
    occlude_packet(implementation_->root, context, ValidLanes(active), packet);
    std::uint32_t blocked = 0;
    for (int i = 0; i < RayPacket::width; ++i) blocked |= static_cast<std::uint32_t>(packet.far[i] < 0.0f) << i;
    return blocked & active;
}

void Intersector::nearest_coherent(std::span<const Ray> rays, std::span<Hit> hits) const {
    RayPacket packet;
    for (std::size_t begin = 0; begin < rays.size(); begin += RayPacket::width) {
        const int count = static_cast<int>(std::min<std::size_t>(RayPacket::width, rays.size() - begin));
        for (int i = 0; i < count; ++i) packet.set(i, rays[begin + i]);
        nearest(packet, (1U << count) - 1U);
        for (int i = 0; i < count; ++i) hits[begin + i] = packet.hit(i);
    }
}

// Incoherent nearest hits cost the same ray by ray, in packets and in streams (PEERS.md); any-hit gains from streams of 256.
void Intersector::nearest_incoherent(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = nearest(rays[i]);
}

void Intersector::occluded_incoherent(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    constexpr std::size_t stream = 256;
    std::array<RTCRay, stream> queries;
    for (std::size_t begin = 0; begin < rays.size(); begin += stream) {
        const std::size_t count = std::min(stream, rays.size() - begin);
        for (std::size_t i = 0; i < count; ++i) queries[i] = library_ray(rays[begin + i]);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1M(implementation_->root, &context, queries.data(), static_cast<unsigned>(count), sizeof(RTCRay));
        for (std::size_t i = 0; i < count; ++i) blocked[begin + i] = queries[i].tfar < 0.0f;
    }
}

}  // namespace interreflect
