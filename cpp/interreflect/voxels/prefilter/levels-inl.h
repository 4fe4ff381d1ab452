// Texels as vectors. Included once for every vector target.
#if defined(INTERREFLECT_LEVELS_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_LEVELS_KERNEL
#undef INTERREFLECT_LEVELS_KERNEL
#else
#define INTERREFLECT_LEVELS_KERNEL
#endif

#include "math/half_lanes-inl.h"
#include "voxels/prefilter/levels.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::FixedTag<float, 4>;  // one texel
using H = hn::Rebind<hwy::float16_t, D>;
using V = hn::Vec<D>;

HWY_INLINE V load(const std::uint16_t* texel) {
    return hn::PromoteTo(D(), hn::LoadU(H(), reinterpret_cast<const hwy::float16_t*>(texel)));
}
HWY_INLINE void store(V value, std::uint16_t* texel) {
    hn::StoreU(nearest_halves(D(), value), H(), reinterpret_cast<hwy::float16_t*>(texel));
}
HWY_INLINE V alpha_of(V texel) { return hn::Broadcast<3>(texel); }

HWY_INLINE std::size_t at(const LevelView& level, int x, int y, int z) {
    return static_cast<std::size_t>(z + 1) * level.slice + static_cast<std::size_t>(y + 1) * level.row +
           static_cast<std::size_t>(x + 1) * 4;
}

/// The eight texels below one, in the order x + 2 y + 4 z; those beyond the finer level are air.
struct Children {
    const std::uint16_t* texel[8];
};
alignas(16) constexpr std::uint16_t air[4] = {0, 0, 0, 0};
HWY_INLINE Children children(const LevelView& fine, int x, int y, int z) {
    Children c;
    for (int i = 0; i < 8; ++i) {
        const int cx = 2 * x + (i & 1), cy = 2 * y + ((i >> 1) & 1), cz = 2 * z + (i >> 2);
        const bool inside = cx < fine.nx && cy < fine.ny && cz < fine.nz;
        c.texel[i] = inside ? fine.texels + at(fine, cx, cy, cz) : air;
    }
    return c;
}

/// Number of a packed texel.
HWY_INLINE std::uint32_t number_at(const PackedView& packed, int x, int y, int z) {
    return packed.number[x + y * static_cast<std::ptrdiff_t>(packed.row) + z * static_cast<std::ptrdiff_t>(packed.slice)];
}

/// Whether all eight are air: four looks at two neighbours.
HWY_INLINE bool all_air(const LevelView& fine, int x, int y, int z) {
    const std::uint16_t* first = fine.texels + at(fine, 2 * x, 2 * y, 2 * z);
    std::uint64_t any = 0;
    // Beyond the finer level lies its border: air where the texel inside it is.
    for (std::size_t i = 0; i < 4; ++i) {
        std::uint64_t pair[2];
        __builtin_memcpy(pair, first + (i & 1) * fine.row + (i >> 1) * fine.slice, sizeof(pair));
        any |= pair[0] | pair[1];
    }
    return any == 0;
}

/// A texel beyond an odd size is air; beyond an even one the border repeats the outermost, which keeps all of its weight then.
HWY_INLINE bool is_air(int at, int size) { return at >= size && (at > size || (size & 1) != 0); }

/// How much of a texel's cross-section is blocked along the axis that sees most of it. Its columns reach a finer texel beyond it
/// on either side: where a slanted wall leaves a texel through its side, the neighbour's part of the wall closes the column. Only
/// the first volume is read.
HWY_INLINE float column_opacity(const LevelView& fine, int x, int y, int z) {
    const D d;
    const V one = hn::Set(d, 1.0f);
    const int first[3] = {2 * x, 2 * y, 2 * z}, size[3] = {fine.nx, fine.ny, fine.nz};
    const std::ptrdiff_t step[3] = {4, static_cast<std::ptrdiff_t>(fine.row), static_cast<std::ptrdiff_t>(fine.slice)};
    const std::uint16_t* base = fine.texels + at(fine, first[0], first[1], first[2]);
    V most = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        V blocked = hn::Zero(d);
        for (int column = 0; column < 4; ++column) {
            const int da = column & 1, db = column >> 1;
            if (is_air(first[a] + da, size[a]) || is_air(first[b] + db, size[b])) continue;
            V open = one;
            for (int k = -1; k <= 2; ++k)
                if (!is_air(first[axis] + k, size[axis]))
                    open = hn::NegMulAdd(open, load(base + k * step[axis] + da * step[a] + db * step[b]), open);
            blocked = hn::Add(blocked, hn::Sub(one, open));
        }
        most = hn::Max(most, blocked);
    }
    return 0.25f * hn::ExtractLane(most, 3);
}

