#include "caches/distribute/cache_per_pixel.h"

#include <vector>

#include "caches/distribute/place.h"

namespace interreflect {

CachePlaces distribute(const CachePerPixel&, const GBuffer& gbuffer, const Scene&, const CachePlaces*) {
    CachePlaces places = tiles_of(gbuffer, 1);
    places.cluster = Buffer<std::uint32_t>(gbuffer.pixels());
    places.first.resize(gbuffer.pixels() + 1);
    std::vector<std::uint32_t> pixels;
    for (std::size_t i = 0; i < gbuffer.pixels(); ++i) {
        places.first[i] = static_cast<std::uint32_t>(pixels.size());
        places.cluster[i] = gbuffer.hit(i) ? places.first[i] : no_cache;
        if (gbuffer.hit(i)) pixels.push_back(static_cast<std::uint32_t>(i));
    }
    places.first.back() = static_cast<std::uint32_t>(pixels.size());
    place_caches(gbuffer, pixels, std::vector<std::uint32_t>(pixels.size(), 1), places);
    places.counts.clusters = pixels.size();
    return places;
}

}  // namespace interreflect
