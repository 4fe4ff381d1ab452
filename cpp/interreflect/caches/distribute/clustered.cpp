#include "caches/distribute/clustered.h"

#include "caches/distribute/cluster_tiles.h"
#include "caches/distribute/depth_slices.h"
#include "caches/distribute/normal_axes.h"
#include "caches/distribute/tile_pixels.h"

namespace interreflect {
namespace {

struct AdaptedKeys {
    const NormalAxes& axes;
    DepthSlices slices;

    void fill(const TilePixels& pixels, std::uint32_t* key) const {
        thread_local std::vector<std::uint32_t> axis;
        const std::size_t count = pixels.count();
        axis.resize(with_room(count));
        const std::array<vec3, 3> chosen = axes_of(pixels);
        slices.of(pixels.depth.data(), count, key);
        nearest_axes(pixels.normal, count, chosen, axis.data());
        for (std::size_t i = 0; i < count; ++i) key[i] = key[i] == no_cache ? no_cache : 6 * key[i] + axis[i];
    }
    std::array<vec3, 3> axes_of(const TilePixels& pixels) const {
        thread_local std::vector<float> histogram;
        histogram.assign(static_cast<std::size_t>(axes.count()), 0.0f);
        count_normals(pixels.normal, pixels.depth.data(), pixels.count(), axes.bins(), histogram.data());
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
