#pragma once
#include "data/technique.h"

namespace interreflect {

/// The scene's bounds with half a voxel of air around them.
struct SceneBounds {
    bool operator==(const SceneBounds&) const = default;
    static constexpr auto description =
        describe("SceneBounds", "The scene's bounds with half a voxel of air around them.", Source{"Rehfeld et al. 2014", "4"});
};

}  // namespace interreflect
