#include "direct/reflective_shadow_map.h"

#include <stdexcept>
#include <string>

#include "math/radical_inverse.h"
#include "math/sampling.h"
#include "visibility/light_view.h"
#include "visibility/surface.h"
#include "visibility/surface_kernel.h"

namespace interreflect {
namespace {

// What a texel covers of a surface that it sees at a grazing angle is bounded: the texel's own border is then cruder than that.
constexpr float least_cosine = 0.05f;

/// A spot in one picture, or a directional light.
struct PictureView {
    LightView view;
    vec3 irradiance{0};  // of a directional light
    const LightSampler* lights = nullptr;
    int light = 0;
    int size = view.size;
    float texel = 4.0f * view.half_x * view.half_y / (static_cast<float>(size) * static_cast<float>(size));

    void rays(int x0, int y0, RayPacket& packet) const { view.rays(x0, y0, packet); }
    /// Along a texel's ray, by the cube of its cosine: of the plane at distance 1.
    float solid_angle(const vec3& direction) const {
        const float cosine = parallel() ? 1.0f : glm::dot(direction, view.forward);
        return texel * cosine * cosine * cosine;
    }
    bool parallel() const { return !view.perspective; }
    vec3 incident(float measure, const vec3& direction) const {
        return (parallel() ? irradiance : lights->intensity(light, direction)) * measure;
    }
};

/// Rays through the centres of 4 x 4 texels, one by one.
template <class View>
void rays_of(const View& view, int x0, int y0, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::width; ++lane) {
        const int x = x0 + lane % 4, y = y0 + lane / 4;
        packet.set(lane, view.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    }
}

/// All around a point or spot light: texels of equal solid angle.
struct SphereView {
    vec3 origin;
    const LightSampler* lights;
    int light;
    int size;

    Ray ray(float x, float y) const {
        return {origin, 0.0f, uniform_sphere({x / static_cast<float>(size), y / static_cast<float>(size)})};
    }
    void rays(int x0, int y0, RayPacket& packet) const { rays_of(*this, x0, y0, packet); }
    float solid_angle(const vec3&) const { return 4.0f * pi / (static_cast<float>(size) * static_cast<float>(size)); }
    bool parallel() const { return false; }
    vec3 incident(float measure, const vec3& direction) const { return lights->intensity(light, direction) * measure; }
};

/// The hemisphere above a surface: texels of equal solid angle times cosine [Nusselt's disk, Shirley and Chiu's map].
struct HemisphereView {
    const DiskView& disk;
    int size;
    Frame frame{disk.normal};

    vec3 local(float x, float y) const { return cosine_hemisphere({x / static_cast<float>(size), y / static_cast<float>(size)}); }
    float texels() const { return static_cast<float>(size) * static_cast<float>(size); }
    Ray ray(float x, float y) const { return {disk.position + disk.normal * disk.offset, 0.0f, frame.to_world(local(x, y))}; }
    void rays(int x0, int y0, RayPacket& packet) const { rays_of(*this, x0, y0, packet); }
    float solid_angle(const vec3& direction) const {
        return pi / (texels() * glm::max(glm::dot(direction, disk.normal), least_cosine));
    }
    bool parallel() const { return false; }
    vec3 incident(float, const vec3&) const { return disk.flux / texels(); }
};

void clear_texel(ReflectiveShadowMap& map, std::size_t texel) {
    map.position[texel] = map.normal[texel] = map.incident[texel] = map.flux[texel] = map.specular[texel] = vec3(0);
    map.alpha[texel] = 1.0f;
    map.area[texel] = map.offset[texel] = 0.0f;
}

vec3 lane_of(const SurfacePacket::Lanes* rows, int lane) { return {rows[0][lane], rows[1][lane], rows[2][lane]}; }

// Roofline: a ray of the rate of neighbouring ones and 72 bytes a texel. What is done for each surface must hide behind that: it
// is done by vectors, and for several packets in turn, so that triangles and texels are there when they are needed.
template <class View>
class MapTracer {
  public:
    MapTracer(const Scene& scene, const Intersector& intersector, const View& view, ReflectiveShadowMap& map)
        : scene_(scene), intersector_(intersector), view_(view), map_(map), kernel_(scene) {}

