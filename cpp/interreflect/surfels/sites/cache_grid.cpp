#include "surfels/sites/cache_grid.h"

#include <algorithm>
#include <vector>

#include "math/parallel.h"
#include "surfels/sites/backs.h"

namespace interreflect {
namespace {

/// Of every cell of a grid the nearest cache by steps between cells.
Buffer<std::uint32_t> flood(const GridSites& grid) {
    Buffer<std::uint32_t> nearest(grid.cache.size());
    std::copy(grid.cache.begin(), grid.cache.end(), nearest.begin());
    const int strides[3] = {1, grid.size.x, grid.size.x * grid.size.y};
    std::vector<std::size_t> front, next;
    for (std::size_t cell = 0; cell < nearest.size(); ++cell)
        if (nearest[cell] != no_cache) front.push_back(cell);
    while (!front.empty()) {
        next.clear();
        for (const std::size_t cell : front)
            for (int axis = 0; axis < 3; ++axis) {
                const int at = static_cast<int>(cell / static_cast<std::size_t>(strides[axis])) % grid.size[axis];
                for (const int step : {-1, 1}) {
                    if (at + step < 0 || at + step >= grid.size[axis]) continue;
                    const auto beside = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + step * strides[axis]);
                    if (nearest[beside] != no_cache) continue;
                    nearest[beside] = nearest[cell];
                    next.push_back(beside);
                }
            }
        front.swap(next);
    }
    return nearest;
}

}  // namespace
CacheSites place_caches(const CacheGrid& technique, const Scene& scene, const Intersector& intersector, const Bounds& about) {
    const ivec3 size(technique.nx, technique.ny, technique.nz);
    const std::size_t cells =
        static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
    CacheSites sites;
    Bounds box = about;
    if (!(box.lower.x <= box.upper.x)) box = {vec3(0), vec3(0)};
    sites.grid = {size, box, Buffer<std::uint32_t>(cells), {}};
    const auto middle = [&](std::size_t cell) {
        const auto x = cell % static_cast<std::size_t>(size.x), rest = cell / static_cast<std::size_t>(size.x);
        const vec3 at(static_cast<float>(x), static_cast<float>(rest % static_cast<std::size_t>(size.y)),
                      static_cast<float>(rest / static_cast<std::size_t>(size.y)));
        return box.lower + (box.upper - box.lower) * ((at + 0.5f) / vec3(size));
    };
    std::vector<std::uint8_t> open(cells);
    parallel_blocks(cells, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            open[cell] = technique.most_backs >= 1 ||
                         static_cast<double>(look_about(middle(cell), vec3(0), scene, intersector).share_of_backs()) <=
                             technique.most_backs;
    });
    std::uint32_t count = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) sites.grid.cache[cell] = open[cell] != 0 ? count++ : no_cache;
    sites.position = Buffer<vec3>(count), sites.normal = Buffer<vec3>(count, vec3(0)), sites.offset = Buffer<float>(count, 0.0f);
    for (std::size_t cell = 0; cell < cells; ++cell)
        if (open[cell] != 0) sites.position[sites.grid.cache[cell]] = middle(cell);
    sites.grid.nearest = flood(sites.grid);
    sites.counts.caches = count;
    return sites;
}

}  // namespace interreflect
