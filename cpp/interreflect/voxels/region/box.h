#pragma once
#include "data/technique.h"

namespace interreflect {

/// A given box, world space.
struct Box {
    double lower_x = -1, lower_y = -1, lower_z = -1, upper_x = 1, upper_y = 1, upper_z = 1;

    bool operator==(const Box&) const = default;
    static constexpr auto description =
        describe("Box", "A given box in world space; what lies outside of it is not voxelized.", Source{"Freed 2018", "4.1"},
                 Param{"lower_x", &Box::lower_x, "lower corner, world space"}, Param{"lower_y", &Box::lower_y, "lower corner"},
                 Param{"lower_z", &Box::lower_z, "lower corner"}, Param{"upper_x", &Box::upper_x, "upper corner, world space"},
                 Param{"upper_y", &Box::upper_y, "upper corner"}, Param{"upper_z", &Box::upper_z, "upper corner"});
};

}  // namespace interreflect
