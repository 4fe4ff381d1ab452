/// The knobs that filters share.
#pragma once
#include <string>

#include "data/technique.h"

namespace interreflect {

/// Of every filter.
struct LevelKnobs {
    int levels = 0;
    int dense_limit = 128;

    bool operator==(const LevelKnobs&) const = default;
    static constexpr auto params = std::tuple{
        Param{"levels", &LevelKnobs::levels, "most levels, the finest one included; 0: down to one texel. Freed 2018 has 6",
              Unit::none, between(0, 11)},
        Param{
            "dense_limit", &LevelKnobs::dense_limit,
            "MiB that a level may need with all of its texels; where one would need more, it and all above an eighth of this are "
            "kept in bricks of 4 x 4 x 4, of which only those that are not all air exist: as large as the surface, and sooner "
            "made than a large dense level, but slower to march. Changes no result. Nested grids have none",
            Unit::none, between(0, 131072)}};
};

/// Of filters that keep surfaces opaque.
struct OpacityKnob {
    std::string opacity = "sum";

    bool operator==(const OpacityKnob&) const = default;
    static constexpr auto params = std::tuple{
        Param{"opacity", &OpacityKnob::opacity,
              "how opaque a texel is: `sum`, a quarter of the sum of the eight below it, clamped, as in the paper (slanted walls "
              "leak); `columns`, the share of its cross-section that is blocked along the axis that sees most, from half a texel "
              "before it to half a texel behind (slanted walls stay closed, small things look larger)",
              Unit::none, one_of("sum|columns")}};
};

/// Of filters whose texels look alike from all sides.
struct IsotropicKnobs : LevelKnobs {
    std::string kernel = "box";
    std::string format = "half";

    bool operator==(const IsotropicKnobs&) const = default;
    static constexpr auto params = std::tuple_cat(
        LevelKnobs::params,
        std::tuple{
            Param{"kernel", &IsotropicKnobs::kernel,
                  "the size of the filtering kernel [Freed 2018, 4.4]: `box` averages the 2 x 2 x 2 texels below one; `tent` "
                  "4 x 4 x 4 around its centre with weights 1 3 3 1 along each axis",
                  Unit::none, one_of("box|tent")},
            Param{"format", &IsotropicKnobs::format,
                  "what a channel can hold: `half` floats that fit every radiance; `rgba8`, as the paper's program: radiance is "
                  "clipped at 1 W/(m^2 sr) and rounded to a multiple of 1/255 at every level, as is opacity (kept as half "
                  "floats, which tell all 256 values apart, so it saves no memory)",
                  Unit::none, one_of("half|rgba8")}});
};

}  // namespace interreflect
