#pragma once
#include "data/gbuffer.h"
#include "data/light_caches.h"
#include "data/technique.h"

namespace interreflect {

/// A cache for every pixel, at its surface: nothing is interpolated, and nothing precomputed.
struct PixelCaches {
    bool operator==(const PixelCaches&) const = default;
    static constexpr auto description =
        describe("PixelCaches", "A cache for every pixel that sees a surface, linked anew in every frame.",
                 Source{"Jendersie et al. 2016", "3.1, without caches between"});
};

CacheSites pixel_sites(const GBuffer& gbuffer);

}  // namespace interreflect
