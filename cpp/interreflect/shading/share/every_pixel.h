#pragma once
#include "data/technique.h"

namespace interreflect {

/// Every pixel does all of its work itself.
struct EveryPixel {
    bool operator==(const EveryPixel&) const = default;
    static constexpr auto description =
        describe("EveryPixel", "Every pixel does all of its work itself.", Source{"Interreflect"});
};

}  // namespace interreflect
