// Compiled once for every vector width; the widest that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/prefilter/octants.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "voxels/prefilter/levels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace {

/// Texels of a few octants side by side, each a block of four floats.
constexpr int octants_at_once = HWY_MAX_BYTES >= 64 ? 4 : HWY_MAX_BYTES >= 32 ? 2 : 1;
using DO = hn::FixedTag<float, 4 * octants_at_once>;
using VO = hn::Vec<DO>;

HWY_INLINE VO load_octants(const std::uint16_t* const* texels) {
    const auto one = [&](int i) HWY_ATTR { return hn::LoadU(H(), reinterpret_cast<const hwy::float16_t*>(texels[i])); };
#if HWY_MAX_BYTES >= 32
    const hn::FixedTag<hwy::float16_t, 8> h8;
    const auto first = hn::Combine(h8, one(1), one(0));
#if HWY_MAX_BYTES >= 64
    return hn::PromoteTo(DO(), hn::Combine(hn::FixedTag<hwy::float16_t, 16>(), hn::Combine(h8, one(3), one(2)), first));
#else
    return hn::PromoteTo(DO(), first);
#endif
#else
    return hn::PromoteTo(DO(), one(0));
#endif
}
HWY_INLINE void store_octants(VO value, std::uint16_t* out, std::size_t volume) {
    alignas(64) std::uint16_t halves[4 * octants_at_once];
    const hn::Rebind<hwy::float16_t, DO> half;
    hn::Store(hn::DemoteTo(half, value), half, reinterpret_cast<hwy::float16_t*>(halves));
    for (std::size_t i = 0; i < octants_at_once; ++i) __builtin_memcpy(out + i * volume, halves + 4 * i, 4 * sizeof(*out));
}

/// A red of -0 marks a texel of which nothing that light falls on faces an eye looking along the octant: the inside of a solid,
/// or a wall seen from beyond the scene. It stays opaque and black, but hides nothing of its neighbours in a coarser texel.
HWY_INLINE VO hidden_mark() {
    HWY_ALIGN constexpr float texel[4] = {-0.0f, 0, 0, 0};
    return hn::LoadDup128(DO(), texel);
}
HWY_INLINE VO without_hidden(VO texel) {
    const hn::RebindToUnsigned<DO> bits;
    const auto red = hn::Broadcast<0>(hn::BitCast(bits, texel));
    return hn::IfThenZeroElse(hn::RebindMask(DO(), hn::Eq(red, hn::Set(bits, 0x80000000U))), texel);
}

/// The eight texels below a coarse one in octants [first, first + octants_at_once), as eyes looking along them see them: the mean
/// of three axes, along which the nearer texel of a pair hides the farther one, made as opaque as surface coverage has it.
HWY_INLINE VO reduce_octants(const Children& children, std::size_t volume, int first, float opacity) {
    const DO d;
    const std::uint16_t* of[8][octants_at_once];
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < octants_at_once; ++k) {
            const int octant = first + k;  // looking up an axis, an eye meets the lower texel first
            const std::uint16_t* texel = children.texel[i ^ (~octant & 7)];
            of[i][k] = texel == air ? air : texel + static_cast<std::size_t>(octant) * volume;
        }
    VO texel[8], alpha[8];
    for (int i = 0; i < 8; ++i) {
        texel[i] = without_hidden(load_octants(of[i]));
        alpha[i] = hn::Broadcast<3>(texel[i]);
    }
    const VO three = hn::Set(d, 3.0f);
    VO seen = hn::Mul(texel[0], three);
    for (int i = 1; i < 8; ++i) {  // bit k of i: the farther one of a pair along axis k
        VO open = three;
        for (int axis = 1; axis < 8; axis *= 2)
            if ((i & axis) != 0) open = hn::Sub(open, alpha[i ^ axis]);
        seen = hn::MulAdd(texel[i], open, seen);
    }
    HWY_ALIGN constexpr float last[4] = {0, 0, 0, 1};
    const VO whole = hn::Set(d, opacity), sum = hn::Broadcast<3>(seen);
    const auto any = hn::Gt(sum, hn::Zero(d));
    const VO scaled = hn::Mul(seen, hn::Div(whole, hn::IfThenElse(any, sum, hn::Set(d, 1.0f))));
    return hn::IfThenElse(any, scaled, hn::Or(hn::Mul(whole, hn::LoadDup128(d, last)), hidden_mark()));
}

