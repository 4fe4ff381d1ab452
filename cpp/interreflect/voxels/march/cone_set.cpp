#include "voxels/march/cone_set.h"

#include <algorithm>
#include <cmath>

namespace interreflect {
namespace {

vec3 tilted(float cosine, float azimuth) {
    const float sine = std::sqrt(std::fmax(0.0f, 1.0f - cosine * cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// Solid angle of a cone of its own width, of the hemisphere's part that it stands for. The pyramid's filter reaches past the
/// cone, so cones that fill their part see too far aside: of 1, .6, .4 and .2 this had the least error on rooms, Cornell box and
/// atrium.
constexpr float own_share = 0.4f;

/// Mean of the cosine to the axis over a cone.
float mean_cosine_to_axis(float half_angle) { return 0.5f * (1.0f + std::cos(half_angle)); }

/// Cones of each ring, from the normal outwards: rings of equal width on the projected disk hold cones in the ratio 1 : 3 : 5 ...
std::vector<int> ring_counts(int count) {
    if (count < 5) return {count};
    const int rings = std::max(2, static_cast<int>(std::lround(std::sqrt(static_cast<float>(count) / 1.5f))));
    std::vector<int> counts(rings);
    int placed = 0;
    for (int i = 0; i < rings; ++i) {
        const float outer = static_cast<float>((i + 1) * (i + 1)) / static_cast<float>(rings * rings);
        const int until =
            i + 1 == rings ? count : std::max(placed + 1, static_cast<int>(outer * static_cast<float>(count) + 0.4f));
        counts[i] = until - placed;
        placed = until;
    }
    return counts;
}

/// Cones at one tilt, for a ring of the projected disk.
struct Ring {
    int cones;
    float share;        // of all cones
    float mean_cosine;  // over the ring's part of the hemisphere
    bool axis;          // one cone along the normal

    float cosine(float factor) const { return axis ? 1.0f : std::fmin(1.0f, factor * mean_cosine); }
};

std::vector<Ring> make_rings(int count) {
    std::vector<Ring> rings;
    // Squared radius u on the projected disk: cos = sqrt(1 - u), whose integral is -2/3 (1 - u)^(3/2).
    const auto integral = [](float u) { return -2.0f / 3.0f * std::pow(std::fmax(0.0f, 1.0f - u), 1.5f); };
    int placed = 0;
    const auto counts = ring_counts(count);
    for (const int cones : counts) {
        const float inner = static_cast<float>(placed) / static_cast<float>(count);
        placed += cones;
        const float outer = static_cast<float>(placed) / static_cast<float>(count);
        rings.push_back(
            {cones, outer - inner, (integral(outer) - integral(inner)) / (outer - inner), cones == 1 && counts.size() > 1});
    }
    return rings;
}

/// The factor on all rings' cosines for which their weighted sum is `wanted`: wide cones must stand steeper than their parts.
float common_tilt(const std::vector<Ring>& rings, float wanted) {
    double low = 0, high = 100;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        double sum = 0;
        for (const auto& ring : rings) sum += ring.share * ring.cosine(static_cast<float>(middle));
        (sum < wanted ? low : high) = middle;
    }
    return static_cast<float>(low);
}

}  // namespace

float ConeSet::mean_cosine() const {
    float sum = 0;
    for (const auto& cone : cones) sum += cone.weight * cone.direction.z;
    return sum * mean_cosine_to_axis(half_angle);
}

ConeSet freed_thesis_cones() {
    ConeSet set;
    set.half_angle = 22.5f * degrees_to_radians;
    set.cones.push_back({{0, 0, 1}, 0.2f});
    for (int i = 0; i < 4; ++i) set.cones.push_back({tilted(std::sqrt(0.5f), 0.5f * pi * static_cast<float>(i)), 0.2f});
    return set;
}

ConeSet six_60_cones() {
    ConeSet set;
    set.half_angle = 30.0f * degrees_to_radians;
    set.cones.push_back({{0, 0, 1}, 0.25f});
    for (int i = 0; i < 5; ++i) set.cones.push_back({tilted(0.5f, 0.4f * pi * static_cast<float>(i)), 0.15f});
    return set;
}

ConeSet cosine_cones(int count, float half_angle) {
    ConeSet set;
    const auto n = static_cast<float>(count);
    set.half_angle = half_angle > 0.0f ? half_angle : std::acos(1.0f - own_share / n);
    const auto rings = make_rings(count);
    const float tilt = common_tilt(rings, 2.0f / 3.0f / mean_cosine_to_axis(set.half_angle));
    for (std::size_t r = 0; r < rings.size(); ++r)
        for (int i = 0; i < rings[r].cones; ++i) {
            // Every other ring is turned by half a cone, so that cones stand in the gaps of the ring within.
            const float turn = (static_cast<float>(i) + 0.5f * static_cast<float>(r % 2)) / static_cast<float>(rings[r].cones);
            set.cones.push_back({tilted(rings[r].cosine(tilt), 2.0f * pi * turn), 1.0f / n});
        }
    return set;
}

}  // namespace interreflect
