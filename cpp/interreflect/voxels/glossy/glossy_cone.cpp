#include "voxels/glossy/glossy_cone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "data/environment.h"
#include "math/parallel.h"
#include "voxels/glossy/reflections.h"
#include "voxels/glossy/shared_reflections.h"
#include "voxels/march/cone_caster.h"
#include "voxels/march/cone_environment.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16;         // pixels or blocks on a side: as many as cones are marched together
constexpr int widths = 49;            // half angles are rounded to so many: cones of one width share a table of steps
constexpr float widest = 60.0f;       // degrees; wider lobes reach below the surface and gain nothing from wider cones
constexpr float widest_freed = 9.0f;  // 0.1 pi is a full aperture of 18 degrees
static_assert(tile_size * tile_size <= Reflections::capacity);

struct Work {
    const GBuffer& gbuffer;
    const Scene& scene;
    const GlossyCone& technique;
    LobeTables tables;
    float scale;  // of the voxels' radiance
    float degrees_a_width = 0;
    std::vector<ConeCaster> casters = {};            // by width
    std::vector<ConeEnvironment> environments = {};  // of cones 0, 15, 30, 45, 60 degrees wide (half angle); none without a sky

    bool freed() const { return technique.aperture == "freed"; }
    bool reflects(std::size_t pixel) const { return gbuffer.hit(pixel) && max_component(gbuffer.specular[pixel]) > 0.0f; }
    vec3 sky(int width, const vec3& direction) const {
        const int nearest = static_cast<int>(std::lround(static_cast<float>(width) * degrees_a_width / 15.0f));
        return nearest == 0 ? environment_radiance(scene, direction) : environments[nearest].mean(direction);
    }
    int width_of(const Reflections& of, int i) const {
        if (technique.half_angle > 0.0) return 1;
        const float degrees = freed() ? widest_freed * std::sqrt(of.alpha[i]) : of.half_angle[i] / degrees_to_radians;
        return std::min(static_cast<int>(std::lround(degrees / degrees_a_width)), widths - 1);
    }
};

/// The cones of a batch in the order of their widths: those of width w are order[begin[w]] up to order[begin[w + 1]].
struct ByWidth {
    std::array<std::uint16_t, Reflections::capacity> order;
    std::array<int, widths + 2> begin{};

    ByWidth(const Work& work, const Reflections& of) {
        std::array<std::uint8_t, Reflections::capacity> width;
        for (int i = 0; i < of.count; ++i) {
            width[i] = static_cast<std::uint8_t>(work.width_of(of, i));
            ++begin[width[i] + 2];
        }
        for (int w = 2; w < widths + 2; ++w) begin[w] += begin[w - 1];
        for (int i = 0; i < of.count; ++i) order[begin[width[i] + 1]++] = static_cast<std::uint16_t>(i);
    }
    std::span<const std::uint16_t> of(int width) const {
        return std::span(order).subspan(begin[width], begin[width + 1] - begin[width]);
    }
};

/// Marches the cones of one width.
Counts march_width(const Work& work, int width, std::span<const std::uint16_t> chosen, Reflections& of) {
    thread_local std::vector<ConeCaster::Cone> cones;
    thread_local ConeBatch batch;
    const GBuffer& g = work.gbuffer;
    cones.resize(chosen.size());
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const std::size_t pixel = of.pixel[chosen[k]];
        cones[k].position = g.position[pixel], cones[k].normal = g.geometric_normal[pixel];
        cones[k].direction = of.cone(chosen[k]);
        cones[k].body = g.body[pixel];
    }
    const Counts counts = work.casters[width].cast(cones, batch);
    if (work.technique.multiply_by_occlusion) multiply_by_openness(batch);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const int i = chosen[k];
        of.radiance[i] = {batch.r[k], batch.g[k], batch.b[k]};
        of.sky[i] = work.scene.environment ? work.sky(width, of.cone(i)) * batch.open[k] : vec3(0);
    }
    return counts;
}

/// Fills in the cones of a batch and what they see.
Counts march(const Work& work, Reflections& of) {
    find_lobes(work.tables, work.gbuffer.camera.position, work.freed(), of);
    const ByWidth by_width(work, of);
    Counts counts;
    for (int width = 0; width < widths; ++width)
        if (const auto chosen = by_width.of(width); !chosen.empty()) counts += march_width(work, width, chosen, of);
    return counts;
}

