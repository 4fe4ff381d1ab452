#pragma once
#include <optional>

#include "data/scene.h"
#include "data/technique.h"

namespace interreflect {

/// D F G / (4 cos cos) with the GGX D of alpha = roughness^2, Schlick's Fresnel term and Schlick-GGX shadowing of
/// k = (roughness + 1)^2 / 8: c / (c (1 - k) + k) for either direction, which neither is Smith's of that D nor tends to 1 for
/// smooth surfaces. The paper's pi instead of 4, and its one alpha for k and D, are corrected (ERRATA).
struct FreedCookTorrance {
    bool operator==(const FreedCookTorrance&) const = default;
    static constexpr auto description = describe(
        "FreedCookTorrance", "Glossy surfaces as the thesis has them: GGX with Schlick's shadowing, Schlick's Fresnel term.",
        Source{"Freed 2018", "4.5.1, corrected"});
};
inline std::optional<Lobe> lobe_of(const FreedCookTorrance&) { return Lobe::freed_cook_torrance; }

}  // namespace interreflect