/// What an eye sees through one face of eight texels: the four pairs along its axis, front to back, then their mean.
HWY_INLINE V composite(const V* texel, int face) {
    const D d;
    const int axis = face >> 1, behind = 1 << axis, towards = face & 1;
    V sum = hn::Zero(d);
    for (int i = 0; i < 8; ++i) {
        if ((i & behind) != 0) continue;
        const V front = texel[towards != 0 ? i | behind : i], back = texel[towards != 0 ? i : i | behind];
        sum = hn::Add(sum, hn::MulAdd(back, hn::Sub(hn::Set(d, 1.0f), alpha_of(front)), front));
    }
    return hn::Mul(sum, hn::Set(d, 0.25f));
}

/// Three floats wherever they lie. MaskedLoad of SSE4 would read four of them, and only from multiples of 16 bytes.
HWY_INLINE V load_three(const float* from) {
#if HWY_TARGET == HWY_SSE4
    alignas(16) const float padded[4] = {from[0], from[1], from[2], 0.0f};
    return hn::Load(D(), padded);
#else
    return hn::MaskedLoad(hn::FirstN(D(), 3), D(), from);
#endif
}
HWY_INLINE V premultiplied(const float* radiance, float opacity, float inverse_scale) {
    const D d;
    const V rgb = hn::Mul(load_three(radiance), hn::Set(d, inverse_scale));
    return hn::Mul(hn::InsertLane(rgb, 3, 1.0f), hn::Set(d, opacity));
}

/// What a channel of eight bits would hold: a multiple of 1/255 in [0, 1].
HWY_INLINE V eight_bits(V value) {
    const D d;
    const V whole = hn::Set(d, 255.0f);
    const V clipped = hn::Min(hn::Max(value, hn::Zero(d)), hn::Set(d, 1.0f));
    return hn::Mul(hn::Round(hn::Mul(clipped, whole)), hn::Set(d, 1.0f / 255.0f));
}

struct Texel {
    int x, y, z;
};
/// Calls visit(i, its texel, whether that has no copies in the border) for every voxel.
template <class Visit>
HWY_INLINE void over_voxels(const LevelView& level, const VoxelView& voxels, const Visit& visit) {
    const auto width = static_cast<std::uint32_t>(level.nx), height = static_cast<std::uint32_t>(level.ny);
    std::uint32_t first = 0, end = 0;  // cells of the row of the voxel before
    Texel at{};
    bool inner_row = false;
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) {
        const std::uint32_t cell = voxels.cell[i] - voxels.base;
        if (cell >= end) {
            const std::uint32_t line = cell / width;
            first = line * width, end = first + width;
            at.y = static_cast<int>(line % height), at.z = static_cast<int>(line / height);
            inner_row = at.y > 0 && at.z > 0 && at.y + 1 < level.ny && at.z + 1 < level.nz;
        }
        at.x = static_cast<int>(cell - first);
        visit(i, at, inner_row && at.x > 0 && at.x + 1 < level.nx);
    }
}

/// A voxel, and its copies in the border.
HWY_INLINE void write_voxel(const LevelView& level, const Texel& texel, bool inner, V value) {
    const auto [x, y, z] = texel;
    store(value, level.texels + at(level, x, y, z));
    if (inner) return;
    for (int bz = (z == 0 ? -1 : z); bz <= (z + 1 == level.nz ? z + 1 : z); ++bz)
        for (int by = (y == 0 ? -1 : y); by <= (y + 1 == level.ny ? y + 1 : y); ++by)
            for (int bx = (x == 0 ? -1 : x); bx <= (x + 1 == level.nx ? x + 1 : x); ++bx)
                store(value, level.texels + at(level, bx, by, bz));
}

/// The texel of voxel `i`; in `bytes`, radiance is clipped at 1 before opacity scales it.
HWY_INLINE V voxel_texel(const VoxelView& voxels, std::size_t i, bool bytes) {
    const float *radiance = voxels.radiance + 3 * i, opacity = voxels.opacity[i];
    return bytes ? eight_bits(hn::Mul(hn::Min(premultiplied(radiance, 1.0f, 1.0f), hn::Set(D(), 1.0f)), hn::Set(D(), opacity)))
                 : premultiplied(radiance, opacity, voxels.inverse_scale);
}

/// Slices 2 z and 2 z + 1 of a grid's level (with the border next to them): cleared, then written.
inline void write_slices(const LevelView& level, const VoxelView& voxels, int z, bool bytes) {
    const int first = z == 0 ? -1 : 2 * z, last = 2 * z + 2 >= level.nz ? level.nz : 2 * z + 1;
    __builtin_memset(level.texels + static_cast<std::size_t>(first + 1) * level.slice, 0,
                     static_cast<std::size_t>(last - first + 1) * level.slice * sizeof(std::uint16_t));
    over_voxels(level, voxels, [&](std::size_t i, const Texel& texel, bool inner) HWY_ATTR {
        write_voxel(level, texel, inner, voxel_texel(voxels, i, bytes));
    });
}

/// The same voxels one after the other; `texels`: of voxel 0.
inline void write_packed(std::uint16_t* texels, const VoxelView& voxels, bool bytes) {
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) store(voxel_texel(voxels, i, bytes), texels + 4 * i);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
