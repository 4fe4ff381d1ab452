#pragma once
#include <optional>
#include <string>

#include "data/scene.h"
#include "data/technique.h"

namespace interreflect {

/// specular * scale * (n.h)^n without a Fresnel term; n is the material's exponent, or 2 / alpha^2 - 2. With the exact scale,
/// (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)), it reflects everything at normal view; the common (n + 8) / (8 pi) gains 7.5 % at n =
/// 10 and 4.8 % at 30.
struct BlinnPhong {
    std::string scale = "exact";

    bool operator==(const BlinnPhong&) const = default;
    static constexpr auto description = describe(
        "BlinnPhong", "Glossy surfaces by a power of the cosine between normal and half vector.",
        Source{"Blinn 1977", "Models of light reflection; in Freed 2018, 4.5"},
        Param{"scale", &BlinnPhong::scale,
              "factor on the power: `exact` reflects everything at normal view, `common` is (n + 8) / (8 pi), which gains",
              Unit::none, one_of("exact|common")});
};
inline std::optional<Lobe> lobe_of(const BlinnPhong& technique) {
    return technique.scale == "exact" ? Lobe::blinn_phong : Lobe::gaining_blinn_phong;
}

}  // namespace interreflect
