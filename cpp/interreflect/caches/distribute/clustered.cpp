#include "caches/distribute/clustered.h"

#include "caches/distribute/cluster_tiles.h"
#include "caches/distribute/depth_slices.h"
#include "caches/distribute/normal_axes.h"
#include "caches/distribute/tile_kernels.h"

namespace interreflect {
namespace {

struct AdaptedKeys {
    const NormalAxes& axes;
    DepthSlices slices;

    void fill(const GBuffer& gbuffer, const Tile& tile, std::uint32_t* key) const {
        const std::array<vec3, 3> chosen = axes_of(gbuffer, tile);
        thread_local std::vector<std::uint32_t> axis;
        axis.resize(static_cast<std::size_t>(tile.x1 - tile.x0));
        for (int y = tile.y0; y < tile.y1; ++y, key += axis.size()) {
            const std::size_t first = static_cast<std::size_t>(y) * gbuffer.width + tile.x0;
            slices.of(gbuffer.depth.data() + first, axis.size(), key);
            nearest_axes(gbuffer.normal.data() + first, axis.size(), chosen, axis.data());
            for (std::size_t x = 0; x < axis.size(); ++x) key[x] = key[x] == no_cache ? no_cache : 6 * key[x] + axis[x];
        }
    }
    std::array<vec3, 3> axes_of(const GBuffer& gbuffer, const Tile& tile) const {
        thread_local std::vector<float> histogram;
        thread_local std::vector<std::uint32_t> bin;
        histogram.assign(static_cast<std::size_t>(axes.count()), 0.0f);
        bin.resize(static_cast<std::size_t>(tile.x1 - tile.x0));
        for (int y = tile.y0; y < tile.y1; ++y) {
            const std::size_t first = static_cast<std::size_t>(y) * gbuffer.width + tile.x0;
            bin_normals(gbuffer.normal.data() + first, bin.size(), axes.bins(), bin.data());
            for (std::size_t x = 0; x < bin.size(); ++x) histogram[bin[x]] += gbuffer.hit(first + x) ? 1.0f : 0.0f;
        }
        return axes.choose(histogram);
    }
};

}  // namespace

CachePlaces distribute(const Clustered& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces*) {
    const NormalAxes axes(technique.bins, static_cast<float>(technique.smoothing) * degrees_to_radians,
                          static_cast<float>(technique.exponent));
    const float extent = scene_extent(scene);
    return cluster_picture(gbuffer, technique, [&](int tile) {
        return AdaptedKeys{axes, DepthSlices(extent, tile_angle(gbuffer, tile), technique.slice_depth)};
    });
}

}  // namespace interreflect
