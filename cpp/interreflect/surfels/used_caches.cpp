#include "surfels/used_caches.h"

#include <atomic>

#include "math/parallel.h"
#include "surfels/evaluate/cache_finder.h"

namespace interreflect {

Buffer<std::uint8_t> used_caches(const CacheSites& sites, const GBuffer& gbuffer, const Scene& scene) {
    Buffer<std::uint8_t> used(sites.size(), std::uint8_t{0});
    const CacheFinder finder(sites, gbuffer, scene);
    parallel_blocks(gbuffer.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            const NearCaches near = finder.find(pixel);
            for (int k = 0; k < near.count; ++k) {
                // Neighbours read the same caches: most are marked already.
                std::atomic_ref<std::uint8_t> mark(used[near.cache[static_cast<std::size_t>(k)]]);
                if (mark.load(std::memory_order_relaxed) == 0) mark.store(1, std::memory_order_relaxed);
            }
        }
    });
    return used;
}

}  // namespace interreflect
