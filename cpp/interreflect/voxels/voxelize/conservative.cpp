#include "voxels/voxelize/conservative.h"

#include <algorithm>

#include "voxels/voxelize/appearance.h"
#include "voxels/voxelize/polygon.h"
#include "voxels/voxelize/projected.h"

namespace interreflect {
namespace {

// Half of what ExactOverlap takes for a touch by rounding: what it keeps is kept here.
constexpr float least_part = 0.5e-4f;

/// Area in (u, v), and the centroid.
struct Flat {
    float area = 0;
    vec3 centroid{0};

    Flat() = default;
    explicit Flat(const Polygon& polygon) {
        vec3 sum{0};
        float twice = 0;
        for (int i = 1; i + 1 < polygon.count; ++i) {
            const vec3 a = polygon.corner[i] - polygon.corner[0], b = polygon.corner[i + 1] - polygon.corner[0];
            const float part = a.x * b.y - a.y * b.x;
            sum += (a + b) * part;
            twice += part;
        }
        area = 0.5f * std::fabs(twice);
        if (area > 0.0f) centroid = polygon.corner[0] + sum / (3.0f * twice);
    }
};

/// The value within [whole, whole + 1): a mean may be rounded out of its own cell.
float within(float value, float whole) { return std::clamp(value, whole, std::nextafter(whole + 1.0f, whole)); }

class Conservative {
  public:
    Conservative(const VoxelTriangle& t, const Projected& p, std::span<const vec2> samples, ContributionSink& sink)
        : triangle_(t),
          projected_(p),
          look_(t, std::min(t.area, p.slope_area)),
          texcoord_(t, p),
          samples_(samples),
          least_(least_part * std::min(t.area, 1.0f)),
          sink_(sink) {
        // Depths that only rounding reaches take part in no cell.
        const float margin = 0.5f * least_part * std::min(p.upper.z - p.lower.z, 1.0f);
        nearest_ = p.lower.z + margin, farthest_ = std::max(p.upper.z - margin, nearest_);
    }

    /// The part of the triangle in a pixel, at least three corners.
    void pixel(int u, int v, const Polygon& part) {
        const Flat flat(part);
        const float area = flat.area * projected_.slope_area;
        if (!(area > least_)) return;
        const auto left = static_cast<float>(u), low = static_cast<float>(v);
        const float middle = projected_.depth(left + 0.5f, low + 0.5f);
        const float reach = 0.5f * (std::fabs(projected_.depth_slope.x) + std::fabs(projected_.depth_slope.y));
        const float first = std::floor(std::max(middle - reach, nearest_));
        const float last = std::max(std::ceil(std::min(middle + reach, farthest_)) - 1.0f, first);
        const vec2 at(within(flat.centroid.x, left), within(flat.centroid.y, low));
        solid_ = solid_share(part, at);
        if (first == last) {
            add(projected_.position(at.x, at.y, within(flat.centroid.z, first)), at, area);
            return;
        }
        share(square(left, low), first, last, at, area);
    }

  private:
    Polygon square(float left, float low) const {
        Polygon square;
        for (const vec2& corner : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
            const float u = left + corner.x, v = low + corner.y;
            square.corner[square.count++] = {u, v, projected_.depth(u, v)};
        }
        return square;
    }
    /// The cells from `first` to `last` in depth share the triangle's area in the pixel as they share the plane over the pixel.
    void share(const Polygon& plane, float first, float last, const vec2& at, float area) {
        constexpr int most = 4;  // a slope of at most 1 along each axis
        Flat parts[most];
        float sum = 0;
        const int count = std::min(static_cast<int>(last - first) + 1, most);
        for (int i = 0; i < count; ++i) {
            const float depth = first + static_cast<float>(i);
            parts[i] = Flat(between(plane, 2, depth, depth + 1.0f));
            if (!(parts[i].area * projected_.slope_area > least_)) parts[i].area = 0;
            sum += parts[i].area;
        }
        for (int i = 0; i < count; ++i) {
            if (parts[i].area == 0.0f) continue;
            const vec3& c = parts[i].centroid;
            add(projected_.position(within(c.x, std::floor(at.x)), within(c.y, std::floor(at.y)),
                                    within(c.z, first + static_cast<float>(i))),
                at, area * parts[i].area / sum);
        }
    }
    /// Of the samples inside the triangle, or of its part's centroid where there is none.
    float solid_share(const Polygon& part, const vec2& at) const {
        if (triangle_.mask == nullptr) return 1.0f;
        int inside = 0, solid = 0;
        for (const vec2& sample : samples_) {
            const vec2 place = glm::floor(at) + sample;
            if (!contains(part, place)) continue;
            ++inside;
            solid += look_.solid(texcoord_.at(place.x, place.y)) ? 1 : 0;
        }
        if (inside == 0) return look_.solid(texcoord_.at(at.x, at.y)) ? 1.0f : 0.0f;
        return static_cast<float>(solid) / static_cast<float>(inside);
    }
    static bool contains(const Polygon& part, const vec2& place) {
        bool left = true, right = true;
        for (int i = 0; i < part.count; ++i) {
            const vec2 a = vec2(part.corner[i]) - place, b = vec2(part.corner[(i + 1) % part.count]) - place;
            const float side = a.x * b.y - a.y * b.x;
            left &= side >= 0.0f;
            right &= side <= 0.0f;
        }
        return left || right;
    }
    void add(const vec3& position, const vec2& at, float area) {
        const vec2 uv = triangle_.uniform() ? vec2(0) : texcoord_.at(at.x, at.y);
        const vec3 albedo = look_.albedo(uv), emission = look_.emission(uv);
        if (solid_ > 0.0f) sink_.add(position, area * solid_, true, albedo, emission);
        if (solid_ < 1.0f) sink_.add(position, area * (1.0f - solid_), false, albedo, emission);
    }

    const VoxelTriangle& triangle_;
    const Projected& projected_;
    Appearance look_;
    ProjectedTexcoord texcoord_;
    std::span<const vec2> samples_;
    float least_, nearest_ = 0, farthest_ = 0, solid_ = 1;
    ContributionSink& sink_;
};

}  // namespace

void rasterize_conservatively(const VoxelTriangle& t, const LinearBox& box, int oversampling, std::span<const vec2> samples,
                              ContributionSink& sink) {
    const Projected p(t, box, oversampling);
    refuse_longer_than_most_voxels(max_component(p.upper - p.lower) * p.voxels);
    Conservative fragments(t, p, samples, sink);
    Polygon whole;
    whole.count = 3;
    std::copy(p.corner, p.corner + 3, whole.corner.begin());
    for (int v = p.first_of(1, p.lower.y); v <= p.last_of(1, p.upper.y); ++v) {
        const Polygon row = between(whole, 1, static_cast<float>(v), static_cast<float>(v + 1));
        if (row.count < 3) continue;
        float left = row.corner[0].x, right = left;
        for (int i = 1; i < row.count; ++i) left = std::min(left, row.corner[i].x), right = std::max(right, row.corner[i].x);
        for (int u = p.first_of(0, left); u <= p.last_of(0, right); ++u) {
            const Polygon part = between(row, 0, static_cast<float>(u), static_cast<float>(u + 1));
            if (part.count >= 3) fragments.pixel(u, v, part);
        }
    }
}

}  // namespace interreflect
