#include "caches/distribute/clustered.h"

#include "caches/distribute/cluster_tiles.h"
#include "caches/distribute/depth_slices.h"
#include "caches/distribute/normal_axes.h"

namespace interreflect {
namespace {

/// The signed axis, of three, to which a normal is nearest: 0 to 5.
std::uint32_t nearest_axis(const std::array<vec3, 3>& axes, const vec3& normal) {
    std::uint32_t nearest = 0;
    float most = -1.0f;
    for (std::uint32_t k = 0; k < 3; ++k) {
        const float along = glm::dot(axes[k], normal);
        if (std::fabs(along) > most) most = std::fabs(along), nearest = 2 * k + (along < 0.0f ? 1 : 0);
    }
    return nearest;
}

struct AdaptedKeys {
    const NormalAxes& axes;
    DepthSlices slices;

    auto of(const GBuffer& gbuffer, const Tile& tile) const {
        thread_local std::vector<float> histogram;
        histogram.assign(static_cast<std::size_t>(axes.count()), 0.0f);
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * gbuffer.width + x;
                if (gbuffer.hit(pixel)) histogram[static_cast<std::size_t>(axes.bin_of(gbuffer.normal[pixel]))] += 1.0f;
            }
        const std::array<vec3, 3> chosen = axes.choose(histogram);
        return [this, &gbuffer, chosen](std::size_t pixel) {
            return slices.of(gbuffer.depth[pixel]) * 6 + nearest_axis(chosen, gbuffer.normal[pixel]);
        };
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
