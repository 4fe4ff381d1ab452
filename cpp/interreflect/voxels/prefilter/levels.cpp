// Compiled once for every vector width; the widest that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/prefilter/levels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "voxels/prefilter/levels.h"

#ifndef INTERREFLECT_VOXELS_LEVELS_VIEW
#define INTERREFLECT_VOXELS_LEVELS_VIEW
namespace interreflect {
/// A level as plain numbers, in halves: kernels of several targets share no functions.
struct LevelView {
    std::uint16_t* texels;
    int nx, ny, nz;
    std::size_t row, slice, volume;
};
/// The voxels of some slices of the finest level.
struct VoxelView {
    const std::uint32_t* cell;
    const float *radiance, *back, *normal, *opacity;
    std::size_t begin, end;
    float inverse_scale;
};
}  // namespace interreflect
#endif

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::FixedTag<float, 4>;  // one texel
using H = hn::Rebind<hwy::float16_t, D>;
using V = hn::Vec<D>;

HWY_INLINE V load(const std::uint16_t* texel) {
    return hn::PromoteTo(D(), hn::LoadU(H(), reinterpret_cast<const hwy::float16_t*>(texel)));
}
HWY_INLINE void store(V value, std::uint16_t* texel) {
    hn::StoreU(hn::DemoteTo(H(), value), H(), reinterpret_cast<hwy::float16_t*>(texel));
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

/// Volume coverage: the mean. Surface coverage: a quarter of the sum, brought back to opacity 1 where it is more. Premultiplied
/// radiance follows opacity, so its colour is the children's mean weighted by opacity.
HWY_INLINE V reduce(V sum, bool surface) {
    const D d;
    const V scale = surface ? hn::Min(hn::Set(d, 0.25f), hn::Div(hn::Set(d, 1.0f), hn::Max(alpha_of(sum), hn::Set(d, 1e-6f))))
                            : hn::Set(d, 0.125f);
    return hn::Mul(sum, scale);
}

void reduce_slice(const LevelView& fine, const LevelView& coarse, int z, bool surface) {
    const D d;
    for (int y = 0; y < coarse.ny; ++y) {
        std::uint16_t* out = coarse.texels + at(coarse, 0, y, z);
        for (int x = 0; x < coarse.nx; ++x, out += 4) {
            V sum = hn::Zero(d);
            if (!all_air(fine, x, y, z)) {
                const Children c = children(fine, x, y, z);
                for (const auto* texel : c.texel) sum = hn::Add(sum, load(texel));
                sum = reduce(sum, surface);
            }
            store(sum, out);
        }
    }
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

void reduce_slice_faces(const LevelView& fine, const LevelView& coarse, int z) {
    const D d;
    for (int face = 0; face < 6; ++face) {
        LevelView seen = fine;
        seen.texels += static_cast<std::size_t>(face) * fine.volume;
        for (int y = 0; y < coarse.ny; ++y) {
            std::uint16_t* out = coarse.texels + static_cast<std::size_t>(face) * coarse.volume + at(coarse, 0, y, z);
            for (int x = 0; x < coarse.nx; ++x, out += 4) {
                V value = hn::Zero(d);
                if (!all_air(seen, x, y, z)) {
                    const Children c = children(seen, x, y, z);
                    V texel[8];
                    for (int i = 0; i < 8; ++i) texel[i] = load(c.texel[i]);
                    value = composite(texel, face);
                }
                store(value, out);
            }
        }
    }
}

HWY_INLINE V premultiplied(const float* radiance, float opacity, float inverse_scale) {
    const D d;
    HWY_ALIGN float rgba[4] = {radiance[0] * inverse_scale, radiance[1] * inverse_scale, radiance[2] * inverse_scale, 1.0f};
    return hn::Mul(hn::Load(d, rgba), hn::Set(d, opacity));
}

/// A voxel, and its copies in the border.
HWY_INLINE void write_voxel(const LevelView& level, int x, int y, int z, V value) {
    store(value, level.texels + at(level, x, y, z));
    const bool inner = x > 0 && y > 0 && z > 0 && x + 1 < level.nx && y + 1 < level.ny && z + 1 < level.nz;
    if (inner) return;
    for (int bz = (z == 0 ? -1 : z); bz <= (z + 1 == level.nz ? z + 1 : z); ++bz)
        for (int by = (y == 0 ? -1 : y); by <= (y + 1 == level.ny ? y + 1 : y); ++by)
            for (int bx = (x == 0 ? -1 : x); bx <= (x + 1 == level.nx ? x + 1 : x); ++bx)
                store(value, level.texels + at(level, bx, by, bz));
}

/// Slices 2 z and 2 z + 1 of the finest level (with the border next to them): cleared, then written.
void write_slices(const LevelView& finest, const VoxelView& voxels, int z) {
    const int first = z == 0 ? -1 : 2 * z, last = 2 * z + 2 >= finest.nz ? finest.nz : 2 * z + 1;
    __builtin_memset(finest.texels + static_cast<std::size_t>(first + 1) * finest.slice, 0,
                     static_cast<std::size_t>(last - first + 1) * finest.slice * sizeof(std::uint16_t));
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) {
        const auto cell = static_cast<int>(voxels.cell[i]);
        const int line = cell / finest.nx;
        write_voxel(finest, cell % finest.nx, line % finest.ny, line / finest.ny,
                    premultiplied(voxels.radiance + 3 * i, voxels.opacity[i], voxels.inverse_scale));
    }
}

/// What one voxel shows through a face: its front, or its back where the front clearly faces away. Seen edge on (up to 17 degrees
/// beyond the silhouette), a surface still shows its front: at the grazing angles of a wall that is lit on one side, an eye on
/// that side sees nothing else.
HWY_INLINE V sided(const VoxelView& voxels, std::size_t i, int face) {
    const D d;
    const float outwards = voxels.normal[3 * i + static_cast<std::size_t>(face >> 1)] * ((face & 1) != 0 ? 1.0f : -1.0f);
    const float back = outwards >= -0.3f ? 0.0f : outwards <= -0.5f ? 1.0f : (-0.3f - outwards) * 5.0f;
    const V front_side = premultiplied(voxels.radiance + 3 * i, voxels.opacity[i], voxels.inverse_scale);
    if (back == 0.0f || voxels.back == nullptr) return front_side;
    const V back_side = premultiplied(voxels.back + 3 * i, voxels.opacity[i], voxels.inverse_scale);
    return hn::MulAdd(hn::Sub(back_side, front_side), hn::Set(d, back), front_side);
}

/// One slice of the second level's six faces, from the voxels themselves; `number` is scratch: 1 + voxel of every finest texel of
/// two slices, zero before and after.
void first_faces_slice(const LevelView& finest, const LevelView& coarse, const VoxelView& voxels, int z, std::uint32_t* number) {
    const D d;
    const int per_slice = finest.nx * finest.ny, base = 2 * z * per_slice;
    for (std::size_t i = voxels.begin; i < voxels.end; ++i)
        number[static_cast<int>(voxels.cell[i]) - base] = static_cast<std::uint32_t>(i + 1);
    for (int y = 0; y < coarse.ny; ++y)
        for (int x = 0; x < coarse.nx; ++x) {
            std::uint32_t child[8], any = 0;
            for (int i = 0; i < 8; ++i) {
                const int cx = 2 * x + (i & 1), cy = 2 * y + ((i >> 1) & 1), cz = i >> 2;
                const bool inside = cx < finest.nx && cy < finest.ny && 2 * z + cz < finest.nz;
                child[i] = inside ? number[cz * per_slice + cy * finest.nx + cx] : 0;
                any |= child[i];
            }
            for (int face = 0; face < 6; ++face) {
                V value = hn::Zero(d);
                if (any != 0) {
                    V texel[8];
                    for (int i = 0; i < 8; ++i) texel[i] = child[i] != 0 ? sided(voxels, child[i] - 1, face) : hn::Zero(d);
                    value = composite(texel, face);
                }
                store(value, coarse.texels + static_cast<std::size_t>(face) * coarse.volume + at(coarse, x, y, z));
            }
        }
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) number[static_cast<int>(voxels.cell[i]) - base] = 0;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "math/parallel.h"

namespace interreflect {
namespace {
HWY_EXPORT(reduce_slice);
HWY_EXPORT(reduce_slice_faces);
HWY_EXPORT(write_slices);
HWY_EXPORT(first_faces_slice);

LevelView view(Pyramid::Level& level) {
    return {level.texels.data(), level.size.x,      level.size.y,      level.size.z,
            level.row() * 4,     level.slice() * 4, level.volume() * 4};
}

/// The vectors as floats, three each; there may be none.
const float* floats(const Buffer<vec3>& vectors) { return reinterpret_cast<const float*>(vectors.data()); }

VoxelView view(const LitVoxels& lit, float scale) {
    const VoxelGrid& grid = *lit.grid;
    return {grid.cell.data(),    floats(lit.radiance), lit.back.empty() ? nullptr : floats(lit.back),
            floats(grid.normal), grid.opacity.data(),  0,
            grid.size(),         1.0f / scale};
}

/// The voxels in slices 2 z and 2 z + 1.
VoxelView slices_of(VoxelView voxels, const Domain& domain, int z) {
    const auto per_slice = static_cast<std::uint64_t>(domain.cells.x) * static_cast<std::uint64_t>(domain.cells.y);
    const auto first_of = [&](std::uint64_t slice) {
        const auto* end = voxels.cell + voxels.end;
        return static_cast<std::size_t>(std::lower_bound(voxels.cell, end, slice * per_slice) - voxels.cell);
    };
    const std::size_t begin = first_of(2 * static_cast<std::uint64_t>(z)), end = first_of(2 * static_cast<std::uint64_t>(z) + 2);
    voxels.begin = begin, voxels.end = end;
    return voxels;
}

/// Repeats the outermost texels of every slice in its border, and the outermost slices.
void fill_border(Pyramid::Level& level) {
    constexpr std::size_t texel = 4;
    const std::size_t row = level.row() * texel, slice = level.slice() * texel;
    for (int face = 0; face < level.faces; ++face) {
        std::uint16_t* volume = level.texels.data() + static_cast<std::size_t>(face) * level.volume() * texel;
        for (int z = 1; z <= level.size.z; ++z) {
            std::uint16_t* first = volume + static_cast<std::size_t>(z) * slice;
            for (int y = 1; y <= level.size.y; ++y) {
                std::uint16_t* line = first + static_cast<std::size_t>(y) * row;
                std::memcpy(line, line + texel, texel * sizeof(*line));
                std::memcpy(line + row - texel, line + row - 2 * texel, texel * sizeof(*line));
            }
            std::memcpy(first, first + row, row * sizeof(*first));
            std::memcpy(first + slice - row, first + slice - 2 * row, row * sizeof(*first));
        }
        const std::size_t last = static_cast<std::size_t>(level.size.z) + 1;
        std::memcpy(volume, volume + slice, slice * sizeof(*volume));
        std::memcpy(volume + last * slice, volume + (last - 1) * slice, slice * sizeof(*volume));
    }
}

/// The slices of one level in pieces worth a thread's while.
template <class Body>
void over_slices(const Pyramid::Level& level, const Body& body) {
    const std::size_t per_slice = static_cast<std::size_t>(level.size.x) * level.size.y * level.faces;
    const std::size_t block = std::max<std::size_t>(1, 4096 / per_slice);
    parallel_blocks(static_cast<std::size_t>(level.size.z), block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) body(static_cast<int>(z));
    });
}

}  // namespace