    void trace(const Tile& tile) const {
        Packet packets[together];
        int count = 0;
        for (int y0 = tile.y0; y0 < tile.y1; y0 += side)
            for (int x0 = tile.x0; x0 < tile.x1; x0 += side) {
                start(packets[count], tile, x0, y0);
                if (++count == together) finish({packets, std::size_t(std::exchange(count, 0))});
            }
        finish({packets, static_cast<std::size_t>(count)});
    }

  private:
    static constexpr int side = 4, together = 8;
    struct Packet {
        RayPacket rays;
        SurfacePacket surfaces;
        int x0, y0;
        std::uint32_t active, plain;
    };

    void start(Packet& packet, const Tile& tile, int x0, int y0) const {
        packet.x0 = x0, packet.y0 = y0, packet.active = 0;
        view_.rays(x0, y0, packet.rays);
        for (int lane = 0; lane < RayPacket::width; ++lane)
            packet.active |= static_cast<std::uint32_t>(x0 + lane % side < tile.x1 && y0 + lane / side < tile.y1) << lane;
        intersector_.nearest(packet.rays, packet.active);
        prefetch_hits(kernel_, packet.rays);
    }
    void finish(std::span<Packet> packets) const {
        for (Packet& p : packets) p.plain = plain_surfaces(kernel_, p.rays, p.active);
        for (Packet& p : packets)
            if (p.plain != 0) place_surfaces(kernel_, p.rays, p.plain, p.surfaces);
        for (Packet& p : packets) {
            if (p.plain != 0) texture_surfaces(kernel_, p.plain, p.surfaces);
            for (std::uint32_t left = p.active; left != 0; left &= left - 1) store(p, __builtin_ctz(left));
        }
    }
    void store(Packet& packet, int lane) const {
        const int x = packet.x0 + lane % side, y = packet.y0 + lane / side;
        const std::size_t texel = static_cast<std::size_t>(y) * map_.size + x;
        const RayPacket& rays = packet.rays;
        SurfacePacket& surfaces = packet.surfaces;
        if (!rays.met(lane)) return clear_texel(map_, texel);
        const vec3 direction(rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]);
        if (((packet.plain >> lane) & 1U) == 0) surfaces.set(lane, surface_at(scene_, rays.hit(lane), direction));
        const float solid_angle = view_.solid_angle(direction);
        const KernelMaterial& material = kernel_.materials[surfaces.material[lane]];
        map_.position[texel] = lane_of(surfaces.position, lane);
        map_.normal[texel] = lane_of(surfaces.normal, lane);
        map_.incident[texel] = view_.incident(solid_angle, direction);
        map_.flux[texel] = map_.incident[texel] * lane_of(surfaces.albedo, lane);
        const bool glossy = surfaces.lobe[lane] != SurfacePacket::no_lobe;
        map_.specular[texel] = glossy ? vec3(material.specular[0], material.specular[1], material.specular[2]) : vec3(0);
        map_.alpha[texel] = material.alpha;
        const float cosine = glm::max(std::fabs(glm::dot(direction, lane_of(surfaces.geometric_normal, lane))), least_cosine);
        const float reach = view_.parallel() ? 1.0f : rays.far[lane] * rays.far[lane];
        map_.area[texel] = solid_angle * reach / cosine;
        map_.offset[texel] = surfaces.offset[lane];
    }

    const Scene& scene_;
    const Intersector& intersector_;
    const View& view_;
    ReflectiveShadowMap& map_;
    SurfaceKernel kernel_;
};

template <class View>
ReflectiveShadowMap trace_map(const Scene& scene, const Intersector& intersector, const View& view) {
    const int size = view.size;
    const auto n = static_cast<std::size_t>(size) * size;
    ReflectiveShadowMap map{size,
                            Buffer<vec3>(n),
                            Buffer<vec3>(n),
                            Buffer<vec3>(n),
                            Buffer<vec3>(n),
                            Buffer<vec3>(n),
                            Buffer<float>(n),
                            Buffer<float>(n),
                            Buffer<float>(n),
                            {}};
    map.counts.rays = n;
    const MapTracer<View> tracer(scene, intersector, view, map);
    parallel_tiles(size, size, view_tile_side, [&](const Tile& tile) { tracer.trace(tile); });
    return map;
}

void check_size(int size) {
    constexpr int most = 1 << 14;
    if (size < 1 || size > most)
        throw std::invalid_argument("size must lie in [1, " + std::to_string(most) + "] texels, got " + std::to_string(size));
}

ReflectiveShadowMap map_of(const Scene& scene, const Intersector& intersector, const DirectionalLight& light, int size) {
    return trace_map(scene, intersector, PictureView{view_of(light, scene.geometry->bounds(), size), light.irradiance});
}

/// Of so many texels on a side for all, how many each of some views has.
int side_of_each(int size, int views) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(size) / std::sqrt(static_cast<double>(views)))));
}

