#pragma once
#include "caches/interpolate/own_caches.h"
#include "data/technique.h"

namespace interreflect {

/// Every pixel has a cache of its own.
struct Evaluated {
    bool operator==(const Evaluated&) const = default;
    static constexpr auto description =
        describe("Evaluated", "Every pixel has a cache of its own, whatever the distribution.", Source{"Interreflect"});
};

CacheLight interpolate(const Evaluated& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own);

}  // namespace interreflect
