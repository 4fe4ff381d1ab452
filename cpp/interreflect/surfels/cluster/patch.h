/// Patches of surfels, and how far two of them are from being one.
#pragma once
#include <cstdint>

#include "data/surfels.h"

namespace interreflect {

/// Means are by area.
struct Patch {
    vec3 position;    // mean, in extents of the scene
    vec3 normal;      // unit: the mean's direction
    vec3 normal_sum;  // times areas
    float area;       // scene units squared
};

inline Patch patch_of(const Surfels& surfels, std::size_t i) {
    const float scale = surfels.extent > 0.0f ? 1.0f / surfels.extent : 1.0f;
    return {surfels.position[i] * scale, surfels.normal[i], surfels.normal[i] * surfels.area[i], surfels.area[i]};
}
inline Patch merged(const Patch& a, const Patch& b) {
    Patch c;
    c.area = a.area + b.area;
    c.position = a.position + (b.position - a.position) * (c.area > 0.0f ? b.area / c.area : 0.5f);
    c.normal_sum = a.normal_sum + b.normal_sum;
    const float length = glm::length(c.normal_sum);
    c.normal = length > 0.0f ? c.normal_sum / length : a.normal;
    return c;
}

/// The distance of Jendersie et al. 2016, 4.3. Its terms are added up in one order and grow with what they measure even as
/// rounded, so that the same terms of bounds are bounds of it, bit for bit.
struct PatchMetric {
    float normal_weight, balance_weight;

    static float square(float x, float y, float z) { return x * x + y * y + z * z; }
    /// |A - A'| / max(A, A')
    static float imbalance(float a, float b) {
        const float larger = a > b ? a : b, smaller = a > b ? b : a;
        return larger > 0.0f ? 1.0f - smaller / larger : 0.0f;
    }
    float sum(float square_distance, float cosine, float out_of_balance) const {
        const float turn = 1.0f - cosine;
        return square_distance + normal_weight * (turn > 0.0f ? turn : 0.0f) + balance_weight * out_of_balance;
    }
    float operator()(const Patch& a, const Patch& b) const {
        const vec3 d = a.position - b.position;
        const float cosine = a.normal.x * b.normal.x + a.normal.y * b.normal.y + a.normal.z * b.normal.z;
        return sum(square(d.x, d.y, d.z), cosine, imbalance(a.area, b.area));
    }
};

}  // namespace interreflect
