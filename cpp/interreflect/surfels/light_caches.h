/// Light caches: how much radiance comes to every cache, from where?
#pragma once
#include <cstdint>
#include <span>

#include "data/light_caches.h"
#include "data/surfels.h"

namespace interreflect {

/// How caches hold what comes to them. Chrominance in fewer bands than luma: Co and Cg of YCoCg [Malvar and Sullivan 2003], which
/// vary less [Jendersie et al. 2016, 4.8]; as many (0): red, green and blue.
struct CacheFormat {
    int bands = 4, chrominance_bands = 0;
};

/// The sum over each cache's links, times what the nodes send on [Jendersie et al. 2016, equation 3]. Projected links have the
/// format's bands or more; cones any. std::invalid_argument where links and light do not belong together, or where links have too
/// few bands. used: of every cache, whether anything reads it; one that nothing reads stays black; empty: all are read.
LightCaches light_caches(const CacheLinks& links, const NodeLight& light, const CacheFormat& format,
                         std::span<const std::uint8_t> used = {});

/// std::invalid_argument where the links are of another tree, or of flux where the light is radiosity.
void check_links(const CacheLinks& links, const NodeLight& light);

/// Empty caches of a format; checks it.
LightCaches make_light_caches(std::size_t caches, const CacheFormat& format);

}  // namespace interreflect
