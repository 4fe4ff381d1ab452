#include "caches/interpolate/own_caches.h"

#include <algorithm>
#include <vector>

#include "caches/distribute/place.h"
#include "caches/interpolate/cache_reader.h"
#include "caches/interpolate/finish.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr std::size_t most_together = 8192;  // some 30 MB of maps of 16 x 16

ConvolvedCaches convolved_caches(const OwnCaches& own, std::span<const std::uint32_t> pixels, const GBuffer& gbuffer,
                                 const Scene& scene) {
    auto places = std::make_shared<CachePlaces>(tiles_of(gbuffer, 1));
    place_caches(gbuffer, pixels, std::vector<std::uint32_t>(pixels.size(), 1), *places);
    auto filled = std::make_shared<FilledCaches>(std::visit(
        [&](const auto& fill_by) { return fill(fill_by, places, own.pyramids, scene, own.intersector, own.seed); }, own.fill));
    return std::visit([&](const auto& by) { return preconvolve(by, filled); }, own.preconvolve);
}

}  // namespace

Counts light_by_own_caches(const OwnCaches& own, std::span<const std::uint32_t> pixels, const GBuffer& gbuffer,
                           const Scene& scene, CacheLight& light) {
    Counts counts;
    for (std::size_t begin = 0; begin < pixels.size(); begin += most_together) {
        const auto some = pixels.subspan(begin, std::min(most_together, pixels.size() - begin));
        const ConvolvedCaches caches = convolved_caches(own, some, gbuffer, scene);
        const PixelViewer viewer(gbuffer, scene, caches);
        const CacheReader reader(caches, gbuffer, scene);
        parallel_blocks(some.size(), PixelViews::capacity, [&](std::size_t first, std::size_t end) {
            thread_local PixelViews views;
            viewer.look(some.subspan(first, end - first), views);
            for (std::size_t i = first; i < end; ++i) {
                const PixelViews::View view = views.view(static_cast<int>(i - first));
                finish_pixel(caches, view, reader.read(i, view), light);
            }
        });
        counts += caches.filled->counts;
        counts.cache_evaluations += some.size();
    }
    return counts;
}

}  // namespace interreflect