ReflectiveShadowMap map_of_delta(const Scene& scene, const Intersector& intersector, const LightSampler& lights, int light,
                                 int size) {
    const int points = static_cast<int>(scene.point_lights.size()), spots = static_cast<int>(scene.spot_lights.size());
    if (light < points)
        return trace_map(scene, intersector, SphereView{scene.point_lights[light].position, &lights, light, size});
    if (light < points + spots) {
        const SpotLight& spot = scene.spot_lights[light - points];
        const auto views = views_of(spot, size);
        if (views.size() == 1) return trace_map(scene, intersector, PictureView{views[0], vec3(0), &lights, light});
        return trace_map(scene, intersector, SphereView{spot.position, &lights, light, size});
    }
    return map_of(scene, intersector, scene.directional_lights[light - points - spots], size);
}

void append_emitters(const Scene& scene, const Intersector& intersector, const LightSampler& lights, const LightMapKnobs& knobs,
                     std::vector<ReflectiveShadowMap>& maps) {
    const int views = knobs.emitter_views, size = side_of_each(knobs.size, views);
    for (int i = 0; i < views; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        const float choose = (static_cast<float>(i) + 0.5f) / static_cast<float>(views);
        const auto point = lights.sample_emitter_point(choose, {radical_inverse(2, index + 1), radical_inverse(3, index + 1)});
        const vec3 flux = point.radiance * (pi / (point.pdf * static_cast<float>(views)));
        const float offset = self_hit_offset(*scene.geometry, point.instance, point.triangle);
        maps.push_back(reflective_shadow_map(scene, intersector, DiskView{point.position, point.normal, flux, offset}, size));
    }
}

}  // namespace

ReflectiveShadowMap reflective_shadow_map(const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                                          int light, int size) {
    check_size(size);
    const int points = static_cast<int>(scene.point_lights.size()), count = lights.delta_count();
    if (light < points || light >= count)
        throw std::invalid_argument("light must name a spot or directional light, a number in [" + std::to_string(points) + ", " +
                                    std::to_string(count) + "), got " + std::to_string(light));
    if (views_of_light(scene, light, size).size() != 1)
        throw std::invalid_argument("light: a spot with a reflective shadow map must be narrower than 75 degrees");
    return map_of_delta(scene, intersector, lights, light, size);
}

ReflectiveShadowMap reflective_shadow_map(const Scene& scene, const Intersector& intersector, const DiskView& disk, int size) {
    check_size(size);
    return trace_map(scene, intersector, HemisphereView{disk, size});
}

std::size_t LightMaps::texels() const {
    std::size_t sum = 0;
    for (const auto& map : maps) sum += map.texels();
    return sum;
}
std::size_t LightMaps::bytes() const {
    std::size_t sum = 0;
    for (const auto& map : maps) sum += map.bytes();
    return sum;
}

LightMaps light_maps(const Scene& scene, const Intersector& intersector, const LightSampler& lights, const LightMapKnobs& knobs) {
    check_size(knobs.size);
    if (knobs.emitter_views < 1)
        throw std::invalid_argument("emitter_views must be at least 1, got " + std::to_string(knobs.emitter_views));
    LightMaps result;
    for (int light = 0; light < lights.delta_count(); ++light)
        result.maps.push_back(map_of_delta(scene, intersector, lights, light, knobs.size));
    if (lights.has_emitters()) append_emitters(scene, intersector, lights, knobs, result.maps);
    const int size = side_of_each(knobs.size, static_cast<int>(knobs.environment.size()));
    for (const DirectionalLight& light : knobs.environment) result.maps.push_back(map_of(scene, intersector, light, size));
    for (const auto& map : result.maps) result.counts += map.counts;
    return result;
}

}  // namespace interreflect
