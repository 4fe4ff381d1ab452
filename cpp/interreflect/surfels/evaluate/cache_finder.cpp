#include "surfels/evaluate/cache_finder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace interreflect {
namespace {

/// Scales the weights so that they sum up to 1.
void normalise(NearCaches& near) {
    float sum = 0;
    for (int k = 0; k < near.count; ++k) sum += near.weight[static_cast<std::size_t>(k)];
    for (int k = 0; k < near.count; ++k) near.weight[static_cast<std::size_t>(k)] /= sum;
}

}  // namespace

CacheFinder::CacheFinder(const CacheSites& sites, const GBuffer& gbuffer, const Scene& scene)
    : sites_(sites), gbuffer_(gbuffer), scene_(scene) {
    if (sites.pixels) {
        of_pixel_ = Buffer<std::uint32_t>(gbuffer.pixels(), no_cache);
        std::uint32_t next = 0;
        for (std::size_t pixel = 0; pixel < gbuffer.pixels(); ++pixel)
            if (gbuffer.hit(pixel)) of_pixel_[pixel] = next++;
        if (next != sites.size()) throw std::invalid_argument("evaluate: these caches are of another picture's pixels");
    }
}

NearCaches CacheFinder::find(std::size_t pixel) const {
    NearCaches near;
    if (!gbuffer_.hit(pixel)) return near;
    if (sites_.pixels)
        near.add(of_pixel_[pixel], 1.0f);
    else if (!in_map(pixel, near))
        in_grid(pixel, near);
    return near;
}

bool CacheFinder::in_map(std::size_t pixel, NearCaches& near) const {
    const LightMapSites& map = sites_.map;
    const std::uint32_t triangle = gbuffer_.triangle[pixel];
    if (map.size == 0 || gbuffer_.instance[pixel] != 0) return false;
    const vec2* at = map.texcoord.data() + 3 * static_cast<std::size_t>(triangle);
    if (at->x < 0.0f) return false;
    const Corners c = world_corners(*scene_.geometry, 0, triangle);
    const vec3 e1 = c.b - c.a, e2 = c.c - c.a, normal = glm::cross(e1, e2), to = gbuffer_.position[pixel] - c.a;
    // The map's caches see what the front sees.
    if (glm::dot(normal, gbuffer_.geometric_normal[pixel]) < 0.0f) return false;
    const float scale = 1.0f / glm::dot(normal, normal);
    const float u = glm::dot(glm::cross(to, e2), normal) * scale, v = glm::dot(glm::cross(e1, to), normal) * scale;
    const vec2 texel = at[0] * (1.0f - u - v) + at[1] * u + at[2] * v - 0.5f;
    const vec2 low = glm::floor(texel), share = texel - low;
    for (int k = 0; k < 4; ++k) {
        const int x = static_cast<int>(low.x) + (k & 1), y = static_cast<int>(low.y) + (k >> 1);
        if (x < 0 || y < 0 || x >= map.size || y >= map.size) continue;
        const std::uint32_t cache =
            map.cache[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.size) + static_cast<std::size_t>(x)];
        const float weight = ((k & 1) != 0 ? share.x : 1.0f - share.x) * ((k >> 1) != 0 ? share.y : 1.0f - share.y);
        if (cache != no_cache && weight > 0.0f) near.add(cache, weight);
    }
    normalise(near);
    return near.count > 0;
}

void CacheFinder::in_grid(std::size_t pixel, NearCaches& near) const {
    const GridSites& grid = sites_.grid;
    if (grid.size.x == 0) return;
    const vec3 size = grid.box.upper - grid.box.lower;
    const vec3 at = (gbuffer_.position[pixel] - grid.box.lower) / glm::max(size, vec3(1e-30f)) * vec3(grid.size) - 0.5f;
    const vec3 inside = glm::clamp(at, vec3(0.0f), vec3(grid.size - 1));
    const vec3 low = glm::min(glm::floor(inside), vec3(glm::max(grid.size - 2, ivec3(0)))), share = inside - low;
    std::size_t nearest = 0;
    float most = -1.0f;
    for (int k = 0; k < 8; ++k) {
        float weight = 1.0f;
        std::size_t cell = 0, stride = 1;
        bool exists = true;
        for (int axis = 0; axis < 3; ++axis) {
            const int step = (k >> axis) & 1;
            const int number = static_cast<int>(low[axis]) + step;
            exists = exists && number < grid.size[axis];
            weight *= step != 0 ? share[axis] : 1.0f - share[axis];
            cell += static_cast<std::size_t>(number) * stride;
            stride *= static_cast<std::size_t>(grid.size[axis]);
        }
        if (!exists) continue;
        if (weight > most) most = weight, nearest = cell;
        if (weight > 0.0f && grid.cache[cell] != no_cache) near.add(grid.cache[cell], weight);
    }
    if (near.count == 0 && grid.nearest[nearest] != no_cache) near.add(grid.nearest[nearest], 1.0f);
    normalise(near);
}

}  // namespace interreflect
