#pragma once
#include <optional>

#include "data/scene.h"
#include "data/technique.h"

namespace interreflect {

/// Every surface has its material's lobe: the default one is GGX with height-correlated Smith shadowing and Schlick's Fresnel
/// term.
struct Exact {
    bool operator==(const Exact&) const = default;
    static constexpr auto description = describe("Exact", "Every surface reflects as its material says.",
                                                 Source{"Heitz 2014", "equation 99, for the lobe named ggx"});
};
inline std::optional<Lobe> lobe_of(const Exact&) { return std::nullopt; }

}  // namespace interreflect
