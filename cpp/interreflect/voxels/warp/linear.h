#pragma once
#include "data/technique.h"

namespace interreflect {

/// Voxels of one size everywhere.
struct Linear {
    bool operator==(const Linear&) const = default;
    static constexpr auto description = describe("Linear", "Voxels of one size everywhere.", Source{"Freed 2018", "4.6.1"});
};

}  // namespace interreflect
