#include "virtual_lights/shade/disk_integral.h"

#include <array>

namespace interreflect {
namespace {

using glm::dvec3;
constexpr int sides = 48;
// A disk this many times its radius away is as good as a point: what is left out is of the square's order.
constexpr double far_radii = 100.0;

/// Corners of the regular polygon of a disk's area, in its plane.
const std::array<glm::dvec2, sides>& polygon() {
    static const auto corners = [] {
        std::array<glm::dvec2, sides> made;
        const double step = 2.0 * std::numbers::pi / sides;
        const double radius = std::sqrt(2.0 * std::numbers::pi / (sides * std::sin(step)));
        for (int i = 0; i < sides; ++i) made[i] = radius * glm::dvec2(std::cos(step * i), std::sin(step * i));
        return made;
    }();
    return corners;
}

/// Share of a receiver's cosine-weighted hemisphere that a convex polygon covers; corners relative to it, counted so that a
/// polygon in front gives a positive sum.
double lambert_sum(const std::array<dvec3, sides>& corners, const dvec3& normal) {
    std::array<dvec3, 2 * sides> kept;
    int count = 0;
    for (int i = 0; i < sides; ++i) {
        const dvec3 &a = corners[i], &b = corners[(i + 1) % sides];
        const double ha = glm::dot(a, normal), hb = glm::dot(b, normal);
        if (ha >= 0) kept[count++] = a;
        if ((ha < 0) != (hb < 0)) kept[count++] = a + (b - a) * (ha / (ha - hb));
    }
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const dvec3 &a = kept[i], &b = kept[(i + 1) % count], across = glm::cross(a, b);
        const double sine = glm::length(across);
        if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across, normal) / sine;
    }
    return std::fabs(sum) / (2.0 * std::numbers::pi);
}

}  // namespace

void irradiance(const DiskIntegral&, const DiskLight& light, const Receivers& receivers, float, PerReceiver& result) {
    const Frame frame(light.normal);
    const double radius = light.radius();
    for (int i = 0; i < receivers.padded(); ++i) {
        const dvec3 at = receivers.position_at(i), normal = receivers.normal_at(i);
        const dvec3 to = dvec3(light.position) - at;
        const double distance2 = glm::dot(to, to), height = -glm::dot(to, dvec3(light.normal));
        result[i] = 0.0f;
        // Where nothing but rounding lifts a receiver off the disk's plane, or the disk off a horizon, there is no light.
        const auto highest = [&](const dvec3& n) {
            const double slope = glm::dot(n, dvec3(light.normal));
            return glm::dot(to, n) + radius * std::sqrt(std::fmax(1.0 - slope * slope, 0.0));
        };
        const double rounding = 1e-4 * radius;
        if (!(height > light.least_height()) || !(highest(normal) > rounding)) continue;
        if (!(highest(dvec3(receivers.geometric_normal_at(i))) > rounding)) continue;
        if (distance2 > far_radii * far_radii * radius * radius) {
            const double cosine = glm::dot(to, normal);
            if (cosine > 0) result[i] = static_cast<float>(cosine * height / (std::numbers::pi * distance2 * distance2));
            continue;
        }
        std::array<dvec3, sides> corners;
        for (int k = 0; k < sides; ++k)
            corners[k] = to + (dvec3(frame.tangent) * polygon()[k].x + dvec3(frame.bitangent) * polygon()[k].y) * radius;
        result[i] = static_cast<float>(lambert_sum(corners, normal) / light.area);
    }
}

}  // namespace interreflect
