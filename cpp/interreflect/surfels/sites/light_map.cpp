#include "surfels/sites/light_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"
#include "surfels/sites/backs.h"
#include "visibility/surface.h"

namespace interreflect {
namespace {

/// A texel's place on the surface.
struct Texel {
    vec3 position, normal;
    float offset;
};

void check(const LightMap& technique, const Scene& scene, std::span<const vec2> texcoord) {
    const std::size_t corners = 3 * scene.geometry->arrays->triangles.size();
    if (texcoord.size() != corners)
        throw std::invalid_argument("light map: texcoord must have " + std::to_string(corners) +
                                    " entries, three a triangle, got " + std::to_string(texcoord.size()));
    const auto side = static_cast<float>(technique.texels);
    for (std::size_t i = 0; i < corners; ++i) {
        const float least = texcoord[i - i % 3].x < 0.0f ? -std::numeric_limits<float>::max() : 0.0f;
        const vec2& at = texcoord[i];
        if (!(std::min(at.x, at.y) >= least) || !(at.x <= side) || !(at.y <= side))
            throw std::invalid_argument("light map: texture coordinates of triangle " + std::to_string(i / 3) +
                                        " are not finite or lie beyond the map's " + std::to_string(technique.texels) +
                                        " texels");
    }
}

/// Barycentric weights of a place at least an eighth of a texel inside of a triangle: on its very edge half of the hemisphere may
/// lie behind the next wall. `area`: twice the triangle's, square texels.
vec3 inset(const vec3& weights, const vec2* at, float area) {
    constexpr float distance = 0.125f;
    vec3 moved;
    for (int k = 0; k < 3; ++k) {
        const float height = area / glm::length(at[(k + 2) % 3] - at[(k + 1) % 3]);
        moved[k] = std::max(weights[k], std::min(distance / height, 1.0f / 3.0f));
    }
    return moved / (moved.x + moved.y + moved.z);
}

bool has_area(const Corners& c) { return glm::cross(c.b - c.a, c.c - c.a) != vec3(0); }

float cross(const vec2& a, const vec2& b) { return a.x * b.y - a.y * b.x; }

/// Texel coordinates `at` the corners, continued over the triangle's plane.
ChartPlane plane_of(const Corners& c, const vec2* at) {
    const vec3 e1 = c.b - c.a, e2 = c.c - c.a, normal = glm::cross(e1, e2);
    const float scale = 1.0f / glm::dot(normal, normal);
    const vec3 first = glm::cross(e2, normal) * scale, second = glm::cross(normal, e1) * scale;  // gradients of the weights
    const vec2 t1 = at[1] - at[0], t2 = at[2] - at[0];
    const vec3 u = first * t1.x + second * t2.x, v = first * t1.y + second * t2.y;
    ChartPlane plane;
    for (int axis = 0; axis < 3; ++axis) plane.column[axis] = {u[axis], v[axis], normal[axis], 0.0f};
    plane.column[3] = {at[0].x - glm::dot(u, c.a), at[0].y - glm::dot(v, c.a), 0.0f, 0.0f};
    return plane;
}

class Map {
  public:
    Map(int size, const Scene& scene)
        : size_(size), scene_(scene), number_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), no_cache) {}

