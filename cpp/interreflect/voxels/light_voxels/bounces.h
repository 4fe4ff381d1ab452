#pragma once
#include <variant>

#include "data/technique.h"
#include "voxels/light_voxels/cone_lighting.h"
#include "voxels/light_voxels/lighting_task.h"
#include "voxels/light_voxels/shadow_map_injection.h"
#include "voxels/light_voxels/traced_lighting.h"
#include "voxels/march/march_knobs.h"

namespace interreflect {

/// The techniques that light voxels by themselves.
using LightOnce = std::variant<TracedLighting, ShadowMapInjection, ConeLighting>;

/// Light of all bounces, one more with every frame: besides what `light_voxels` finds, each voxel reflects what cones about its
/// normal gather from the last frame's pyramid. The first frame has none. Where surfaces reflect at most rho, what is missing
/// shrinks by rho every frame.
struct Bounces : MarchKnobs {
    LightOnce light_voxels;
    int cones = 9;

    Bounces() : MarchKnobs{.step = 0.75, .normal_offset = 0.75, .density = 0.9} {}
    bool operator==(const Bounces&) const = default;
    static constexpr auto description = describe(
        "Bounces", "Besides its own light, what cones gather from the last frame's pyramid: all bounces after some frames.",
        Source{"Rehfeld et al. 2014", "3.1: the hierarchy stores global illumination"},
        Param{"light_voxels", &Bounces::light_voxels, "how the lights' own light comes to the voxels"},
        Param{"cones", &Bounces::cones, "cones over the hemisphere of each side of a voxel", Unit::none, between(3, 256)},
        MarchKnobs::params);
};

LitVoxels light_voxels(const Bounces& technique, const LightingTask& task);

}  // namespace interreflect
