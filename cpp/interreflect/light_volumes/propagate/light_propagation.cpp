#include "light_volumes/propagate/light_propagation.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "light_volumes/propagate/face_blockers.h"
#include "light_volumes/propagate/planes.h"
#include "light_volumes/propagate/step_kernel.h"

namespace interreflect {
namespace {

void unpack(const LightVolume& volume, Planes& into) {
    into.each_row([&](int y, int z) {
        const float* from = volume.cell(volume.domain.cell({0, y, z}));
        for (int k = 0; k < Planes::count; ++k) {
            float* row = into.row(k, y, z);
            for (int x = 0; x < volume.domain.cells.x; ++x) row[x] = from[x * Planes::count + k];
        }
    });
}

void pack(const Planes& planes, LightVolume& into) {
    planes.each_row([&](int y, int z) {
        float* to = into.coefficients.data() + std::size_t{into.domain.cell({0, y, z})} * Planes::count;
        for (int k = 0; k < Planes::count; ++k) {
            const float* row = planes.row(k, y, z);
            for (int x = 0; x < into.domain.cells.x; ++x) to[x * Planes::count + k] = row[x];
        }
    });
}

/// Every cell's light becomes what its six neighbours send it.
void step(const Planes& before, Planes& after, Planes& sum, const FaceBlockers* blockers, int cells, bool clamps) {
    before.each_row([&](int y, int z) {
        StepRow row{};
        row.cells = cells, row.clamps = clamps;
        for (int plane = 0; plane < Planes::count; ++plane) {
            row.before[plane] = before.row(plane, y, z);
            row.after[plane] = after.row(plane, y, z), row.sum[plane] = sum.row(plane, y, z);
        }
        for (int axis = 0; axis < 3; ++axis) {
            row.step[axis] = before.step(axis);
            if (blockers == nullptr) continue;
            row.face_step[axis] = blockers->step(axis);
            for (int k = 0; k < LightVolume::harmonics; ++k) row.faces[axis][k] = blockers->before(axis, k, y, z);
        }
        step_row(row);
    });
}

bool same(const Domain& a, const Domain& b) { return a.cells == b.cells && a.lower == b.lower && a.voxel_size == b.voxel_size; }

}  // namespace

LightVolume propagate(const LightPropagation& technique, const LightVolume& injected, const GeometryVolume* blockers) {
    if (blockers != nullptr && !same(blockers->domain, injected.domain))
        throw std::invalid_argument("propagate: blockers of another grid");
    const ivec3 cells = injected.domain.cells;
    Planes now(cells), next(cells), sum(cells);
    unpack(injected, now);
    std::optional<FaceBlockers> faces;
    if (blockers != nullptr) faces.emplace(*blockers);
    for (int i = 0; i < technique.iterations; ++i) {
        // What blocks light is also where it starts from: the first step goes free.
        const FaceBlockers* in_the_way = i > 0 && faces ? &*faces : nullptr;
        step(now, next, sum, in_the_way, cells.x, technique.negative == "clamped");
        std::swap(now, next);
    }
    LightVolume volume{injected.domain, Buffer<float>(injected.coefficients.size()), {}};
    pack(sum, volume);
    volume.counts.voxels = injected.domain.cell_count() * static_cast<std::uint64_t>(technique.iterations);
    return volume;
}

}  // namespace interreflect
