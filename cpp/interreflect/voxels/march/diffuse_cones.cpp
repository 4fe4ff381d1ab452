#include "voxels/march/diffuse_cones.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "math/parallel.h"
#include "voxels/march/cone_caster.h"
#include "voxels/march/cone_environment.h"
#include "voxels/march/cone_set.h"
#include "voxels/march/gather.h"
#include "voxels/march/receivers.h"

namespace interreflect {
namespace {

constexpr int most_receivers = 16;  // of one phase, on a side of a tile: neighbours that read the same texels
static_assert(most_receivers * most_receivers <= ConeBatch::capacity);

ConeSet choose_set(const DiffuseCones& technique) {
    const auto half_angle = static_cast<float>(technique.half_angle) * degrees_to_radians;
    if (technique.set == "cosine") return cosine_cones(technique.cones, half_angle);
    ConeSet set = technique.set == "freed_thesis" ? freed_thesis_cones() : six_60_cones();
    if (half_angle > 0.0f) set.half_angle = half_angle;
    return set;
}

/// Everything that all tiles share.
struct Work {
    const Hierarchies& hierarchies;
    const ConeCaster& caster;  // through several of them
    const Pyramid& pyramid;    // the first
    const GBuffer& gbuffer;
    ConeSet set;
    ConeSchedule schedule;
    ConeEnvironment environment;
    Block block;
    float normal_offset, cut_off;
    bool own_surface, multiply_by_occlusion;
};

void find_receivers(const Work& work, const Tile& tile, int phase, Receivers& found, ConeBatch& batch) {
    found.count = 0;
    // Tiles begin on a block's border.
    for (int y = tile.y0 + phase / work.block.width; y < tile.y1; y += work.block.height)
        for (int x = tile.x0 + phase % work.block.width; x < tile.x1; x += work.block.width) {
            const int pixel = y * work.gbuffer.width + x;
            const GBuffer& g = work.gbuffer;
            if (g.hit(pixel)) found.add(pixel, g.position[pixel], g.geometric_normal[pixel], g.normal[pixel]);
        }
    start_receivers(work.pyramid.domain, work.normal_offset, work.own_surface, found, batch);
}

void turn_cones(const Receivers& from, const vec3& cone, ConeBatch& batch) {
    float* const rows[3] = {batch.dx, batch.dy, batch.dz};
    for (int row = 0; row < 3; ++row)
        for (int i = 0; i < from.count; ++i)
            rows[row][i] =
                from.per_axis[row][0][i] * cone.x + from.per_axis[row][1][i] * cone.y + from.per_axis[row][2][i] * cone.z;
}

/// Cones in the directions of `batch`, through several hierarchies.
Counts cast(const Work& work, const Receivers& from, ConeBatch& batch) {
    thread_local std::vector<ConeCaster::Cone> cones;
    cones.resize(static_cast<std::size_t>(from.count));
    for (int i = 0; i < from.count; ++i) {
        ConeCaster::Cone& cone = cones[static_cast<std::size_t>(i)];
        for (int k = 0; k < 3; ++k) cone.position[k] = from.position[k][i], cone.normal[k] = from.facing[k][i];
        cone.direction = {batch.dx[i], batch.dy[i], batch.dz[i]};
        cone.body = work.gbuffer.body[static_cast<std::size_t>(from.pixel[i])];
    }
    return work.caster.cast(cones, batch);
}

Counts march_cones(const Work& work, const Receivers& from, ConeBatch& batch) {
    if (!work.hierarchies.alone()) return cast(work, from, batch);
    const ConeCounts done = march_cones(work.pyramid, work.hierarchies.air(0), work.schedule, work.cut_off, batch);
    Counts counts;
    counts.cones = static_cast<std::uint64_t>(batch.count), counts.cone_steps = done.steps, counts.voxel_fetches = done.fetches;
    return counts;
}

void add_results(const Work& work, const ConeBatch& batch, float weight, Receivers& to) {
    const float* const rows[4] = {batch.r, batch.g, batch.b, batch.open};
    for (int row = 0; row < 4; ++row)
        for (int i = 0; i < batch.count; ++i) to.sum[row][i] += weight * rows[row][i];
    if (work.environment.constant()) return;
    for (int i = 0; i < batch.count; ++i) {
        const vec3 outside = work.environment.mean({batch.dx[i], batch.dy[i], batch.dz[i]}) * (batch.open[i] * weight);
        for (int k = 0; k < 3; ++k) to.sum[4 + k][i] += outside[k];
    }
}

/// Marches one phase's cones for its pixels of a tile into `voxels` (radiance and openness) and, where it varies, `sky`.
Counts march_phase(const Work& work, int phase, Receivers& receivers, ConeBatch& batch, Buffer<vec4>& voxels, Buffer<vec4>& sky) {
    Counts counts;
    for (std::size_t c = phase; c < work.set.cones.size(); c += work.block.phases()) {
        turn_cones(receivers, work.set.cones[c].direction, batch);
        counts += march_cones(work, receivers, batch);
        if (work.multiply_by_occlusion) multiply_by_openness(batch);
        add_results(work, batch, work.set.cones[c].weight, receivers);
    }
    const auto& sum = receivers.sum;
    for (int i = 0; i < receivers.count; ++i) {
        voxels[receivers.pixel[i]] = {sum[0][i], sum[1][i], sum[2][i], sum[3][i]};
        if (!sky.empty()) sky[receivers.pixel[i]] = {sum[4][i], sum[5][i], sum[6][i], 0.0f};
    }
    return counts;
}

}  // namespace

GatheredLight march(const DiffuseCones& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene,
                    const Intersector&, const Share& share, std::uint32_t) {
    const ConeSet set = choose_set(technique);
    const auto hierarchies = std::make_shared<const Hierarchies>(pyramids);
    const ConeCaster caster(hierarchies, technique, set.half_angle);
    const Pyramid& pyramid = hierarchies->pyramid(0);
    const Work work{*hierarchies,
                    caster,
                    pyramid,
                    gbuffer,
                    set,
                    make_schedule(technique.shape(set.half_angle), pyramid),
                    ConeEnvironment(scene, set.half_angle),
                    block_of(share),
                    static_cast<float>(technique.normal_offset),
                    static_cast<float>(technique.cut_off),
                    technique.own_surface,
                    technique.multiply_by_occlusion};
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
        for (int phase = 0; phase < work.block.phases(); ++phase) {
            find_receivers(work, tile, phase, receivers, batch);
            counts[tile.index] += march_phase(work, phase, receivers, batch, voxels, sky);
        }
    });

    return merge_gathered(share, gbuffer, weights, voxels, pi * pyramid.scale, sky, work.environment.mean({0, 0, 1}), counts);
}

}  // namespace interreflect
