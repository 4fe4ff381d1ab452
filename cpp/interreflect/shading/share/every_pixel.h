#pragma once
#include <span>
#include <utility>

#include "data/gbuffer.h"
#include "data/technique.h"

namespace interreflect {

/// Every pixel does all of its work itself.
struct EveryPixel {
    bool operator==(const EveryPixel&) const = default;
    static constexpr auto description =
        describe("EveryPixel", "Every pixel does all of its work itself.", Source{"Interreflect"});
};

inline Buffer<vec4> merge(const EveryPixel&, const GBuffer&, std::span<const float>, Buffer<vec4> partial) { return partial; }

}  // namespace interreflect
