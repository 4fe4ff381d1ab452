#include "voxels/light_voxels/traced_lighting.h"

#include "voxels/light_voxels/traced_block.h"

namespace interreflect {

LitVoxels light_voxels(const TracedLighting& technique, const LightingTask& task) {
    return light_blocks(task, technique.both_sides, technique.samples, [&](TracedBlock& block) {
        for (int i = 0; i < task.lights.delta_count(); ++i) block.delta(i);
    });
}

}  // namespace interreflect
