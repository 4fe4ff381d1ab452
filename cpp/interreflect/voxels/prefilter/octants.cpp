// Compiled once for every vector width; the widest that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/prefilter/octants.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "voxels/prefilter/levels-inl.h"

#include <hwy/cache_control.h>

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace {

/// Texels of a few octants side by side, each a block of four floats.
constexpr int octants_at_once = HWY_MAX_BYTES >= 64 ? 4 : HWY_MAX_BYTES >= 32 ? 2 : 1;
using DO = hn::FixedTag<float, 4 * octants_at_once>;
using VO = hn::Vec<DO>;
using HO = hn::Rebind<hwy::float16_t, DO>;

/// Octants [first, first + octants_at_once) of the texel at `texel` in the first volume, `volume` halves from one to the next.
HWY_INLINE VO load_octants(const std::uint16_t* texel, std::size_t volume, int first) {
    if (texel == air) return hn::Zero(DO());
    const auto* from = reinterpret_cast<const hwy::float16_t*>(texel + static_cast<std::size_t>(first) * volume);
    if (volume == 4) return hn::PromoteTo(DO(), hn::LoadU(HO(), from));
    const auto one = [&](std::size_t i) HWY_ATTR { return hn::LoadU(H(), from + i * volume); };
#if HWY_MAX_BYTES >= 32
    const hn::FixedTag<hwy::float16_t, 8> h8;
    const auto pair = hn::Combine(h8, one(1), one(0));
#if HWY_MAX_BYTES >= 64
    return hn::PromoteTo(DO(), hn::Combine(HO(), hn::Combine(h8, one(3), one(2)), pair));
#else
    return hn::PromoteTo(DO(), pair);
#endif
#else
    return hn::PromoteTo(DO(), one(0));
#endif
}
/// A packed texel is a cache line that is not read before all are written. Past the cache go 16 bytes at the least.
HWY_INLINE void store_octants(VO value, std::uint16_t* texel, std::size_t volume, int first) {
    alignas(64) std::uint16_t halves[4 * octants_at_once];
    std::uint16_t* out = texel + static_cast<std::size_t>(first) * volume;
#if HWY_MAX_BYTES >= 32
    if (volume == 4) return hn::Stream(nearest_halves(DO(), value), HO(), reinterpret_cast<hwy::float16_t*>(out));
#endif
    hn::Store(nearest_halves(DO(), value), HO(), reinterpret_cast<hwy::float16_t*>(halves));
    for (std::size_t i = 0; i < octants_at_once; ++i) __builtin_memcpy(out + i * volume, halves + 4 * i, 4 * sizeof(*out));
}

/// For each axis the sign that octants look down it by, four lanes each: +1 for those that meet the upper texel first.
struct Signs {
    alignas(64) float axis[3][32];

    constexpr Signs() : axis{} {
        for (int lane = 0; lane < 32; ++lane)
            for (int a = 0; a < 3; ++a) axis[a][lane] = (lane / 4 >> a & 1) != 0 ? -1.0f : 1.0f;
    }
};
constexpr Signs signs;
HWY_INLINE VO sign_of(int axis, int first) { return hn::Load(DO(), signs.axis[axis] + 4 * first); }

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
    VO texel[8], alpha[8], open[8];
    for (int i = 0; i < 8; ++i) {
        texel[i] = without_hidden(load_octants(children.texel[i], volume, first));
        alpha[i] = hn::Broadcast<3>(texel[i]);
        open[i] = hn::Set(d, 3.0f);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const auto down = hn::Gt(sign_of(axis, first), hn::Zero(d));
        for (int i = 0; i < 8; ++i) {
            if ((i >> axis & 1) != 0) continue;
            const int upper = i | 1 << axis;
            open[i] = hn::IfThenElse(down, hn::Sub(open[i], alpha[upper]), open[i]);
            open[upper] = hn::IfThenElse(down, open[upper], hn::Sub(open[upper], alpha[i]));
        }
    }
    VO seen = hn::Mul(texel[0], open[0]);
    for (int i = 1; i < 8; ++i) seen = hn::MulAdd(texel[i], open[i], seen);
    HWY_ALIGN constexpr float last[4] = {0, 0, 0, 1};
    const VO whole = hn::Set(d, opacity), sum = hn::Broadcast<3>(seen);
    const auto any = hn::Gt(sum, hn::Zero(d));
    const VO scaled = hn::Mul(seen, hn::Div(whole, hn::IfThenElse(any, sum, hn::Set(d, 1.0f))));
    return hn::IfThenElse(any, scaled, hn::Or(hn::Mul(whole, hn::LoadDup128(d, last)), hidden_mark()));
}

/// The eight texels in the first volume of a packed level.
HWY_INLINE Children packed_children(const LevelView& fine, const PackedView& packed, int x, int y, int z) {
    Children c;
    for (int i = 0; i < 8; ++i) {
        const int cx = 2 * x + (i & 1), cy = 2 * y + ((i >> 1) & 1), cz = 2 * z + (i >> 2);
        const bool inside = cx < fine.nx && cy < fine.ny && cz < fine.nz;
        c.texel[i] = inside ? packed.texels + 4 * static_cast<std::size_t>(number_at(packed, cx, cy, cz)) : packed.texels;
    }
    return c;
}

/// Whether none of the eight exists; as all_air.
HWY_INLINE bool none_there(const PackedView& packed, int x, int y, int z) {
    const std::uint32_t* first = packed.number + 2 * x + 2 * y * static_cast<std::ptrdiff_t>(packed.row) +
                                 2 * z * static_cast<std::ptrdiff_t>(packed.slice);
    std::uint64_t any = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        std::uint64_t pair;
        __builtin_memcpy(&pair, first + (i & 1) * packed.row + (i >> 1) * packed.slice, sizeof(pair));
        any |= pair;
    }
    return any == 0;
}

