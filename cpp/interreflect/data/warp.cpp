#include "data/warp.h"

#include <algorithm>
#include <cmath>

namespace interreflect {
namespace {

/// One axis of a separable warp: on either side of its centre a curve from 0 at the centre to 1 at the box's face, odd about the
/// centre, so that the paper's curve is left where the centre is the middle. It runs on straight beyond the box.
struct Curve {
    Warp::Kind kind;
    float steepness;

    /// Freed 2018, 4.6.1, written about its middle: with slope s there, s u + (1 - s) u^3; the logistic function shifted and
    /// scaled (as printed it maps [0, 1] to [.5, .731]: ERRATA) is a hyperbolic tangent.
    float inside(float u) const {
        return kind == Warp::Kind::cubic ? u * (steepness + (1.0f - steepness) * u * u)
                                         : std::tanh(steepness * u) / std::tanh(steepness);
    }
    float slope(float u) const {
        u = std::min(u, 1.0f);
        if (kind == Warp::Kind::cubic) return steepness + 3.0f * (1.0f - steepness) * u * u;
        const float t = std::tanh(steepness * u);
        return steepness * (1.0f - t * t) / std::tanh(steepness);
    }
    float value(float u) const { return u <= 1.0f ? inside(u) : 1.0f + (u - 1.0f) * slope(1.0f); }
    float inverse(float y) const {
        if (y >= 1.0f) return 1.0f + (y - 1.0f) / std::max(slope(1.0f), 1e-6f);
        if (kind == Warp::Kind::logistic) return std::atanh(y * std::tanh(steepness)) / steepness;
        // Newton's method on a monotone cubic, kept within the bracket: slopes may vanish at either end.
        double low = 0, high = 1, u = y;
        const double s = steepness;
        for (int i = 0; i < 60; ++i) {
            const double error = u * (s + (1 - s) * u * u) - y;
            if (std::fabs(error) < 1e-12) break;
            (error > 0 ? high : low) = u;
            u -= error / (s + 3 * (1 - s) * u * u);
            if (!(u > low && u < high)) u = 0.5 * (low + high);
        }
        return static_cast<float>(u);
    }
};

/// Distance from the centre to the box's face on the side of `offset`.
float half_width(float offset, float centre, float cells) { return offset < 0.0f ? centre : cells - centre; }

}  // namespace

vec3 Warp::to_voxels(const vec3& p, const ivec3& cells) const {
    if (kind == Kind::linear) return p;
    if (separable()) return slopes_at(p, cells).voxels;
    const vec3 n(cells);
    const float x = glm::dot(right, p), y = glm::dot(up, p), z = glm::dot(forward, p);
    if (kind == Kind::perspective) {
        const float depth = linear_depth ? (z - near) / (far - near) : (1.0f - near / z) / (1.0f - near / far);
        return n * vec3(0.5f + 0.5f * x / (z * half_x), 0.5f + 0.5f * y / (z * half_y), depth);
    }
    const float across = std::hypot(x, z), radius = std::hypot(across, y);
    return n * vec3(0.5f + 0.5f * std::atan2(x, z) / half_x, 0.5f + 0.5f * (std::atan2(y, across) - elevation) / half_y,
                    std::log(radius / near) / std::log(far / near));
}

vec3 Warp::to_linear(const vec3& q, const ivec3& cells) const {
    if (kind == Kind::linear) return q;
    const vec3 n(cells);
    if (separable()) {
        const Curve curve{kind, steepness};
        vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const float offset = q[axis] - centre[axis], half = half_width(offset, centre[axis], n[axis]);
            p[axis] = half > 0.0f ? centre[axis] + std::copysign(half * curve.inverse(std::fabs(offset) / half), offset)
                                  : centre[axis] + offset / curve.slope(0.0f);
        }
        return p;
    }
    const vec3 t = q / n;
    if (kind == Kind::perspective) {
        const float z = linear_depth ? near + t.z * (far - near) : near / (1.0f - t.z * (1.0f - near / far));
        return z * (right * ((2.0f * t.x - 1.0f) * half_x) + up * ((2.0f * t.y - 1.0f) * half_y) + forward);
    }
    const float azimuth = (2.0f * t.x - 1.0f) * half_x, above = (2.0f * t.y - 1.0f) * half_y + elevation;
    const vec3 level = right * std::sin(azimuth) + forward * std::cos(azimuth);
    return near * std::pow(far / near, t.z) * (level * std::cos(above) + up * std::sin(above));
}

Warp::Slopes Warp::slopes_at(const vec3& p, const ivec3& cells) const {
    if (kind == Kind::linear) return {p, vec3(1)};
    const Curve curve{kind, steepness};
    const vec3 n(cells);
    Slopes at{};
    for (int axis = 0; axis < 3; ++axis) {
        const float offset = p[axis] - centre[axis], half = half_width(offset, centre[axis], n[axis]);
        const float u = half > 0.0f ? std::fabs(offset) / half : 0.0f;
        at.slopes[axis] = curve.slope(u);
        at.voxels[axis] =
            half > 0.0f ? centre[axis] + std::copysign(half * curve.value(u), offset) : centre[axis] + offset * curve.slope(0.0f);
    }
    return at;
}

mat3 Warp::density(const vec3& p, const ivec3& cells) const {
    if (kind == Kind::linear) return mat3(1.0f);
    if (separable()) {
        const vec3 slopes = slopes_at(p, cells).slopes;
        return {{slopes.x, 0, 0}, {0, slopes.y, 0}, {0, 0, slopes.z}};
    }
    const vec3 n(cells);
    const float x = glm::dot(right, p), y = glm::dot(up, p), z = glm::dot(forward, p);
    vec3 rows[3];
    if (kind == Kind::perspective) {
        rows[0] = (right - forward * (x / z)) * (0.5f * n.x / (half_x * z));
        rows[1] = (up - forward * (y / z)) * (0.5f * n.y / (half_y * z));
        rows[2] = forward * (linear_depth ? n.z / (far - near) : n.z * near / (z * z * (1.0f - near / far)));
    } else {
        const float across2 = x * x + z * z, across = std::sqrt(across2), radius2 = across2 + y * y;
        rows[0] = (right * z - forward * x) * (0.5f * n.x / (half_x * across2));
        rows[1] = (up * across - (right * x + forward * z) * (y / across)) * (0.5f * n.y / (half_y * radius2));
        rows[2] = p * (n.z / (std::log(far / near) * radius2));
    }
    return glm::transpose(mat3(rows[0], rows[1], rows[2]));
}

}  // namespace interreflect
