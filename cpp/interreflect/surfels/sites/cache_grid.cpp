#include "surfels/sites/cache_grid.h"

#include <algorithm>
#include <span>
#include <vector>

#include "math/parallel.h"
#include "surfels/sites/backs.h"

namespace interreflect {
namespace {

/// The nearest cache of every cell of a level, by steps between cells; `nearest` holds their own when it begins.
void flood(const ivec3& size, std::span<std::uint32_t> nearest) {
    const int strides[3] = {1, size.x, size.x * size.y};
    std::vector<std::size_t> front, next;
    for (std::size_t cell = 0; cell < nearest.size(); ++cell)
        if (nearest[cell] != no_cache) front.push_back(cell);
    while (!front.empty()) {
        next.clear();
        for (const std::size_t cell : front)
            for (int axis = 0; axis < 3; ++axis) {
                const int at = static_cast<int>(cell / static_cast<std::size_t>(strides[axis])) % size[axis];
                for (const int step : {-1, 1}) {
                    if (at + step < 0 || at + step >= size[axis]) continue;
                    const auto beside = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + step * strides[axis]);
                    if (nearest[beside] != no_cache) continue;
                    nearest[beside] = nearest[cell];
                    next.push_back(beside);
                }
            }
        front.swap(next);
    }
}

/// The middles of all levels' cells.
std::vector<vec3> middles(const GridSites& grid) {
    std::vector<vec3> made;
    for (int level = 0; level < grid.levels; ++level) {
        const ivec3 n = grid.size_of(level);
        const vec3 cell = (grid.box.upper - grid.box.lower) / vec3(n);
        for (int z = 0; z < n.z; ++z)
            for (int y = 0; y < n.y; ++y)
                for (int x = 0; x < n.x; ++x) made.push_back(grid.box.lower + cell * (vec3(x, y, z) + 0.5f));
    }
    return made;
}

}  // namespace

CacheSites place_caches(const CacheGrid& technique, const Scene& scene, const Intersector& intersector, const Bounds& about) {
    CacheSites sites;
    GridSites& grid = sites.grid;
    grid.size = ivec3(technique.nx, technique.ny, technique.nz), grid.box = about, grid.levels = technique.levels;
    if (!(about.lower.x <= about.upper.x)) grid.box = {vec3(0), vec3(0)};
    grid.reach = static_cast<float>(technique.reach) * max_component((grid.box.upper - grid.box.lower) / vec3(grid.size));
    grid.normal_offset = static_cast<float>(technique.normal_offset);
    const std::vector<vec3> middle = middles(grid);
    std::vector<std::uint8_t> open(middle.size());
    parallel_blocks(middle.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            open[cell] = technique.most_backs >= 1 ||
                         static_cast<double>(look_about(middle[cell], vec3(0), scene, intersector).share_of_backs()) <=
                             technique.most_backs;
    });
    grid.cache = Buffer<std::uint32_t>(middle.size()), grid.nearest = Buffer<std::uint32_t>(middle.size());
    std::uint32_t count = 0;
    for (std::size_t cell = 0; cell < middle.size(); ++cell) grid.cache[cell] = open[cell] != 0 ? count++ : no_cache;
    std::ranges::copy(grid.cache, grid.nearest.begin());
    for (int level = 0; level < grid.levels; ++level)
        flood(grid.size_of(level), grid.nearest.span().subspan(grid.first_of(level), grid.cells_of(level)));
    sites.position = Buffer<vec3>(count), sites.normal = Buffer<vec3>(count, vec3(0)), sites.offset = Buffer<float>(count, 0.0f);
    for (std::size_t cell = 0; cell < middle.size(); ++cell)
        if (open[cell] != 0) sites.position[grid.cache[cell]] = middle[cell];
    sites.counts.caches = count;
    return sites;
}

}  // namespace interreflect