void reduce_slice_octants(const LevelView& fine, const LevelView& coarse, int z, bool columns) {
    const D d;
    for (int y = 0; y < coarse.ny; ++y) {
        std::uint16_t* row = coarse.texels + at(coarse, 0, y, z);
        for (std::size_t octant = 0; octant < 8; ++octant)
            __builtin_memset(row + octant * coarse.volume, 0, static_cast<std::size_t>(coarse.nx) * 4 * sizeof(*row));
        for (int x = 0; x < coarse.nx; ++x) {
            if (all_air(fine, x, y, z)) continue;
            const Children c = children(fine, x, y, z);
            V sum = hn::Zero(d);
            for (const auto* texel : c.texel) sum = hn::Add(sum, load(texel));
            const float opacity = columns ? column_opacity(fine, x, y, z)
                                          : hn::GetLane(alpha_of(hn::Min(hn::Mul(sum, hn::Set(d, 0.25f)), hn::Set(d, 1.0f))));
            for (int first = 0; first < 8; first += octants_at_once)
                store_octants(reduce_octants(c, fine.volume, first, opacity),
                              row + 4 * x + static_cast<std::size_t>(first) * coarse.volume, coarse.volume);
        }
    }
}

/// How far each octant's eyes see the front of a surface: the share of its normal's coordinates that point against them.
HWY_INLINE void facing_shares(const float* normal, float shares[8]) {
    float towards[3][2], sum = 0;  // of each axis: of eyes looking down it, and up
    for (int axis = 0; axis < 3; ++axis) {
        towards[axis][0] = normal[axis] > 0.0f ? normal[axis] : 0.0f;
        towards[axis][1] = normal[axis] < 0.0f ? -normal[axis] : 0.0f;
        sum += towards[axis][0] + towards[axis][1];
    }
    const float scale = sum > 0.0f ? 1.0f / sum : 0.0f, none = sum > 0.0f ? 0.0f : 1.0f;
    for (int octant = 0; octant < 8; ++octant)
        shares[octant] = (towards[0][octant & 1] + towards[1][octant >> 1 & 1] + towards[2][octant >> 2]) * scale + none;
}

/// What one voxel shows to eyes that look along the octants: its front and its back as far as they face them. A back that no
/// light falls on is the inside of a solid rather than anything to be seen, wherever some of the front faces the octant.
HWY_INLINE void write_sides(const VoxelView& voxels, std::size_t i, std::uint16_t* out, std::size_t volume) {
    const DO d;
    const D one;
    HWY_ALIGN float front[4], back[4], shares[8];
    hn::Store(premultiplied(voxels.radiance + 3 * i, voxels.opacity[i], voxels.inverse_scale), one, front);
    const VO seen = hn::LoadDup128(d, front);
    if (voxels.back == nullptr) {
        for (int first = 0; first < 8; first += octants_at_once)
            store_octants(seen, out + static_cast<std::size_t>(first) * volume, volume);
        return;
    }
    const float* radiance = voxels.back + 3 * i;
    const bool lit = radiance[0] > 0.0f || radiance[1] > 0.0f || radiance[2] > 0.0f;
    hn::Store(premultiplied(radiance, voxels.opacity[i], voxels.inverse_scale), one, back);
    facing_shares(voxels.normal + i * voxels.normal_stride, shares);
    if (!lit)
        for (auto& share : shares) share = share > 0.25f ? 1.0f : 0.0f;
    const VO behind = lit ? hn::LoadDup128(d, back) : hn::Or(hn::LoadDup128(d, back), hidden_mark());
    for (int first = 0; first < 8; first += octants_at_once) {
        HWY_ALIGN float share[4 * octants_at_once];
        for (int k = 0; k < 4 * octants_at_once; ++k) share[k] = shares[first + k / 4];
        const VO front_share = hn::Load(d, share);
        const VO mixed = hn::MulAdd(hn::Sub(seen, behind), front_share, behind);
        const VO shown = lit ? mixed : hn::IfThenElse(hn::Gt(front_share, hn::Zero(d)), seen, behind);
        store_octants(shown, out + static_cast<std::size_t>(first) * volume, volume);
    }
}

