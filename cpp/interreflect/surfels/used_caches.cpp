#include "surfels/used_caches.h"

#include <algorithm>
#include <atomic>

#include "math/parallel.h"
#include "surfels/evaluate/cache_finder.h"

namespace interreflect {

Buffer<std::uint8_t> used_caches(const CacheSites& sites, const GBuffer& gbuffer) {
    Buffer<std::uint8_t> used(sites.size(), std::uint8_t{0});
    const CacheFinder finder(sites, gbuffer);
    parallel_blocks(gbuffer.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
        NearCaches near;
        for (std::size_t first = begin; first < end; first += NearCaches::length) {
            const int count = static_cast<int>(std::min<std::size_t>(NearCaches::length, end - first));
            finder.find(first, count, near);
            for (int slot = 0; slot < near.slots; ++slot)
                for (int k = 0; k < count; ++k) {
                    if (!(near.weight[slot][k] > 0.0f)) continue;
                    // Neighbours read the same caches: most are marked already.
                    std::atomic_ref<std::uint8_t> mark(used[near.cache[slot][k]]);
                    if (mark.load(std::memory_order_relaxed) == 0) mark.store(1, std::memory_order_relaxed);
                }
        }
    });
    return used;
}

}  // namespace interreflect
