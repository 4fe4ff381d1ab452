#include "virtual_lights/shadow/point_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/paraboloid_map.h"

namespace interreflect {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
// A disk is never drawn wider than this half angle: nearer to the light its own direction says too little about its outline.
constexpr float widest = 0.6f;

}  // namespace

std::vector<vec3> paraboloid_directions(int size) {
    std::vector<vec3> directions(static_cast<std::size_t>(size) * size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            directions[static_cast<std::size_t>(y) * size + x] =
                paraboloid_direction((vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / static_cast<float>(size));
    return directions;
}

PointMap::PointMap(std::span<float> depth, std::span<const vec3> directions, int size, const vec3& position, const vec3& normal)
    : depth_(depth), directions_(directions), size_(size), origin_(position), frame_(normal) {
    std::ranges::fill(depth_, infinity);
}

PointMap::Place PointMap::place(const WorldPoint& point, float radius) const {
    Place at{};
    at.local = frame_.to_local(point.position - origin_);
    at.distance = glm::length(at.local);
    const float cosine = at.distance > 0 ? at.local.z / at.distance : 0.0f;
    at.above = cosine > 1e-4f;
    if (!at.above) return at;
    const vec2 square = paraboloid_square(at.local / at.distance) * static_cast<float>(size_);
    const int last = size_ - 1;
    at.x = std::clamp(static_cast<int>(square.x), 0, last), at.y = std::clamp(static_cast<int>(square.y), 0, last);
    // The disk's half angle in texels: the paraboloid takes an angle t off the axis to a radius of tan(t / 2).
    const float half = std::min(radius / at.distance, widest) * 0.5f * static_cast<float>(size_) / (1.0f + cosine);
    const auto texel = [last](float v) { return std::clamp(static_cast<int>(std::lround(v)), 0, last); };
    at.x0 = texel(square.x - half), at.x1 = texel(square.x + half - 1.0f);
    at.y0 = texel(square.y - half), at.y1 = texel(square.y + half - 1.0f);
    return at;
}

void PointMap::draw_square(const WorldPoint& point, float radius) {
    const Place at = place(point, radius);
    if (!at.above) return;
    for (int y = std::min(at.y0, at.y); y <= std::max(at.y1, at.y); ++y)
        for (int x = std::min(at.x0, at.x); x <= std::max(at.x1, at.x); ++x) {
            float& depth = depth_[static_cast<std::size_t>(y) * size_ + x];
            depth = std::min(depth, at.distance);
        }
}

void PointMap::draw_disk(const WorldPoint& point, float radius) {
    const Place at = place(point, radius);
    if (!at.above) return;
    const vec3 normal = frame_.to_local(point.normal);
    const float height = glm::dot(normal, at.local), radius2 = radius * radius;
    bool drawn = false;
    for (int y = at.y0; y <= at.y1; ++y)
        for (int x = at.x0; x <= at.x1; ++x) {
            const std::size_t texel = static_cast<std::size_t>(y) * size_ + x;
            const vec3& direction = directions_[texel];
            const float along = height / glm::dot(normal, direction);  // where the texel's ray meets the disk's plane
            const vec3 from_middle = direction * along - at.local;
            if (!(along > 0.0f) || !(glm::dot(from_middle, from_middle) <= radius2)) continue;
            depth_[texel] = std::min(depth_[texel], along);
            drawn = true;
        }
    if (drawn) return;
    float& centre = depth_[static_cast<std::size_t>(at.y) * size_ + at.x];
    centre = std::min(centre, at.distance);
}

namespace {

/// The mean of the texels of a square of 2 x 2 that hold anything; `right` and `below`: whether the finer level has these.
float mean_of(const float* from, int side, bool right, bool below) {
    const float texels[4] = {from[0], right ? from[1] : infinity, below ? from[side] : infinity,
                             right && below ? from[side + 1] : infinity};
    float sum = 0, known = 0;
    for (const float d : texels) {
        const bool holds = d < infinity;
        sum += holds ? d : 0.0f;
        known += holds ? 1.0f : 0.0f;
    }
    return known > 0 ? sum / known : infinity;
}

void pull(const float* from, int side, float* to, int half) {
    const int whole = side / 2;
    for (int y = 0; y < half; ++y, to += half) {
        const float* row = from + static_cast<std::size_t>(2 * y) * side;
        const bool below = 2 * y + 1 < side;
        for (int x = 0; x < whole; ++x) to[x] = mean_of(row + 2 * x, side, true, below);
        for (int x = whole; x < half; ++x) to[x] = mean_of(row + 2 * x, side, false, below);
    }
}

void push(const float* from, int half, float* to, int side) {
    for (int y = 0; y < side; ++y, to += side) {
        const float* row = from + static_cast<std::size_t>(y / 2) * half;
        for (int x = 0; x < side; ++x) to[x] = to[x] < infinity ? to[x] : row[x / 2];
    }
}

std::uint64_t open_texels(std::span<const float> depth, std::span<const vec3> directions) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) count += !(depth[i] < infinity) && !(directions[i].z < 0.0f) ? 1 : 0;
    return count;
}

}  // namespace

// Roofline: each level is read and written twice, from the first two caches; a third of a map's texels are those of its levels.
Filled pull_push(std::span<float> depth, int size, int levels, std::span<const vec3> directions) {
    thread_local std::vector<std::vector<float>> coarser;
    if (coarser.size() < static_cast<std::size_t>(levels)) coarser.resize(static_cast<std::size_t>(levels));
    const std::uint64_t empty = open_texels(depth, directions);
    std::vector<int> sides{size};
    for (int i = 0; i < levels && (i == 0 || sides.back() > 1); ++i) {
        const int side = sides.back(), half = (side + 1) / 2;
        coarser[i].resize(static_cast<std::size_t>(half) * half);
        pull(i == 0 ? depth.data() : coarser[i - 1].data(), side, coarser[i].data(), half);
        sides.push_back(half);
    }
    for (int i = static_cast<int>(sides.size()) - 1; i-- > 0;)
        push(coarser[i].data(), sides[i + 1], i == 0 ? depth.data() : coarser[i - 1].data(), sides[i]);
    return {empty, empty - open_texels(depth, directions)};
}

}  // namespace interreflect
