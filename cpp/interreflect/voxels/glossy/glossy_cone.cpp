#include "voxels/glossy/glossy_cone.h"

#include <algorithm>
#include <vector>

#include "data/environment.h"
#include "math/parallel.h"
#include "shading/pixel_lobe.h"
#include "voxels/glossy/lobe_table.h"
#include "voxels/march/cone_caster.h"
#include "voxels/march/cone_environment.h"
#include "voxels/march/gather.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16;
constexpr int widths = 49;            // half angles are rounded to so many: cones of one width share a table of steps
constexpr float widest = 60.0f;       // degrees; wider lobes reach below the surface and gain nothing from wider cones
constexpr float widest_freed = 9.0f;  // 0.1 pi is a full aperture of 18 degrees

/// One pixel's cone.
struct Reflection {
    int pixel, width;
    vec3 direction, albedo;
};

struct Work {
    const GBuffer& gbuffer;
    const Scene& scene;
    const GlossyCone& technique;
    float degrees_a_width = 0;
    const LobeTable* tables[lobe_count] = {};        // by lobe; null where no material has it
    std::vector<ConeCaster> casters = {};            // by width
    std::vector<ConeEnvironment> environments = {};  // of cones 0, 15, 30, 45, 60 degrees wide (half angle)

    bool reflects(int pixel) const { return gbuffer.hit(pixel) && max_component(gbuffer.specular[pixel]) > 0.0f; }
    vec3 sky(const Reflection& cone, const vec3& direction) const {
        const int nearest = static_cast<int>(std::lround(static_cast<float>(cone.width) * degrees_a_width / 15.0f));
        return nearest == 0 ? environment_radiance(scene, direction) : environments[nearest].mean(direction);
    }
    int width_of(const LobeCone& cone, float alpha) const {
        if (technique.half_angle > 0.0) return 1;
        const float degrees =
            technique.aperture == "freed" ? widest_freed * std::sqrt(alpha) : cone.half_angle / degrees_to_radians;
        return std::min(static_cast<int>(std::lround(degrees / degrees_a_width)), widths - 1);
    }
};

/// A pixel's lobe from where it is seen.
struct SeenLobe {
    vec3 view;
    float cosine;  // between normal and view
    Lobe lobe;
    LobeCone cone;

    SeenLobe(const Work& work, int pixel) {
        const GBuffer& g = work.gbuffer;
        view = glm::normalize(g.camera.position - g.position[pixel]);
        cosine = std::max(glm::dot(g.normal[pixel], view), 0.0f);
        lobe = lobe_at(g, work.scene.materials[work.scene.material_of(g.triangle[pixel])], pixel).lobe;
        cone = work.tables[static_cast<int>(lobe)]->at(g.alpha[pixel], cosine);
    }
    vec3 albedo(const vec3& specular) const {
        return specular * cone.scale + (vec3(1) - specular) * (has_microfacets(lobe) ? cone.bias : 0.0f);
    }
};

Reflection reflect(const Work& work, int pixel) {
    const GBuffer& g = work.gbuffer;
    const SeenLobe seen(work, pixel);
    const vec3 normal = g.normal[pixel];
    const vec3 across = normal * seen.cosine - seen.view;  // the mirrored view's part along the surface
    const float length = glm::length(across);
    const vec3 tangent = length > 1e-6f ? across / length : Frame(normal).tangent;
    const vec2 mean = work.technique.aperture == "freed" ? vec2(length, seen.cosine) : seen.cone.direction;
    return {pixel, work.width_of(seen.cone, g.alpha[pixel]), glm::normalize(tangent * mean.x + normal * mean.y),
            seen.albedo(g.specular[pixel])};
}

/// Marches reflections of one width.
Counts march_width(const Work& work, std::span<const Reflection> cones, ConeBatch& batch, Buffer<vec4>& voxels,
                   Buffer<vec4>& sky) {
    thread_local std::vector<ConeCaster::Cone> sent;
    sent.clear();
    const GBuffer& g = work.gbuffer;
    for (const Reflection& one : cones) {
        ConeCaster::Cone cone{g.position[one.pixel], g.geometric_normal[one.pixel], one.direction};
        cone.body = g.body[one.pixel];
        sent.push_back(cone);
    }
    const Counts counts = work.casters[cones.front().width].cast(sent, batch);
    if (work.technique.multiply_by_occlusion) multiply_by_openness(batch);
    for (int i = 0; i < batch.count; ++i) {
        voxels[cones[i].pixel] = vec4(vec3(batch.r[i], batch.g[i], batch.b[i]) * cones[i].albedo, 0);
        sky[cones[i].pixel] = vec4(work.sky(cones[i], cones[i].direction) * cones[i].albedo * batch.open[i], 0);
    }
    return counts;
}

Counts march_reflections(const Work& work, std::vector<Reflection>& cones, Buffer<vec4>& voxels, Buffer<vec4>& sky) {
    thread_local ConeBatch batch;
    std::stable_sort(cones.begin(), cones.end(), [](const Reflection& a, const Reflection& b) { return a.width < b.width; });
    Counts counts;
    for (std::size_t begin = 0, end = 0; begin < cones.size(); begin = end) {
        while (end < cones.size() && cones[end].width == cones[begin].width) ++end;
        counts += march_width(work, std::span<const Reflection>(cones).subspan(begin, end - begin), batch, voxels, sky);
    }
    return counts;
}