/// `packed`: where the octants of the finer level are, unless it is dense; `fine` is then read for columns only.
void reduce_slice_octants(const LevelView& fine, const PackedView& packed, const LevelView& coarse, int z, bool columns) {
    const D d;
    const bool dense = packed.texels == nullptr;
    const std::size_t volume = dense ? fine.volume : 4;
    for (int y = 0; y < coarse.ny; ++y) {
        std::uint16_t* row = coarse.texels + at(coarse, 0, y, z);
        for (std::size_t octant = 0; octant < 8; ++octant)
            __builtin_memset(row + octant * coarse.volume, 0, static_cast<std::size_t>(coarse.nx) * 4 * sizeof(*row));
        for (int x = 0; x < coarse.nx; ++x) {
            if (dense ? all_air(fine, x, y, z) : none_there(packed, x, y, z)) continue;
            const Children c = dense ? children(fine, x, y, z) : packed_children(fine, packed, x, y, z);
            V sum = hn::Zero(d);
            for (const auto* texel : c.texel) sum = hn::Add(sum, load(texel));
            const float opacity = columns ? column_opacity(fine, x, y, z)
                                          : hn::GetLane(alpha_of(hn::Min(hn::Mul(sum, hn::Set(d, 0.25f)), hn::Set(d, 1.0f))));
            if (!(opacity > 0.0f)) continue;
            for (int first = 0; first < 8; first += octants_at_once)
                store_octants(reduce_octants(c, volume, first, opacity), row + 4 * x, coarse.volume, first);
        }
    }
}

/// How far the octants' eyes see the front of a surface: the share of its normal's coordinates that point against them; all of it
/// where there is no normal.
HWY_INLINE VO facing_shares(const float* normal, int first) {
    const DO d;
    const VO zero = hn::Zero(d);
    VO towards = zero;
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        towards = hn::Add(towards, hn::Max(hn::Mul(sign_of(axis, first), hn::Set(d, normal[axis])), zero));
        sum += normal[axis] < 0.0f ? -normal[axis] : normal[axis];
    }
    return sum > 0.0f ? hn::Mul(towards, hn::Set(d, 1.0f / sum)) : hn::Set(d, 1.0f);
}

/// What one voxel shows to eyes that look along the octants: its front and its back as far as they face them. A back that no
/// light falls on is the inside of a solid rather than anything to be seen, wherever some of the front faces the octant.
HWY_INLINE void write_sides(const VoxelView& voxels, std::size_t i, std::uint16_t* out, std::size_t volume) {
    const DO d;
    const D one;
    HWY_ALIGN float front[4], back[4];
    hn::Store(premultiplied(voxels.radiance + 3 * i, voxels.opacity[i], voxels.inverse_scale), one, front);
    const VO seen = hn::LoadDup128(d, front);
    if (voxels.back == nullptr) {
        for (int first = 0; first < 8; first += octants_at_once) store_octants(seen, out, volume, first);
        return;
    }
    const float* radiance = voxels.back + 3 * i;
    const bool lit = radiance[0] > 0.0f || radiance[1] > 0.0f || radiance[2] > 0.0f;
    hn::Store(premultiplied(radiance, voxels.opacity[i], voxels.inverse_scale), one, back);
    const VO behind = lit ? hn::LoadDup128(d, back) : hn::Or(hn::LoadDup128(d, back), hidden_mark());
    for (int first = 0; first < 8; first += octants_at_once) {
        const VO share = facing_shares(voxels.normal + i * voxels.normal_stride, first);
        const VO shown = lit ? hn::MulAdd(hn::Sub(seen, behind), share, behind)
                             : hn::IfThenElse(hn::Gt(share, hn::Set(d, 0.25f)), seen, behind);
        store_octants(shown, out, volume, first);
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
    over_voxels(level, voxels, [&](std::size_t i, const Texel& texel, bool inner) HWY_ATTR {
        write_sides(voxels, i, level.texels + at(level, texel.x, texel.y, texel.z), level.volume);
        if (!inner) repeat_outwards(level, texel);
    });
}

/// The eight octants of one voxel after the other; `texels`: of voxel 0.
void write_packed_octants(std::uint16_t* texels, const VoxelView& voxels) {
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) write_sides(voxels, i, texels + 32 * i, 4);
    hwy::FlushStream();
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
    const auto reduce_packed = [&](const LevelView& fine, const PackedView& packed, const LevelView& coarse, int z) {
        HWY_DYNAMIC_DISPATCH(reduce_slice_octants)(fine, packed, coarse, z, columns);
    };
    const auto reduce = [&](const LevelView& fine, const LevelView& coarse, int z) { reduce_packed(fine, {}, coarse, z); };
    const auto pack = [](std::uint16_t* texels, const VoxelView& voxels) {
        HWY_DYNAMIC_DISPATCH(write_packed_octants)(texels, voxels);
    };
    const auto write = [](const LevelView& level, const VoxelView& voxels, int z) {
        HWY_DYNAMIC_DISPATCH(write_slices_octants)(level, voxels, z);
    };
    if (pyramid.levels[0].dense())
        build_levels(pyramid, all, columns, write, reduce);
    else
        build_levels_in_bricks(pyramid, all, {pack, reduce_packed, columns ? 1 : 0}, reduce);
    return pyramid;
}

}  // namespace interreflect
#endif
