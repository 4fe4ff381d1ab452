/// What a triangle looks like at its samples: shared by every technique that looks up the nearest texel.
#pragma once
#include "voxels/voxelize/contributions.h"
#include "voxels/voxelize/nearest_texel.h"

namespace interreflect {

/// What a triangle looks like at samples that stand for `area` (faces of a voxel) each.
struct Appearance {
    const VoxelTriangle& triangle;
    NearestTexel albedo_map, emission_map;

    Appearance(const VoxelTriangle& t, float area) : triangle(t) {
        if (t.albedo_map != nullptr) albedo_map.choose(*t.albedo_map, t.level(*t.albedo_map, area));
        if (t.emission_map != nullptr) emission_map.choose(*t.emission_map, t.level(*t.emission_map, area));
    }
    [[gnu::always_inline]] vec3 albedo(const vec2& uv) const {
        return albedo_map.chosen() ? triangle.material->albedo * albedo_map.at(uv) : triangle.material->albedo;
    }
    [[gnu::always_inline]] vec3 emission(const vec2& uv) const {
        return emission_map.chosen() ? triangle.material->emission * emission_map.at(uv) : triangle.material->emission;
    }
    [[gnu::always_inline]] bool solid(const vec2& uv) const { return triangle.mask == nullptr || triangle.mask->solid(uv); }
};

/// Longer edges, in voxels, are refused: single precision no longer knows in which voxel they lie.
constexpr float most_voxels = 0x1p20f;
void refuse_longer_than_most_voxels(float length);

}  // namespace interreflect
