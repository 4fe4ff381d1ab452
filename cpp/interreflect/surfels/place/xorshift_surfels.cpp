#include "surfels/place/xorshift_surfels.h"

#include "math/rng.h"
#include "surfels/place/point_on_surface.h"

namespace interreflect {
namespace {

/// A step of Marsaglia's generator of 32 bits.
std::uint32_t xorshift(std::uint32_t x) {
    x ^= x << 13U;
    x ^= x >> 17U;
    return x ^ (x << 5U);
}

}  // namespace

Surfels place_surfels(const XorshiftSurfels& technique, const Scene& scene, const Intersector&) {
    std::uint32_t state = 2463534242U;  // the article's own seed
    const auto next = [&state] { return unit_float(state = xorshift(state)); };
    return surfels_by_area(scene, technique.surfels, [&](std::uint32_t) {
        const float x = next();
        return vec2(x, next());
    });
}

}  // namespace interreflect