Pyramid make_levels(const Domain& domain, int faces) {
    Pyramid pyramid;
    pyramid.domain = domain;
    pyramid.faces = faces;
    for (ivec3 size = domain.cells;; size = (size + 1) / 2) {
        Pyramid::Level level;
        level.size = size;
        level.faces = pyramid.levels.empty() ? 1 : faces;
        level.texels = Buffer<std::uint16_t>(level.volume() * static_cast<std::size_t>(level.faces) * 4);
        pyramid.levels.push_back(std::move(level));
        if (size == ivec3(1)) return pyramid;
    }
}

float radiance_scale(const LitVoxels& lit) {
    float largest = 0.0f;
    for (const Buffer<vec3>* side : {&lit.radiance, &lit.back})
        for (const vec3& radiance : *side) {
            const float sum = radiance.x + radiance.y + radiance.z;
            if (!std::isfinite(sum)) throw std::invalid_argument("prefilter: a voxel's radiance is not finite");
            largest = std::max({largest, radiance.x, radiance.y, radiance.z});
        }
    if (!(largest > 0.0f)) return 1.0f;
    // Twice 2^-14 below the least float: its inverse must stay finite.
    return std::ldexp(1.0f, std::clamp(std::ilogb(largest), -110, 127) - 14);
}

Pyramid build_isotropic(Coverage coverage, const LitVoxels& lit) {
    Pyramid pyramid = make_levels(lit.grid->domain, 1);
    pyramid.scale = radiance_scale(lit);
    const VoxelView voxels = view(lit, pyramid.scale);
    const bool surface = coverage == Coverage::surface;
    const LevelView finest = view(pyramid.levels[0]);
    // The second level is reduced from slices that are still in the core's cache.
    const int pairs = (finest.nz + 1) / 2;
    parallel_pieces(static_cast<std::size_t>(pairs), [&](std::size_t piece) {
        const int z = static_cast<int>(piece);
        HWY_DYNAMIC_DISPATCH(write_slices)(finest, slices_of(voxels, pyramid.domain, z), z);
        if (pyramid.levels.size() > 1) HWY_DYNAMIC_DISPATCH(reduce_slice)(finest, view(pyramid.levels[1]), z, surface);
    });
    for (std::size_t i = 1; i < pyramid.levels.size(); ++i) {
        const LevelView coarse = view(pyramid.levels[i]);
        if (i > 1) {
            const LevelView fine = view(pyramid.levels[i - 1]);
            over_slices(pyramid.levels[i], [&](int z) { HWY_DYNAMIC_DISPATCH(reduce_slice)(fine, coarse, z, surface); });
        }
        fill_border(pyramid.levels[i]);
    }
    pyramid.counts.voxels = lit.grid->size();
    return pyramid;
}

