#include "caches/distribute/cube_face_clustered.h"

#include "caches/distribute/cluster_tiles.h"
#include "caches/distribute/depth_slices.h"

namespace interreflect {
namespace {

struct CubeFaceKeys {
    int subdivisions;
    DepthSlices slices;

    /// Which cell of which face: the face of the longest axis, its other two coordinates cut evenly.
    std::uint32_t cell_of(const vec3& n) const {
        const vec3 size = glm::abs(n);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const float longest = size[axis] > 0.0f ? size[axis] : 1.0f;
        const auto cut = [&](float along) {
            return std::clamp(static_cast<int>((along / longest * 0.5f + 0.5f) * static_cast<float>(subdivisions)), 0,
                              subdivisions - 1);
        };
        const int face = 2 * axis + (n[axis] < 0.0f ? 1 : 0);
        return static_cast<std::uint32_t>((face * subdivisions + cut(n[(axis + 1) % 3])) * subdivisions + cut(n[(axis + 2) % 3]));
    }
    void fill(const TilePixels& pixels, std::uint32_t* key) const {
        const auto cells = static_cast<std::uint32_t>(6 * subdivisions * subdivisions);
        slices.of(pixels.depth.data(), pixels.count(), key);
        for (std::size_t i = 0; i < pixels.count(); ++i)
            if (key[i] != no_cache)
                key[i] = key[i] * cells + cell_of({pixels.normal[0][i], pixels.normal[1][i], pixels.normal[2][i]});
    }
};

}  // namespace

CachePlaces distribute(const CubeFaceClustered& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces*) {
    const float extent = scene_extent(scene);
    return cluster_picture(gbuffer, technique, [&](int tile) {
        return CubeFaceKeys{technique.subdivisions, DepthSlices(extent, tile_angle(gbuffer, tile), technique.slice_depth)};
    });
}

}  // namespace interreflect