/// Calls visit(pixel) for each pixel of a tile.
template <class Visit>
void for_each_pixel(const Tile& tile, int row, const Visit& visit) {
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) visit(y * row + x, x, y);
}

/// Every pixel sends its own cone.
Counts march_tile(const Work& work, const Tile& tile, Buffer<vec4>& voxels, Buffer<vec4>& sky) {
    thread_local std::vector<Reflection> cones;
    cones.clear();
    for_each_pixel(tile, work.gbuffer.width, [&](int pixel, int, int) {
        voxels[pixel] = sky[pixel] = vec4(0);
        if (work.reflects(pixel)) cones.push_back(reflect(work, pixel));
    });
    return march_reflections(work, cones, voxels, sky);
}

/// The first pixel of each block sends its cone for all: what it sees, and how wide its lobe is.
Counts march_first(const Work& work, const Block& block, const Tile& tile, Buffer<vec4>& voxels, Buffer<vec4>& sky) {
    thread_local std::vector<Reflection> cones;
    cones.clear();
    for_each_pixel(tile, work.gbuffer.width, [&](int pixel, int x, int y) {
        voxels[pixel] = sky[pixel] = vec4(0);
        if (block.phase(x, y) != 0 || !work.reflects(pixel)) return;
        cones.push_back(reflect(work, pixel));
        cones.back().albedo = vec3(1);
    });
    const Counts counts = march_reflections(work, cones, voxels, sky);
    for (const auto& cone : cones) voxels[cone.pixel].w = 1.0f, sky[cone.pixel].w = work.gbuffer.alpha[cone.pixel];
    return counts;
}

/// From the mean over neighbours, those without a lobe included, to what the pixels of a tile reflect.
Counts finish_shared(const Work& work, const Tile& tile, Buffer<vec4>& voxels, Buffer<vec4>& sky) {
    constexpr float same_width = 1e-3f;  // relative
    thread_local std::vector<Reflection> alone;
    alone.clear();
    for_each_pixel(tile, work.gbuffer.width, [&](int pixel, int, int) {
        const float lobes = voxels[pixel].w, alpha = work.reflects(pixel) ? work.gbuffer.alpha[pixel] : 0.0f;
        const bool alike = lobes > 0.0f && std::fabs(sky[pixel].w - alpha * lobes) <= same_width * alpha * lobes;
        if (!work.reflects(pixel)) {
            voxels[pixel] = sky[pixel] = vec4(0);
        } else if (alike) {
            const vec3 albedo = SeenLobe(work, pixel).albedo(work.gbuffer.specular[pixel]) / lobes;
            voxels[pixel] *= vec4(albedo, 0);
            sky[pixel] *= vec4(albedo, 0);
        } else {
            alone.push_back(reflect(work, pixel));
        }
    });
    return march_reflections(work, alone, voxels, sky);
}

Work prepare(const GlossyCone& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene) {
    Work work{.gbuffer = gbuffer, .scene = scene, .technique = technique};
    const auto hierarchies = std::make_shared<const Hierarchies>(pyramids);
    work.degrees_a_width = technique.half_angle > 0.0 ? static_cast<float>(technique.half_angle)
                                                      : (technique.aperture == "freed" ? widest_freed : widest) / (widths - 1);
    for (const auto& material : scene.materials)
        if (material.glossy()) {
            const Lobe lobe = gbuffer.lobe.value_or(material.lobe);
            work.tables[static_cast<int>(lobe)] = &lobe_table(lobe);
        }
    for (int width = 0; width < (technique.half_angle > 0.0 ? 2 : widths); ++width)
        work.casters.emplace_back(hierarchies, technique, static_cast<float>(width) * work.degrees_a_width * degrees_to_radians);
    for (int i = 0; i <= 4; ++i) work.environments.emplace_back(scene, static_cast<float>(i) * 15.0f * degrees_to_radians);
    return work;
}

}  // namespace

GlossyLight glossy(const GlossyCone& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene, const Intersector&,
                   std::uint32_t) {
    Buffer<vec4> voxels(gbuffer.pixels()), sky(gbuffer.pixels());
    const int columns = (gbuffer.width + tile_size - 1) / tile_size, rows = (gbuffer.height + tile_size - 1) / tile_size;
    std::vector<Counts> counts(static_cast<std::size_t>(columns) * rows);
    const Work work = prepare(technique, pyramids, gbuffer, scene);
    const Block block = block_of(technique.share);
    const auto each_tile = [&](const auto& march) {
        parallel_tiles(gbuffer.width, gbuffer.height, tile_size, [&](const Tile& tile) { counts[tile.index] += march(tile); });
    };
    if (block.phases() == 1) {
        each_tile([&](const Tile& tile) { return march_tile(work, tile, voxels, sky); });
    } else {
        each_tile([&](const Tile& tile) { return march_first(work, block, tile, voxels, sky); });
        std::vector<float> weights(block.phases(), 0.0f);
        weights[0] = 1.0f;
        voxels = merge(technique.share, gbuffer, weights, std::move(voxels));
        sky = merge(technique.share, gbuffer, weights, std::move(sky));
        each_tile([&](const Tile& tile) { return finish_shared(work, tile, voxels, sky); });
    }
    return finish_glossy(gbuffer, voxels, pyramids.front()->scale, sky, counts);
}

}  // namespace interreflect