/// Copies a voxel at the domain's edge into the border beside it.
HWY_INLINE void repeat_outwards(const LevelView& level, const Texel& inner) {
    const auto [x, y, z] = inner;
    const std::uint16_t* texel = level.texels + at(level, x, y, z);
    for (int bz = (z == 0 ? -1 : z); bz <= (z + 1 == level.nz ? z + 1 : z); ++bz)
        for (int by = (y == 0 ? -1 : y); by <= (y + 1 == level.ny ? y + 1 : y); ++by)
            for (int bx = (x == 0 ? -1 : x); bx <= (x + 1 == level.nx ? x + 1 : x); ++bx)
                for (std::size_t octant = 0; octant < 8; ++octant)
                    __builtin_memmove(level.texels + at(level, bx, by, bz) + octant * level.volume, texel + octant * level.volume,
                                      4 * sizeof(*texel));
}

/// Slices 2 z and 2 z + 1 of the eight octants of a grid's level.
void write_slices_octants(const LevelView& level, const VoxelView& voxels, int z) {
    VoxelView none = voxels;
    none.end = none.begin;
    for (std::size_t octant = 0; octant < 8; ++octant) {
        LevelView cleared = level;
        cleared.texels += octant * level.volume;
        write_slices(cleared, none, z, false);
    }
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) {
        const Texel texel = texel_of(level, voxels, i);
        const auto [x, y, vz] = texel;
        write_sides(voxels, i, level.texels + at(level, x, y, vz), level.volume);
        const bool inner = x > 0 && y > 0 && vz > 0 && x + 1 < level.nx && y + 1 < level.ny && vz + 1 < level.nz;
        if (!inner) repeat_outwards(level, texel);
    }
}

/// The eight volumes of voxels one after the other; `texels`: of voxel 0.
void write_packed_octants(std::uint16_t* texels, std::size_t volume, const VoxelView& voxels) {
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) write_sides(voxels, i, texels + 4 * i, volume);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "voxels/prefilter/bricks.h"

#include "math/parallel.h"

namespace interreflect {
namespace {
HWY_EXPORT(reduce_slice_octants);
HWY_EXPORT(write_slices_octants);
HWY_EXPORT(write_packed_octants);
}  // namespace

Pyramid build_octants(bool columns, const LevelKnobs& knobs, const LitVoxels& lit) {
    Pyramid pyramid = make_levels(*lit.grid, 8, knobs);
    pyramid.scale = radiance_scale(lit);
    const Normals normals = in_grid(front_normals(lit), lit);
    const VoxelView all = view(lit, pyramid.scale, normals);
    const auto reduce = [&](const LevelView& fine, const LevelView& coarse, int z) {
        HWY_DYNAMIC_DISPATCH(reduce_slice_octants)(fine, coarse, z, columns);
    };
    const auto pack = [](std::uint16_t* texels, std::size_t volume, const VoxelView& voxels) {
        HWY_DYNAMIC_DISPATCH(write_packed_octants)(texels, volume, voxels);
    };
    const auto write = [](const LevelView& level, const VoxelView& voxels, int z) {
        HWY_DYNAMIC_DISPATCH(write_slices_octants)(level, voxels, z);
    };
    if (pyramid.levels[0].dense())
        build_levels(pyramid, all, columns, write, reduce);
    else
        build_levels_in_bricks(pyramid, all, pack, reduce);
    return pyramid;
}

}  // namespace interreflect
#endif
