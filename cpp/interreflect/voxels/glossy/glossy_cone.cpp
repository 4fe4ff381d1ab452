#include "voxels/glossy/glossy_cone.h"

#include <algorithm>
#include <vector>

#include "data/environment.h"
#include "math/parallel.h"
#include "voxels/glossy/lobe_table.h"
#include "voxels/march/cone_environment.h"
#include "voxels/march/gather.h"
#include "voxels/march/march_cones.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16;
constexpr float degrees_a_width = 1.25f;  // half angles are rounded to this: cones of one width share a table of steps
constexpr int widths = 49;  // 0 to 60 degrees; wider lobes reach below the surface and gain nothing from wider cones

/// One pixel's cone.
struct Reflection {
    int pixel, width;
    vec3 surface, direction, albedo;  // surface: linear voxels
};

struct Work {
    const Pyramid& pyramid;
    const GBuffer& gbuffer;
    const Scene& scene;
    AirMap air;
    const LobeTable* tables[3];  // by lobe; null where no material has it
    std::vector<ConeSchedule> schedules;
    std::vector<ConeEnvironment> environments;  // of cones 0, 15, 30, 45, 60 degrees wide (half angle)
    float normal_offset, cut_off;
    bool own_surface;

    vec3 sky(const Reflection& cone, const vec3& direction) const {
        const int nearest = static_cast<int>(std::lround(static_cast<float>(cone.width) * degrees_a_width / 15.0f));
        return nearest == 0 ? environment_radiance(scene, direction) : environments[nearest].mean(direction);
    }
};

Reflection reflect(const Work& work, int pixel) {
    const GBuffer& g = work.gbuffer;
    const vec3 normal = g.normal[pixel], view = glm::normalize(g.camera.position - g.position[pixel]);
    const float cosine = std::fmax(glm::dot(normal, view), 0.0f);
    const Lobe lobe = work.scene.materials[work.scene.material_of(g.triangle[pixel])].lobe;
    const LobeCone cone = work.tables[static_cast<int>(lobe)]->at(g.alpha[pixel], cosine);
    const vec3 across = normal * cosine - view;  // the mirrored view's part along the surface
    const float length = glm::length(across);
    const vec3 tangent = length > 1e-6f ? across / length : Frame(normal).tangent;
    const vec3 specular = g.specular[pixel];
    const float degrees = cone.half_angle / degrees_to_radians;
    return {pixel, std::min(static_cast<int>(std::lround(degrees / degrees_a_width)), widths - 1),
            work.pyramid.domain.to_linear(g.position[pixel]),
            glm::normalize(tangent * cone.direction.x + normal * cone.direction.y),
            specular * cone.scale + (vec3(1) - specular) * (lobe == Lobe::ggx ? cone.bias : 0.0f)};
}

/// Marches reflections of one width.
Counts march_width(const Work& work, std::span<const Reflection> cones, ConeBatch& batch, Buffer<vec4>& voxels,
                   Buffer<vec4>& sky) {
    batch.count = static_cast<int>(cones.size());
    for (int i = 0; i < batch.count; ++i) {
        const vec3 normal = work.gbuffer.geometric_normal[cones[i].pixel];
        set_start(batch, i, work.pyramid.domain, cones[i].surface, normal, work.normal_offset, work.own_surface);
        set_direction(batch, i, normal, cones[i].direction);
    }
    const ConeCounts done = march_cones(work.pyramid, work.air, work.schedules[cones.front().width], work.cut_off, batch);
    for (int i = 0; i < batch.count; ++i) {
        voxels[cones[i].pixel] = vec4(vec3(batch.r[i], batch.g[i], batch.b[i]) * cones[i].albedo, 0);
        sky[cones[i].pixel] = vec4(work.sky(cones[i], cones[i].direction) * cones[i].albedo * batch.open[i], 0);
    }
    Counts counts;
    counts.cones = cones.size(), counts.cone_steps = done.steps, counts.voxel_fetches = done.fetches;
    return counts;
}

Counts march_tile(const Work& work, const Tile& tile, Buffer<vec4>& voxels, Buffer<vec4>& sky) {
    thread_local std::vector<Reflection> cones;
    thread_local ConeBatch batch;
    cones.clear();
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            const int pixel = y * work.gbuffer.width + x;
            voxels[pixel] = sky[pixel] = vec4(0);
            if (work.gbuffer.hit(pixel) && max_component(work.gbuffer.specular[pixel]) > 0.0f)
                cones.push_back(reflect(work, pixel));
        }
    std::stable_sort(cones.begin(), cones.end(), [](const Reflection& a, const Reflection& b) { return a.width < b.width; });
    Counts counts;
    for (std::size_t begin = 0, end = 0; begin < cones.size(); begin = end) {
        while (end < cones.size() && cones[end].width == cones[begin].width) ++end;
        counts += march_width(work, std::span<const Reflection>(cones).subspan(begin, end - begin), batch, voxels, sky);
    }
    return counts;
}

Work prepare(const GlossyCone& technique, const Pyramid& pyramid, const GBuffer& gbuffer, const Scene& scene) {
    Work work{pyramid,
              gbuffer,
              scene,
              AirMap(pyramid),
              {},
              {},
              {},
              static_cast<float>(technique.normal_offset),
              static_cast<float>(technique.cut_off),
              technique.own_surface};
    for (const auto& material : scene.materials)
        if (material.glossy()) work.tables[static_cast<int>(material.lobe)] = &lobe_table(material.lobe);
    for (int width = 0; width < widths; ++width)
        work.schedules.push_back(
            make_schedule(technique.shape(static_cast<float>(width) * degrees_a_width * degrees_to_radians), pyramid));
    for (int i = 0; i <= 4; ++i) work.environments.emplace_back(scene, static_cast<float>(i) * 15.0f * degrees_to_radians);
    return work;
}

}  // namespace

GlossyLight glossy(const GlossyCone& technique, const Pyramid& pyramid, const GBuffer& gbuffer, const Scene& scene,
                   const Intersector&, std::uint32_t) {
    Buffer<vec4> voxels(gbuffer.pixels()), sky(gbuffer.pixels());
    const int columns = (gbuffer.width + tile_size - 1) / tile_size, rows = (gbuffer.height + tile_size - 1) / tile_size;
    std::vector<Counts> counts(static_cast<std::size_t>(columns) * rows);
    const Work work = prepare(technique, pyramid, gbuffer, scene);
    parallel_tiles(gbuffer.width, gbuffer.height, tile_size,
                   [&](const Tile& tile) { counts[tile.index] = march_tile(work, tile, voxels, sky); });
    return finish_glossy(gbuffer, voxels, pyramid.scale, sky, counts);
}

}  // namespace interreflect
