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

Filled pull_push(std::span<float> depth, int size, int levels, std::span<const vec3> directions) {
    struct Level {
        int size;
        std::vector<float> depth;
    };
    const auto mean_of = [](const float* from, int side, int x, int y) {
        float sum = 0;
        int known = 0;
        for (int j = 2 * y; j < std::min(2 * y + 2, side); ++j)
            for (int i = 2 * x; i < std::min(2 * x + 2, side); ++i)
                if (const float d = from[static_cast<std::size_t>(j) * side + i]; std::isfinite(d)) sum += d, ++known;
        return known > 0 ? sum / static_cast<float>(known) : infinity;
    };
    std::vector<Level> coarser;
    for (int i = 0; i < levels; ++i) {
        const float* from = i == 0 ? depth.data() : coarser.back().depth.data();
        const int side = i == 0 ? size : coarser.back().size, half = (side + 1) / 2;
        Level level{half, std::vector<float>(static_cast<std::size_t>(half) * half)};
        for (int y = 0; y < half; ++y)
            for (int x = 0; x < half; ++x) level.depth[static_cast<std::size_t>(y) * half + x] = mean_of(from, side, x, y);
        coarser.push_back(std::move(level));
        if (half == 1) break;
    }
    Filled counts{0, 0};
    for (std::size_t i = coarser.size(); i-- > 0;) {
        float* to = i == 0 ? depth.data() : coarser[i - 1].depth.data();
        const int side = i == 0 ? size : coarser[i - 1].size;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                float& d = to[static_cast<std::size_t>(y) * side + x];
                if (std::isfinite(d)) continue;
                d = coarser[i].depth[static_cast<std::size_t>(y / 2) * coarser[i].size + x / 2];
                if (i > 0 || directions[static_cast<std::size_t>(y) * side + x].z < 0.0f) continue;
                ++counts.empty;
                counts.filled += std::isfinite(d) ? 1 : 0;
            }
    }
    if (coarser.empty())
        for (std::size_t i = 0; i < depth.size(); ++i)
            counts.empty += directions[i].z >= 0.0f && !std::isfinite(depth[i]) ? 1 : 0;
    return counts;
}

}  // namespace interreflect
