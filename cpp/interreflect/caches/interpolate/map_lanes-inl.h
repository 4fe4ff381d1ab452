// Look-ups in hemisphere maps for vectors of lanes. Included once for every vector target.
#if defined(INTERREFLECT_MAP_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_MAP_LANES
#undef INTERREFLECT_MAP_LANES
#else
#define INTERREFLECT_MAP_LANES
#endif

#include <algorithm>
#include <cstdint>

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Indices = hn::Vec<hn::RebindToSigned<Tag>>;

struct Square {
    Vector x, y;
};

/// hemisphere_square of hemisphere_map.h. 4 / pi times the arctangent on [0, 1] as a polynomial, off by 3.2e-7 at most.
HWY_INLINE Square hemisphere_square_lanes(const Vec3& direction) {
    const Tag d;
    const auto number = [d](float value) HWY_ATTR { return hn::Set(d, value); };
    const Vector zero = hn::Zero(d), half = number(0.5f), x = hn::Abs(direction.x), y = hn::Abs(direction.y);
    const Vector larger = hn::Max(x, y), smaller = hn::Min(x, y);
    const Vector t = hn::Div(smaller, hn::Max(larger, number(1e-30f))), t2 = hn::Mul(t, t);
    Vector turn = hn::MulAdd(number(0.008673040f), t2, number(-0.042786207f));
    for (const float factor : {0.101379990f, -0.168492134f, 0.252200938f, -0.424209905f, 1.273234594f})
        turn = hn::MulAdd(turn, t2, number(factor));
    const Vector down = hn::Max(hn::Sub(number(1.0f), direction.z), zero);
    const Vector radius = hn::Mul(half, hn::Sqrt(hn::Min(down, number(1.0f)))), across = hn::Mul(hn::Mul(turn, t), radius);
    const auto wide = hn::Ge(x, y);
    const Vector px = hn::IfThenElse(wide, radius, across), py = hn::IfThenElse(wide, across, radius);
    return {hn::Add(hn::CopySign(px, direction.x), half), hn::Add(hn::CopySign(py, direction.y), half)};
}

/// Bilinear between the centres of an n x n map: the upper left texel, and the weights of the four.
struct Corners {
    Indices first;
    Vector weight[4];

    HWY_INLINE Corners(const Square& at, int n, Vector times) {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const Vector size = hn::Set(d, static_cast<float>(n)), last = hn::Set(d, static_cast<float>(n - 1));
        const Vector most = hn::Set(d, static_cast<float>(std::max(n - 2, 0)));
        const auto place = [&](Vector s)
                               HWY_ATTR { return hn::Min(hn::Max(hn::MulAdd(s, size, hn::Set(d, -0.5f)), hn::Zero(d)), last); };
        const Vector px = place(at.x), py = place(at.y);
        const Vector x = hn::Min(hn::Floor(px), most), y = hn::Min(hn::Floor(py), most);
        const Vector fx = hn::Sub(px, x), fy = hn::Mul(hn::Sub(py, y), times);
        // Whole numbers below 2^23 are the lower bits of their sums with it: conversions would look for ones beyond the integers.
        constexpr float shift = 8388608.0f;
        const Vector shifted = hn::MulAdd(y, size, hn::Add(x, hn::Set(d, shift)));
        first = hn::And(hn::BitCast(di, shifted), hn::Set(di, (1 << 23) - 1));
        weight[3] = hn::Mul(fx, fy);
        weight[2] = hn::Sub(fy, weight[3]);
        weight[1] = hn::NegMulAdd(fx, fy, hn::Mul(fx, times));
        weight[0] = hn::Sub(hn::Sub(times, fy), weight[1]);
    }
};

/// Looks of one vector of pixels into one map each of several caches.
///
/// Neighbouring pixels tend to look between the same four texels. Such looks are kept apart from the others, so that neither way
/// to add them up waits for a branch.
class Looks {
  public:
    static constexpr int capacity = 32;

    explicit HWY_INLINE Looks(int n) : n_(n) {}

    /// At most `capacity`.
    HWY_INLINE void look(const std::uint16_t* texels, const Square& at, Vector times) {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const Corners corners(at, n_, times);
        Look& look = looks_[count_];
        look.texels = texels;
        hn::Store(corners.first, di, look.first);
        for (int corner = 0; corner < 4; ++corner) hn::Store(corners.weight[corner], d, look.weight[corner]);
        const auto within = hn::Gt(times, hn::Zero(d));
        look.cell = hn::GetLane(hn::BitCast(di, hn::Compress(hn::BitCast(d, corners.first), within)));
        const auto same = hn::RebindMask(d, hn::Eq(corners.first, hn::Set(di, look.cell)));
        const bool one = hn::AllFalse(d, hn::AndNot(same, within)), any = !hn::AllFalse(d, within);
        in_one_cell_[ones_] = in_many_cells_[manies_] = static_cast<std::uint8_t>(count_);
        ones_ += one && any ? 1 : 0, manies_ += one ? 0 : 1, ++count_;
    }

