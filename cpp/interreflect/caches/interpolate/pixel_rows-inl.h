// Vectors of three floats of four pixels, which most often lie side by side. Included once for every vector target.
#if defined(INTERREFLECT_PIXEL_ROWS) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_PIXEL_ROWS
#undef INTERREFLECT_PIXEL_ROWS
#else
#define INTERREFLECT_PIXEL_ROWS
#endif

#include <algorithm>
#include <cstdint>

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct PixelRow {
    using Four = hn::FixedTag<float, 4>;
    static constexpr int length = 4;

    const std::uint32_t* pixel;
    bool neighbours;  // one after another

    explicit HWY_INLINE PixelRow(const std::uint32_t* of) : pixel(of) {
        const hn::FixedTag<std::uint32_t, 4> d;
        neighbours = hn::AllTrue(d, hn::Eq(hn::LoadU(d, of), hn::Iota(d, of[0])));
    }
    HWY_INLINE void load(const vec3* from, float* x, float* y, float* z) const {
        if (neighbours) {
            const Four d;
            hn::Vec<Four> a, b, c;
            hn::LoadInterleaved3(d, &from[pixel[0]].x, a, b, c);
            hn::StoreU(a, d, x), hn::StoreU(b, d, y), hn::StoreU(c, d, z);
        } else {
            for (int k = 0; k < length; ++k) x[k] = from[pixel[k]].x, y[k] = from[pixel[k]].y, z[k] = from[pixel[k]].z;
        }
    }
    HWY_INLINE void load(const float* from, float* to) const {
        for (int k = 0; k < length; ++k) to[k] = from[pixel[k]];
    }
    /// Of the first `count` pixels.
    HWY_INLINE void store(const float* x, const float* y, const float* z, int count, vec3* to) const {
        if (neighbours && count >= length) {
            const Four d;
            hn::StoreInterleaved3(hn::LoadU(d, x), hn::LoadU(d, y), hn::LoadU(d, z), d, &to[pixel[0]].x);
        } else {
            for (int k = 0; k < std::min(count, length); ++k) to[pixel[k]] = {x[k], y[k], z[k]};
        }
    }
    HWY_INLINE void store(const float* from, int count, float* to) const {
        for (int k = 0; k < std::min(count, length); ++k) to[pixel[k]] = from[k];
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
