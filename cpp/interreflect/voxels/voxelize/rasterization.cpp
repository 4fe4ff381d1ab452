#include "voxels/voxelize/rasterization.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

/// Pixels [first, end) of a row in which each sample is covered; samples beyond the last repeat the first, four at a time.
struct Spans {
    int first[most_samples], end[most_samples];
};

/// Where the samples of a pixel lie, four side by side.
struct Samples {
    std::array<float, most_samples> u{}, v{}, once{};  // place in the pixel; 1, or 0 for those that repeat the first ones
    std::size_t count, lanes;

    explicit Samples(std::span<const vec2> samples) : count(samples.size()), lanes((samples.size() + 3) / 4 * 4) {
        for (std::size_t s = 0; s < most_samples; ++s)
            u[s] = samples[s % count].x, v[s] = samples[s % count].y, once[s] = s < count ? 1.0f : 0.0f;
    }
    vec2 at(std::size_t s) const { return {u[s], v[s]}; }
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
    /// The pixels of row `row` whose samples are covered. Half-open: [lowest, highest) edges.
    void cover(float row, const Samples& samples, const Projected& p, Spans& covered) const {
        const auto first = static_cast<float>(p.first.x), end = static_cast<float>(p.end.x);
        for (std::size_t begin = 0; begin < samples.lanes; begin += 4)
            for (std::size_t s = begin; s < begin + 4; ++s) {
                const float v = row + samples.v[s];
                float left = end + 1.0f, right = first - 1.0f;  // where no edge is crossed
                for (int i = 0; i < 3; ++i) {
                    const bool crossed = (low[i].y <= v) & (v < high[i].y);
                    const float x = low[i].x + slope[i] * (v - low[i].y);
                    left = (crossed & (x < left)) ? x : left;
                    right = (crossed & (x > right)) ? x : right;
                }
                left = std::ceil(left - samples.u[s]), right = std::ceil(right - samples.u[s]);
                left = left < first ? first : left > end ? end : left;
                right = right < first ? first : right > end ? end : right;
                covered.first[s] = static_cast<int>(left);
                covered.end[s] = static_cast<int>(right);
            }
    }
};

/// Puts the covered samples of pixels into the sink.
class Fragments {
  public:
    Fragments(const VoxelTriangle& t, const Projected& p, const Samples& samples, ContributionSink& sink)
        : triangle_(t),
          projected_(p),
          look_(t, std::min(t.area, p.slope_area)),
          texcoord_(t, p),
          samples_(samples),
          share_(p.slope_area / static_cast<float>(samples.count)),
          sink_(sink) {}

    /// `covered`: the pixels of the row of each sample.
    void row(int v, const Spans& covered) {
        int first = std::numeric_limits<int>::max(), end = std::numeric_limits<int>::min();
        for (std::size_t s = 0; s < samples_.count; ++s) {
            const bool some = covered.first[s] < covered.end[s];
            first = std::min(first, some ? covered.first[s] : first);
            end = std::max(end, some ? covered.end[s] : end);
        }
        for (int u = first; u < end; ++u) pixel(u, v, covered);
    }

  private:
    void pixel(int u, int v, const Spans& covered) {
        if (triangle_.mask != nullptr) return masked_pixel(u, v, covered);
        // Sums of sixteenths: the same in any order.
        std::array<float, 4> sum_u{}, sum_v{}, count{};
        for (std::size_t begin = 0; begin < samples_.lanes; begin += 4)
            for (std::size_t i = 0; i < 4; ++i) {
                const std::size_t s = begin + i;
                const float in = ((u >= covered.first[s]) & (u < covered.end[s])) ? samples_.once[s] : 0.0f;
                sum_u[i] += in * samples_.u[s];
                sum_v[i] += in * samples_.v[s];
                count[i] += in;
            }
        const auto all = [](const std::array<float, 4>& of) { return (of[0] + of[1]) + (of[2] + of[3]); };
        const float n = all(count);
        if (n == 0.0f) return;
        add(vec2(u, v) + vec2(all(sum_u), all(sum_v)) / n, share_ * n);
    }
    /// Masked texels are taken away one by one.
    void masked_pixel(int u, int v, const Spans& covered) {
        for (std::size_t s = 0; s < samples_.count; ++s)
            if (u >= covered.first[s] && u < covered.end[s]) add(vec2(u, v) + samples_.at(s), share_);
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
    const Samples& samples_;
    float share_;  // area of a sample
    ContributionSink& sink_;
};

void rasterize(const VoxelTriangle& t, const LinearBox& box, int oversampling, const Samples& samples, ContributionSink& sink) {
    const Projected p(t, box, oversampling);
    refuse_longer_than_most_voxels(max_component(p.upper - p.lower) * p.voxels);
    const Edges edges(p);
    Spans covered;
    Fragments fragments(t, p, samples, sink);
    const int last = p.last_of(1, p.upper.y);
    for (int v = p.first_of(1, p.lower.y); v <= last; ++v) {
        edges.cover(static_cast<float>(v), samples, p, covered);
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
    const Samples positions(samples);
    const Unseen unseen(samples, technique.oversampling);
    const EmitPacket pass_over = [&](const TrianglePacket& packet, std::uint32_t, ContributionSink&) {
        return unseen.of(packet);
    };
    return voxelize_triangles(
        scene, domain, Handing::grids,
        [&, full](const VoxelTriangle& triangle, ContributionSink& sink) {
            if (full)
                rasterize_conservatively(triangle, box, technique.oversampling, samples, sink);
            else
                rasterize(triangle, box, technique.oversampling, positions, sink);
        },
        blend, full ? EmitPacket() : pass_over);
}

}  // namespace interreflect