Pyramid build_anisotropic(const LitVoxels& lit) {
    Pyramid pyramid = make_levels(lit.grid->domain, 6);
    pyramid.scale = radiance_scale(lit);
    const VoxelView voxels = view(lit, pyramid.scale);
    const LevelView finest = view(pyramid.levels[0]);
    const std::size_t per_pair = 2 * static_cast<std::size_t>(finest.nx) * static_cast<std::size_t>(finest.ny);
    parallel_pieces(static_cast<std::size_t>((finest.nz + 1) / 2), [&](std::size_t piece) {
        const int z = static_cast<int>(piece);
        const VoxelView inside = slices_of(voxels, pyramid.domain, z);
        HWY_DYNAMIC_DISPATCH(write_slices)(finest, inside, z);
        if (pyramid.levels.size() == 1) return;
        std::vector<std::uint32_t> number(per_pair, 0);
        HWY_DYNAMIC_DISPATCH(first_faces_slice)(finest, view(pyramid.levels[1]), inside, z, number.data());
    });
    for (std::size_t i = 1; i < pyramid.levels.size(); ++i) {
        const LevelView coarse = view(pyramid.levels[i]);
        if (i > 1) {
            const LevelView fine = view(pyramid.levels[i - 1]);
            over_slices(pyramid.levels[i], [&](int z) { HWY_DYNAMIC_DISPATCH(reduce_slice_faces)(fine, coarse, z); });
        }
        fill_border(pyramid.levels[i]);
    }
    pyramid.counts.voxels = lit.grid->size();
    return pyramid;
}

}  // namespace interreflect
#endif
