#include "voxels/march/diffuse_cones.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "math/parallel.h"
#include "voxels/march/cone_environment.h"
#include "voxels/march/cone_set.h"
#include "voxels/march/gather.h"
#include "voxels/march/march_cones.h"

namespace interreflect {
namespace {

constexpr int most_receivers = 16;  // of one phase, on a side of a tile: neighbours that read the same texels
static_assert(most_receivers * most_receivers <= ConeBatch::capacity);

ConeSet choose_set(const DiffuseCones& technique) {
    const auto half_angle = static_cast<float>(technique.half_angle) * degrees_to_radians;
    if (technique.set == "cosine") return cosine_cones(technique.cones, half_angle);
    ConeSet set = technique.set == "freed_thesis" ? freed_thesis_cones() : freed_program_cones();
    if (half_angle > 0.0f) set.half_angle = half_angle;
    return set;
}

/// Everything that all tiles share.
struct Work {
    const Pyramid& pyramid;
    const GBuffer& gbuffer;
    ConeSet set;
    ConeSchedule schedule;
    ConeEnvironment environment;
    Block block;
    float normal_offset, cut_off;
    bool own_surface;
};

/// The pixels of one phase in one tile, ready to march any cone from.
struct Receivers {
    int count = 0;
    int pixel[ConeBatch::capacity];
    vec3 surface[ConeBatch::capacity], facing[ConeBatch::capacity];  // voxels; geometric normal
    vec3 tangent[ConeBatch::capacity], bitangent[ConeBatch::capacity], normal[ConeBatch::capacity];
};

void find_receivers(const Work& work, const Tile& tile, int phase, Receivers& found) {
    const GBuffer& g = work.gbuffer;
    found.count = 0;
    // Tiles begin on a block's border.
    for (int y = tile.y0 + phase / work.block.width; y < tile.y1; y += work.block.height)
        for (int x = tile.x0 + phase % work.block.width; x < tile.x1; x += work.block.width) {
            const int pixel = y * g.width + x;
            if (!g.hit(pixel)) continue;
            const Frame frame(g.normal[pixel]);
            const int i = found.count++;
            found.pixel[i] = pixel;
            found.surface[i] = work.pyramid.domain.to_voxels(g.position[pixel]);
            found.facing[i] = g.geometric_normal[pixel];
            found.tangent[i] = frame.tangent;
            found.bitangent[i] = frame.bitangent;
            found.normal[i] = frame.normal;
        }
}

void fill_batch(const Work& work, const Receivers& from, const vec3& cone, ConeBatch& batch) {
    batch.count = from.count;
    for (int i = 0; i < from.count; ++i) {
        const vec3 d = from.tangent[i] * cone.x + from.bitangent[i] * cone.y + from.normal[i] * cone.z;
        set_cone(batch, i, from.surface[i], from.facing[i], work.normal_offset, d, work.own_surface);
    }
}

/// Marches one phase's cones for its pixels of a tile; adds to `voxels` (radiance and openness) and, where it varies, `sky`.
Counts march_phase(const Work& work, int phase, const Receivers& receivers, ConeBatch& batch, Buffer<vec4>& voxels,
                   Buffer<vec4>& sky) {
    Counts counts;
    const bool image = !work.environment.constant();
    for (std::size_t c = phase; c < work.set.cones.size(); c += work.block.phases()) {
        const auto& cone = work.set.cones[c];
        fill_batch(work, receivers, cone.direction, batch);
        const ConeCounts done = march_cones(work.pyramid, work.schedule, work.cut_off, batch);
        counts.cones += batch.count, counts.cone_steps += done.steps, counts.voxel_fetches += done.fetches;
        for (int i = 0; i < batch.count; ++i) {
            voxels[receivers.pixel[i]] += vec4(batch.r[i], batch.g[i], batch.b[i], batch.open[i]) * cone.weight;
            if (!image) continue;
            const vec3 outside = work.environment.mean({batch.dx[i], batch.dy[i], batch.dz[i]});
            sky[receivers.pixel[i]] += vec4(outside * (batch.open[i] * cone.weight), 0);
        }
    }
    return counts;
}

}  // namespace

GatheredLight march(const DiffuseCones& technique, const Pyramid& pyramid, const GBuffer& gbuffer, const Scene& scene,
                    const Intersector&, const Share& share, std::uint32_t) {
    const ConeSet set = choose_set(technique);
    const ConeShape shape{set.half_angle, static_cast<float>(technique.first_diameter), static_cast<float>(technique.step),
                          static_cast<float>(technique.level_bias), static_cast<float>(technique.density)};
    const Work work{pyramid,
                    gbuffer,
                    set,
                    make_schedule(shape, pyramid),
                    ConeEnvironment(scene, set.half_angle),
                    block_of(share),
                    static_cast<float>(technique.normal_offset),
                    static_cast<float>(technique.cut_off),
                    technique.own_surface};
    std::vector<float> weights(work.block.phases(), 0.0f);
    for (std::size_t c = 0; c < set.cones.size(); ++c) weights[c % weights.size()] += set.cones[c].weight;

    const bool image = !work.environment.constant();
    Buffer<vec4> voxels(gbuffer.pixels()), sky(image ? gbuffer.pixels() : 0);
    // A multiple of both sides of the block, with at most `most_receivers` of them along each.
    const int common = std::lcm(work.block.width, work.block.height), least = std::min(work.block.width, work.block.height);
    const int tile_size = std::max(1, std::min(most_receivers * least, 64) / common) * common;
    const int columns = (gbuffer.width + tile_size - 1) / tile_size, rows = (gbuffer.height + tile_size - 1) / tile_size;
    std::vector<Counts> counts(static_cast<std::size_t>(columns) * rows);
    parallel_tiles(gbuffer.width, gbuffer.height, tile_size, [&](const Tile& tile) {
        thread_local Receivers receivers;
        thread_local ConeBatch batch;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                voxels[y * gbuffer.width + x] = vec4(0);
                if (image) sky[y * gbuffer.width + x] = vec4(0);
            }
        for (int phase = 0; phase < work.block.phases(); ++phase) {
            find_receivers(work, tile, phase, receivers);
            counts[tile.index] += march_phase(work, phase, receivers, batch, voxels, sky);
        }
    });

    voxels = merge(share, gbuffer, weights, std::move(voxels));
    if (image) sky = merge(share, gbuffer, weights, std::move(sky));
    return finish_gathering(gbuffer, voxels, pi * pyramid.scale, sky, work.environment.mean({0, 0, 1}), counts);
}

}  // namespace interreflect