    /// Texels whose centres lie in a triangle; the first triangle keeps a texel that two share.
    void draw(std::uint32_t triangle, const vec2* at) {
        const vec2 e1 = at[1] - at[0], e2 = at[2] - at[0];
        const float area = cross(e1, e2);
        if (area == 0.0f) return;
        const vec2 low = glm::min(glm::min(at[0], at[1]), at[2]), high = glm::max(glm::max(at[0], at[1]), at[2]);
        const Corners c = world_corners(*scene_.geometry, 0, triangle);
        for (int y = first(low.y); y < last(high.y); ++y)
            for (int x = first(low.x); x < last(high.x); ++x) {
                const vec2 to = vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - at[0];
                const float u = cross(to, e2) / area, v = cross(e1, to) / area;
                std::uint32_t& number = number_[index(x, y)];
                if (u < 0.0f || v < 0.0f || u + v > 1.0f || number != no_cache) continue;
                number = static_cast<std::uint32_t>(texels_.size());
                const vec3 b = inset({1.0f - u - v, u, v}, at, std::fabs(area));
                texels_.push_back({c.a * b.x + c.b * b.y + c.c * b.z, glm::normalize(glm::cross(c.b - c.a, c.c - c.a)),
                                   self_hit_offset(c.a, c.b, c.c)});
            }
    }
    /// Leaves out texels that lie behind other geometry.
    void drop(double most_backs, const Intersector& intersector) {
        if (most_backs >= 1) return;
        std::vector<std::uint8_t> hidden(texels_.size());
        parallel_blocks(texels_.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Texel& t = texels_[i];
                hidden[i] = static_cast<double>(
                                look_about(t.position + t.normal * t.offset, t.normal, scene_, intersector).share_of_backs()) >
                            most_backs;
            }
        });
        std::vector<Texel> kept;
        std::vector<std::uint32_t> renumbered(texels_.size(), no_cache);
        for (std::size_t i = 0; i < texels_.size(); ++i)
            if (hidden[i] == 0) {
                renumbered[i] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(texels_[i]);
            }
        for (std::uint32_t& number : number_)
            if (number != no_cache) number = renumbered[number];
        texels_.swap(kept);
    }
    /// Empty texels take the cache of a neighbour; those beside before those across.
    void dilate() {
        const auto before = number_;
        constexpr int steps[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
        for (int y = 0; y < size_; ++y)
            for (int x = 0; x < size_; ++x) {
                if (before[index(x, y)] != no_cache) continue;
                for (const auto& step : steps) {
                    const int nx = x + step[0], ny = y + step[1];
                    if (nx < 0 || ny < 0 || nx >= size_ || ny >= size_ || before[index(nx, ny)] == no_cache) continue;
                    number_[index(x, y)] = before[index(nx, ny)];
                    break;
                }
            }
    }
    const std::vector<Texel>& texels() const { return texels_; }
    const std::vector<std::uint32_t>& numbers() const { return number_; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
    }
    int first(float low) const { return std::clamp(static_cast<int>(std::floor(low - 0.5f)), 0, size_); }
    int last(float high) const { return std::clamp(static_cast<int>(std::ceil(high + 0.5f)), 0, size_); }

    int size_;
    const Scene& scene_;
    std::vector<std::uint32_t> number_;  // of every texel
    std::vector<Texel> texels_;
};

}  // namespace

void lay_planes(LightMapSites& map, const Scene& scene) {
    map.planes = Buffer<ChartPlane>(map.triangle.size());
    if (map.size > 0) map.plane_of = Buffer<std::uint32_t>(scene.geometry->arrays->triangles.size(), no_chart);
    for (std::uint32_t k = 0; k < map.triangle.size(); ++k) {
        map.planes[k] = plane_of(world_corners(*scene.geometry, 0, map.triangle[k]), &map.texcoord[3 * std::size_t{k}]);
        map.plane_of[map.triangle[k]] = k;
    }
}

CacheSites place_caches(const LightMap& technique, const Scene& scene, const Intersector& intersector, const Bounds& box,
                        std::span<const vec2> texcoord) {
    check(technique, scene, texcoord);
    Map map(technique.texels, scene);
    const Group& still = scene.geometry->groups.front();
    std::vector<std::uint32_t> charted;
    for (std::uint32_t t = still.first_triangle; t < still.first_triangle + still.triangle_count; ++t) {
        if (texcoord[3 * std::size_t{t}].x < 0.0f || !has_area(world_corners(*scene.geometry, 0, t))) continue;
        charted.push_back(t);
        map.draw(t, &texcoord[3 * std::size_t{t}]);
    }
    map.drop(technique.most_backs, intersector);
    map.dilate();

    CacheSites grid = place_caches(technique.grid, scene, intersector, box);
    const std::size_t texels = map.texels().size(), n = texels + grid.size();
    CacheSites sites{Buffer<vec3>(n), Buffer<vec3>(n), Buffer<float>(n), {}, std::move(grid.grid), false, {}};
    for (std::size_t i = 0; i < texels; ++i) {
        const Texel& t = map.texels()[i];
        sites.position[i] = t.position, sites.normal[i] = t.normal, sites.offset[i] = t.offset;
    }
    for (std::size_t i = 0; i < grid.size(); ++i)
        sites.position[texels + i] = grid.position[i], sites.normal[texels + i] = vec3(0), sites.offset[texels + i] = 0.0f;
    for (auto* cells : {&sites.grid.cache, &sites.grid.nearest})
        for (std::uint32_t& cache : *cells)
            if (cache != no_cache) cache += static_cast<std::uint32_t>(texels);
    sites.map.size = technique.texels;
    sites.map.cache = Buffer<std::uint32_t>(map.numbers().size());
    std::ranges::copy(map.numbers(), sites.map.cache.begin());
    sites.map.triangle = Buffer<std::uint32_t>(charted.size());
    std::ranges::copy(charted, sites.map.triangle.begin());
    sites.map.texcoord = Buffer<vec2>(3 * charted.size());
    for (std::size_t k = 0; k < charted.size(); ++k)
        std::copy_n(&texcoord[3 * std::size_t{charted[k]}], 3, &sites.map.texcoord[3 * k]);
    lay_planes(sites.map, scene);
    sites.counts.caches = n;
    return sites;
}

}  // namespace interreflect