/// Marches the cones of a batch, each for its own pixel.
Counts march_own(const Work& work, Reflections& of, GlossyLight& light) {
    const Counts counts = march(work, of);
    for (int i = 0; i < of.count; ++i) {
        const vec3 albedo = of.albedo(i, work.gbuffer.specular[of.pixel[i]]);
        light.radiance[of.pixel[i]] = of.radiance[i] * albedo * work.scale;
        light.sky[of.pixel[i]] = of.sky[i] * albedo;
    }
    return counts;
}

/// Every pixel of a tile sends its own cone.
Counts march_tile(const Work& work, const Tile& tile, GlossyLight& light) {
    thread_local Reflections own;
    own.count = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * work.gbuffer.width + x;
            light.radiance[pixel] = light.sky[pixel] = vec3(0);
            if (work.reflects(pixel)) own.add(work.gbuffer, work.tables, pixel);
        }
    return march_own(work, own, light);
}

/// The first pixel of each of a tile's blocks sends its cone for all.
Counts march_blocks(const Work& work, const Tile& blocks, SharedReflections& shared) {
    thread_local Reflections first;
    first.count = 0;
    std::array<std::pair<int, int>, Reflections::capacity> block;
    for (int row = blocks.y0; row < blocks.y1; ++row) {
        shared.clear(row, blocks.x0, blocks.x1);
        for (int column = blocks.x0; column < blocks.x1; ++column) {
            const int x = column * shared.share().width, y = row * shared.share().height;
            const std::size_t pixel = static_cast<std::size_t>(y) * work.gbuffer.width + x;
            if (!work.reflects(pixel)) continue;
            block[first.count] = {row, column};
            first.add(work.gbuffer, work.tables, pixel);
        }
    }
    const Counts counts = march(work, first);
    for (int i = 0; i < first.count; ++i) shared.enter(block[i].first, block[i].second, first, i);
    return counts;
}

/// From what the blocks' first pixels see to what the pixels of a tile reflect.
Counts finish_tile(const Work& work, const SharedReflections& shared, const Tile& tile, GlossyLight& light) {
    thread_local Reflections alone;
    alone.count = 0;
    shared.finish(tile, work.gbuffer, work.tables, work.scale, light, alone);
    return march_own(work, alone, light);
}

Work prepare(const GlossyCone& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene) {
    Work work{.gbuffer = gbuffer,
              .scene = scene,
              .technique = technique,
              .tables = LobeTables(gbuffer, scene),
              .scale = pyramids.front()->scale};
    const auto hierarchies = std::make_shared<const Hierarchies>(pyramids);
    work.degrees_a_width = technique.half_angle > 0.0 ? static_cast<float>(technique.half_angle)
                                                      : (work.freed() ? widest_freed : widest) / (widths - 1);
    for (int width = 0; width < (technique.half_angle > 0.0 ? 2 : widths); ++width)
        work.casters.emplace_back(hierarchies, technique, static_cast<float>(width) * work.degrees_a_width * degrees_to_radians);
    for (int i = 0; scene.environment && i <= 4; ++i)
        work.environments.emplace_back(scene, static_cast<float>(i) * 15.0f * degrees_to_radians);
    return work;
}

/// Calls march(tile) for all tiles of a picture or of its blocks.
template <class March>
Counts march_tiles(int width, int height, const March& march) {
    const auto columns = static_cast<std::size_t>((width + tile_size - 1) / tile_size);
    std::vector<Counts> counts(columns * static_cast<std::size_t>((height + tile_size - 1) / tile_size));
    parallel_tiles(width, height, tile_size, [&](const Tile& tile) { counts[tile.index] = march(tile); });
    Counts sum;
    for (const auto& one : counts) sum += one;
    return sum;
}

}  // namespace

GlossyLight glossy(const GlossyCone& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene, const Intersector&,
                   std::uint32_t) {
    const int width = gbuffer.width, height = gbuffer.height;
    GlossyLight light{width, height, Buffer<vec3>(gbuffer.pixels()), Buffer<vec3>(gbuffer.pixels()), {}};
    const Work work = prepare(technique, pyramids, gbuffer, scene);
    const auto* share = std::get_if<Interleaved>(&technique.share);
    if (share == nullptr || block_of(*share).phases() == 1) {
        light.counts = march_tiles(width, height, [&](const Tile& tile) { return march_tile(work, tile, light); });
        return light;
    }
    SharedReflections shared(*share, gbuffer, scene.environment.has_value());
    light.counts =
        march_tiles(shared.columns(), shared.rows(), [&](const Tile& blocks) { return march_blocks(work, blocks, shared); });
    light.counts += march_tiles(width, height, [&](const Tile& tile) { return finish_tile(work, shared, tile, light); });
    return light;
}

}  // namespace interreflect
