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
    void fill(const GBuffer& gbuffer, const Tile& tile, std::uint32_t* key) const {
        const auto cells = static_cast<std::uint32_t>(6 * subdivisions * subdivisions);
        const auto columns = static_cast<std::size_t>(tile.x1 - tile.x0);
        for (int y = tile.y0; y < tile.y1; ++y, key += columns) {
            const std::size_t first = static_cast<std::size_t>(y) * gbuffer.width + tile.x0;
            slices.of(gbuffer.depth.data() + first, columns, key);
            for (std::size_t x = 0; x < columns; ++x)
                if (key[x] != no_cache) key[x] = key[x] * cells + cell_of(gbuffer.normal[first + x]);
        }
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
