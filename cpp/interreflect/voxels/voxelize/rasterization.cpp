#include "voxels/voxelize/rasterization.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "voxels/voxelize/appearance.h"
#include "voxels/voxelize/conservative.h"
#include "voxels/voxelize/projected.h"
#include "voxels/voxelize/sample_pattern.h"
#include "voxels/voxelize/unseen.h"

namespace interreflect {
namespace {

constexpr int most_samples = 8;

/// Pixels [first, end) of a row.
struct Span {
    int first = 0, end = 0;
};

/// Edges from their lower to their upper end: two triangles see the same crossings of an edge they share.
struct Edges {
    vec2 low[3], high[3];
    float slope[3];

    explicit Edges(const Projected& p) {
        for (int i = 0; i < 3; ++i) {
            low[i] = p.corner[i], high[i] = p.corner[(i + 1) % 3];
            if (low[i].y > high[i].y) std::swap(low[i], high[i]);
            slope[i] = (high[i].x - low[i].x) / (high[i].y - low[i].y);  // not finite where nothing crosses
        }
    }
    /// Pixels of the row that contains `v` whose sample, at `u` in the pixel, is covered. Half-open: [lowest, highest) edges.
    Span covered(float v, float u, const Projected& p) const {
        float left = 0, right = 0;
        bool found = false;
        for (int i = 0; i < 3; ++i) {
            if (!(low[i].y <= v && v < high[i].y)) continue;
            const float x = low[i].x + slope[i] * (v - low[i].y);
            left = found ? std::min(left, x) : x;
            right = found ? std::max(right, x) : x;
            found = true;
        }
        if (!found) return {};
        const auto first = static_cast<float>(p.first.x), end = static_cast<float>(p.end.x);
        return {static_cast<int>(std::clamp(std::ceil(left - u), first, end)),
                static_cast<int>(std::clamp(std::ceil(right - u), first, end))};
    }
};

/// Puts the covered samples of pixels into the sink.
class Fragments {
  public:
    Fragments(const VoxelTriangle& t, const Projected& p, std::span<const vec2> samples, ContributionSink& sink)
        : triangle_(t),
          projected_(p),
          look_(t, std::min(t.area, p.slope_area)),
          texcoord_(t, p),
          samples_(samples),
          share_(p.slope_area / static_cast<float>(samples.size())),
          sink_(sink) {}

    /// `covered`: the pixels of the row of each sample.
    void row(int v, const Span* covered) {
        int first = covered[0].first, end = covered[0].end;
        for (std::size_t s = 1; s < samples_.size(); ++s) {
            if (covered[s].first >= covered[s].end) continue;
            const bool none = first >= end;
            first = none ? covered[s].first : std::min(first, covered[s].first);
            end = none ? covered[s].end : std::max(end, covered[s].end);
        }
        for (int u = first; u < end; ++u) pixel(u, v, covered);
    }

  private:
    void pixel(int u, int v, const Span* covered) {
        vec2 sum{0};
        int count = 0;
        for (std::size_t s = 0; s < samples_.size(); ++s) {
            if (u < covered[s].first || u >= covered[s].end) continue;
            if (triangle_.mask != nullptr) add(vec2(u, v) + samples_[s], share_);  // masked texels are taken away one by one
            sum += samples_[s];
            ++count;
        }
        if (count == 0 || triangle_.mask != nullptr) return;
        const auto n = static_cast<float>(count);
        add(vec2(u, v) + sum / n, share_ * n);
    }
    void add(const vec2& at, float area) {
        const float depth = std::clamp(projected_.depth(at.x, at.y), projected_.lower.z, projected_.upper.z);
        const vec3 position = projected_.position(at.x, at.y, depth);
        if (triangle_.uniform()) {
            sink_.add(position, area, true, triangle_.material->albedo, triangle_.material->emission);
            return;
        }
        const vec2 uv = texcoord_.at(at.x, at.y);
        sink_.add(position, area, look_.solid(uv), look_.albedo(uv), look_.emission(uv));
    }

    const VoxelTriangle& triangle_;
    const Projected& projected_;
    Appearance look_;
    ProjectedTexcoord texcoord_;
    std::span<const vec2> samples_;
    float share_;  // area of a sample
    ContributionSink& sink_;
};

void rasterize(const VoxelTriangle& t, const LinearBox& box, int oversampling, std::span<const vec2> samples,
               ContributionSink& sink) {
    const Projected p(t, box, oversampling);
    refuse_longer_than_most_voxels(max_component(p.upper - p.lower) * p.voxels);
    const Edges edges(p);
    Span covered[most_samples];
    Fragments fragments(t, p, samples, sink);
    const int last = p.last_of(1, p.upper.y);
    for (int v = p.first_of(1, p.lower.y); v <= last; ++v) {
        for (std::size_t s = 0; s < samples.size(); ++s)
            covered[s] = edges.covered(static_cast<float>(v) + samples[s].y, samples[s].x, p);
        fragments.row(v, covered);
    }
}

}  // namespace

VoxelGrid voxelize(const Rasterization& technique, const Scene& scene, const Domain& domain) {
    const auto samples = sample_pattern(technique.samples);
    if (samples.empty())
        throw std::invalid_argument("Rasterization.samples must be 1, 2, 4 or 8, got " + std::to_string(technique.samples));
    const bool full = technique.conservative == "full";
    const Blend blend = technique.blend == "max" ? Blend::max : Blend::mean;
    const LinearBox box(domain, Handing::grids);
    return voxelize_triangles(
        scene, domain, Handing::grids,
        [&, full](const VoxelTriangle& triangle, ContributionSink& sink) {
            if (full)
                rasterize_conservatively(triangle, box, technique.oversampling, samples, sink);
            else
                rasterize(triangle, box, technique.oversampling, samples, sink);
        },
        blend, full ? PassOver() : PassOver(Unseen(samples, technique.oversampling)));
}

}  // namespace interreflect
