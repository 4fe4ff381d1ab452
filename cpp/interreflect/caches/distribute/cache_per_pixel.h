#pragma once
#include "data/caches.h"
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/technique.h"

namespace interreflect {

/// Every pixel that sees a surface is a cluster of its own.
struct CachePerPixel {
    bool operator==(const CachePerPixel&) const = default;
    static constexpr auto description = describe("CachePerPixel", "A cache at every pixel.", Source{"Interreflect"});
};

CachePlaces distribute(const CachePerPixel& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces* last);

}  // namespace interreflect