    HWY_INLINE void add_to(Vector sum[4]) {
        load_corners();
        add_ones(sum);
        for (int k = 0; k < manies_; ++k) add_many(looks_[in_many_cells_[k]], sum);
    }
    HWY_INLINE void clear() { count_ = ones_ = manies_ = 0; }

  private:
    static constexpr int most = hn::MaxLanes(Tag());
    struct Look {
        alignas(64) float weight[4][most];
        alignas(64) std::int32_t first[most];
        const std::uint16_t* texels;
        std::int32_t cell;  // of the first pixel that counts
    };
    using Texel = hn::FixedTag<float, 4>;

    static HWY_INLINE hn::Vec<Texel> texel(const std::uint16_t* from) {
        return hn::PromoteTo(Texel(),
                             hn::LoadU(hn::Rebind<hwy::float16_t, Texel>(), reinterpret_cast<const hwy::float16_t*>(from)));
    }
    HWY_INLINE void load_corners() {
        const int right = n_ > 1 ? 4 : 0, below = n_ > 1 ? 4 * n_ : 0;
        for (int k = 0; k < ones_; ++k) {
            const Look& look = looks_[in_one_cell_[k]];
            const std::uint16_t* from = look.texels + 4 * look.cell;
            hn::Store(texel(from), Texel(), corners_[k]), hn::Store(texel(from + right), Texel(), corners_[k] + 4);
            hn::Store(texel(from + below), Texel(), corners_[k] + 8),
                hn::Store(texel(from + below + right), Texel(), corners_[k] + 12);
        }
    }
    HWY_INLINE void add_ones(Vector sum[4]) const {
        const Tag d;
        Vector lower[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};  // of shorter chains
        for (int k = 0; k < ones_; ++k) {
            const Look& look = looks_[in_one_cell_[k]];
            Vector weight[4];
            for (int corner = 0; corner < 4; ++corner) weight[corner] = hn::Load(d, look.weight[corner]);
            for (int c = 0; c < 4; ++c) {
                sum[c] = hn::MulAdd(weight[0], hn::Set(d, corners_[k][c]), sum[c]);
                lower[c] = hn::MulAdd(weight[2], hn::Set(d, corners_[k][8 + c]), lower[c]);
                sum[c] = hn::MulAdd(weight[1], hn::Set(d, corners_[k][4 + c]), sum[c]);
                lower[c] = hn::MulAdd(weight[3], hn::Set(d, corners_[k][12 + c]), lower[c]);
            }
        }
        for (int c = 0; c < 4; ++c) sum[c] = hn::Add(sum[c], lower[c]);
    }
    /// One load for each texel: gathers of halves take twice as long.
    HWY_INLINE void add_many(const Look& look, Vector sum[4]) const {
        const Tag d;
        const Texel d4;
        alignas(64) float mean[4 * most];
        const int below = 4 * n_;  // there are neighbours: a map of one texel is one cell
        for (int i = 0; i < most; ++i) {
            const std::uint16_t* from = look.texels + 4 * look.first[i];
            auto here = hn::Mul(hn::Set(d4, look.weight[0][i]), texel(from));
            here = hn::MulAdd(hn::Set(d4, look.weight[1][i]), texel(from + 4), here);
            here = hn::MulAdd(hn::Set(d4, look.weight[2][i]), texel(from + below), here);
            hn::Store(hn::MulAdd(hn::Set(d4, look.weight[3][i]), texel(from + below + 4), here), d4, mean + 4 * i);
        }
        Vector r, g, b, a;
        hn::LoadInterleaved4(d, mean, r, g, b, a);
        sum[0] = hn::Add(sum[0], r), sum[1] = hn::Add(sum[1], g), sum[2] = hn::Add(sum[2], b), sum[3] = hn::Add(sum[3], a);
    }

    int n_, count_ = 0, ones_ = 0, manies_ = 0;
    Look looks_[capacity];
    std::uint8_t in_one_cell_[capacity], in_many_cells_[capacity];
    alignas(64) float corners_[capacity][16];
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
