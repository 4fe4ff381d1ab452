#include "voxels/march/cone_set.h"

#include <algorithm>
#include <cmath>

namespace interreflect {
namespace {

vec3 tilted(float cosine, float azimuth) {
    const float sine = std::sqrt(std::fmax(0.0f, 1.0f - cosine * cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

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

ConeSet freed_program_cones() {
    ConeSet set;
    set.half_angle = 30.0f * degrees_to_radians;
    set.cones.push_back({{0, 0, 1}, 0.25f});
    for (int i = 0; i < 5; ++i) set.cones.push_back({tilted(0.5f, 0.4f * pi * static_cast<float>(i)), 0.15f});
    return set;
}

ConeSet cosine_cones(int count, float half_angle) {
    ConeSet set;
    const auto n = static_cast<float>(count);
    set.half_angle = half_angle > 0.0f ? half_angle : std::acos(1.0f - 1.0f / n);
    const float spread = mean_cosine_to_axis(set.half_angle);
    const auto rings = ring_counts(count);
    // Squared radius u on the projected disk: cos = sqrt(1 - u), whose integral is -2/3 (1 - u)^(3/2).
    const auto integral = [](float u) { return -2.0f / 3.0f * std::pow(std::fmax(0.0f, 1.0f - u), 1.5f); };
    float missing = 2.0f / 3.0f / spread;  // sum of weight * cos that the cones must reach
    int placed = 0;
    for (std::size_t ring = 0; ring < rings.size(); ++ring) {
        const float inner = static_cast<float>(placed) / n, outer = static_cast<float>(placed + rings[ring]) / n,
                    share = outer - inner;
        // The outermost ring takes what the inner ones could not (a wide cone about the normal cannot reach its part's cosine).
        const bool last = ring + 1 == rings.size();
        const float cosine = last ? missing / share : std::fmin(1.0f, (integral(outer) - integral(inner)) / share / spread);
        missing -= share * cosine;
        for (int i = 0; i < rings[ring]; ++i) {
            const float turn = (static_cast<float>(i) + 0.5f * static_cast<float>(ring % 2)) / static_cast<float>(rings[ring]);
            const bool axis = ring == 0 && rings[ring] == 1 && !last;
            set.cones.push_back({axis ? vec3(0, 0, 1) : tilted(std::fmin(cosine, 1.0f), 2.0f * pi * turn), 1.0f / n});
        }
        placed += rings[ring];
    }
    return set;
}

}  // namespace interreflect
