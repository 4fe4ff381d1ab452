#pragma once
#include <string>

#include "data/light_volume.h"
#include "data/technique.h"

namespace interreflect {

/// From cell to neighbouring cell, again and again [Kaplanyan and Dachsbacher 2010, 3.3].
struct LightPropagation {
    int iterations = 32;
    std::string negative = "clamped";

    bool operator==(const LightPropagation&) const = default;
    static constexpr auto description = describe(
        "LightPropagation", "Light goes from cell to neighbouring cell, again and again, in two bands of spherical harmonics.",
        Source{"Kaplanyan and Dachsbacher 2010", "3.3"},
        Param{"iterations", &LightPropagation::iterations, "how many cells far light goes", Unit::voxels, between(0, 4096)},
        Param{"negative", &LightPropagation::negative,
              "what becomes of flux below 0, which two bands of harmonics have behind a lobe: clamped to 0, which adds energy, "
              "or kept, "
              "which conserves it",
              Unit::none, one_of("clamped|kept")});
};

/// blockers: null: nothing blocks. Throws std::invalid_argument where they belong to another grid.
LightVolume propagate(const LightPropagation& technique, const LightVolume& injected, const GeometryVolume* blockers);

}  // namespace interreflect
