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

/// A red of -0 marks a texel of which nothing that light falls on faces an eye looking along the octant: the inside of a solid,
/// or a wall seen from beyond the scene. It stays opaque and black, but hides nothing of its neighbours in a coarser texel.
HWY_INLINE V hidden_mark() {
    HWY_ALIGN constexpr float texel[4] = {-0.0f, 0, 0, 0};
    return hn::Load(D(), texel);
}
HWY_INLINE bool hidden(const std::uint16_t* texel) { return texel[0] == 0x8000U; }

/// Eight texels, those that are hidden zero, as an eye looking along an octant sees them: the mean of three axes, made as opaque
/// as surface coverage has it.
HWY_INLINE V octant_colour(const V* texel, int octant, V opacity) {
    const D d;
    const auto face = [octant](int axis) { return 2 * axis + ((octant >> axis & 1) != 0 ? 0 : 1); };
    const V seen = hn::Add(hn::Add(composite(texel, face(0)), composite(texel, face(1))), composite(texel, face(2)));
    HWY_ALIGN constexpr float alpha[4] = {0, 0, 0, 1};
    if (!(hn::GetLane(alpha_of(seen)) > 0.0f)) return hn::Or(hn::Mul(opacity, hn::Load(d, alpha)), hidden_mark());
    return hn::Mul(seen, hn::Div(opacity, alpha_of(seen)));
}

void reduce_slice_octants(const LevelView& fine, const LevelView& coarse, int z) {
    const D d;
    for (int y = 0; y < coarse.ny; ++y)
        for (int x = 0; x < coarse.nx; ++x) {
            std::uint16_t* out = coarse.texels + at(coarse, x, y, z);
            const bool empty = all_air(fine, x, y, z);
            for (int octant = 0; octant < 8; ++octant, out += coarse.volume) {
                if (empty) {
                    store(hn::Zero(d), out);
                    continue;
                }
                LevelView seen = fine;
                seen.texels += static_cast<std::size_t>(octant) * fine.volume;
                const Children c = children(seen, x, y, z);
                V texel[8], sum = hn::Zero(d);
                for (int i = 0; i < 8; ++i) {
                    texel[i] = load(c.texel[i]);
                    sum = hn::Add(sum, texel[i]);
                    if (hidden(c.texel[i])) texel[i] = hn::Zero(d);
                }
                const V opacity = hn::Min(hn::Mul(alpha_of(sum), hn::Set(d, 0.25f)), hn::Set(d, 1.0f));
                store(octant_colour(texel, octant, opacity), out);
            }
        }
}

/// What one voxel shows to eyes that look along an octant: its front and its back as far as they face them. A back that no light
/// falls on is the inside of a solid rather than anything to be seen, wherever some of the front faces the octant.
struct Sides {
    V front, back;
    vec3 normal;
    bool back_lit;

    HWY_INLINE V seen(unsigned octant) const {
        float facing = 0, away = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const float along = (octant >> axis & 1U) != 0 ? normal[axis] : -normal[axis];
            (along < 0.0f ? facing : away) += along < 0.0f ? -along : along;
        }
        const float share = facing + away > 0.0f ? facing / (facing + away) : 1.0f;
        if (!back_lit) return share > 0.25f ? front : back;
        return hn::MulAdd(hn::Sub(front, back), hn::Set(D(), share), back);
    }
};
HWY_INLINE Sides sides_of(const VoxelView& voxels, std::size_t i) {
    const V front = premultiplied(voxels.radiance + 3 * i, voxels.opacity[i], voxels.inverse_scale);
    if (voxels.back == nullptr) return {front, front, vec3(0), false};
    const float* radiance = voxels.back + 3 * i;
    const V back = premultiplied(radiance, voxels.opacity[i], voxels.inverse_scale);
    const bool lit = radiance[0] > 0.0f || radiance[1] > 0.0f || radiance[2] > 0.0f;
    return {front, lit ? back : hn::Or(back, hidden_mark()), voxels.points[i].normal, lit};
}

/// Slices 2 z and 2 z + 1 of the finest level's eight octants.
void write_slices_octants(const LevelView& finest, const VoxelView& voxels, int z) {
    VoxelView none = voxels;
    none.end = none.begin;
    LevelView octants[8];
    for (std::size_t octant = 0; octant < 8; ++octant) {
        octants[octant] = finest;
        octants[octant].texels += octant * finest.volume;
        write_slices(octants[octant], none, z);
    }
    for (std::size_t i = voxels.begin; i < voxels.end; ++i) {
        const auto cell = static_cast<int>(voxels.cell[i]);
        const int line = cell / finest.nx;
        const Sides sides = sides_of(voxels, i);
        for (unsigned octant = 0; octant < 8; ++octant)
            write_voxel(octants[octant], cell % finest.nx, line % finest.ny, line / finest.ny, sides.seen(octant));
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "math/parallel.h"

namespace interreflect {
namespace {
HWY_EXPORT(reduce_slice_octants);
HWY_EXPORT(write_slices_octants);
}  // namespace

Pyramid build_octants(const LitVoxels& lit) {
    Pyramid pyramid = make_levels(lit.grid->domain, 8);
    pyramid.scale = radiance_scale(lit);
    const VoxelView voxels = view(lit, pyramid.scale);
    const LevelView finest = view(pyramid.levels[0]);
    parallel_pieces(static_cast<std::size_t>((finest.nz + 1) / 2), [&](std::size_t piece) {
        const int z = static_cast<int>(piece);
        HWY_DYNAMIC_DISPATCH(write_slices_octants)(finest, slices_of(voxels, pyramid.domain, z), z);
        if (pyramid.levels.size() > 1) HWY_DYNAMIC_DISPATCH(reduce_slice_octants)(finest, view(pyramid.levels[1]), z);
    });
    for (std::size_t i = 1; i < pyramid.levels.size(); ++i) {
        const LevelView coarse = view(pyramid.levels[i]);
        if (i > 1) {
            const LevelView fine = view(pyramid.levels[i - 1]);
            over_slices(pyramid.levels[i], [&](int z) { HWY_DYNAMIC_DISPATCH(reduce_slice_octants)(fine, coarse, z); });
        }
        fill_border(pyramid.levels[i]);
    }
    pyramid.counts.voxels = lit.grid->size();
    return pyramid;
}

}  // namespace interreflect
#endif
