/// Which caches do pixels read?
#pragma once
#include <cstdint>

#include "data/buffer.h"
#include "data/gbuffer.h"
#include "data/light_caches.h"

namespace interreflect {

/// Of every cache 1 where some pixel interpolates from it, else 0 [Jendersie et al. 2016, 6: "it is not necessary to illuminate
/// and use all of them"].
Buffer<std::uint8_t> used_caches(const CacheSites& sites, const GBuffer& gbuffer);

}  // namespace interreflect
