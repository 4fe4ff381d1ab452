#include "surfels/light_caches.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"
#include "surfels/light_kernel.h"

namespace interreflect {
namespace {

constexpr std::size_t caches_a_block = 64, most_lanes = 16;

}  // namespace

void check_links(const CacheLinks& links, const NodeLight& light) {
    if (links.nodes != light.size())
        throw std::invalid_argument("links into a tree of " + std::to_string(links.nodes) + " nodes, light of " +
                                    std::to_string(light.size()));
    if (links.radiosity != light.radiosity)
        throw std::invalid_argument(links.radiosity ? "these links take radiosity, not flux"
                                                    : "these links take flux, not radiosity");
}

LightCaches make_light_caches(std::size_t caches, const CacheFormat& format) {
    const int chrominance = format.chrominance_bands == 0 ? format.bands : format.chrominance_bands;
    if (format.bands < 1 || format.bands > most_bands)
        throw std::invalid_argument("bands must lie in [1, 8], got " + std::to_string(format.bands));
    if (chrominance < 1 || chrominance > format.bands)
        throw std::invalid_argument("chrominance_bands must lie in [0, " + std::to_string(format.bands) + "], got " +
                                    std::to_string(format.chrominance_bands));
    LightCaches made;
    made.bands = format.bands, made.chrominance_bands = chrominance;
    made.ycocg = chrominance < format.bands;
    made.caches = caches;
    made.coefficients = Buffer<std::uint16_t>(caches * static_cast<std::size_t>(made.stride()) + most_lanes, std::uint16_t{0});
    made.unit = Buffer<float>(caches);
    return made;
}

LightCaches light_caches(const CacheLinks& links, const NodeLight& light, const CacheFormat& format,
                         std::span<const std::uint8_t> used) {
    LightCaches made = make_light_caches(links.caches, format);
    check_links(links, light);
    if (links.kind == CacheLinks::Kind::projected && links.bands < format.bands)
        throw std::invalid_argument("light_caches: links of " + std::to_string(links.bands) + " bands for caches of " +
                                    std::to_string(format.bands));
    if (!used.empty() && used.size() != links.caches)
        throw std::invalid_argument("light_caches: `used` tells of " + std::to_string(used.size()) +
                                    " caches, the links are of " + std::to_string(links.caches));
    const auto light_run = links.kind == CacheLinks::Kind::projected ? light_projected : light_cones;
    std::vector<std::uint64_t> lit((links.caches + caches_a_block - 1) / caches_a_block);
    parallel_blocks(links.caches, caches_a_block, [&](std::size_t begin, std::size_t end) {
        const auto is_read = [&](std::size_t cache) { return used.empty() || used[cache] != 0; };
        for (std::size_t first = begin; first < end;) {
            std::size_t last = first;
            while (last < end && is_read(last) == is_read(first)) ++last;
            if (is_read(first)) {
                light_run(links, light, first, last, made);
                lit[begin / caches_a_block] += last - first;
            } else {
                const auto stride = static_cast<std::size_t>(made.stride());
                std::fill(made.coefficients.data() + first * stride, made.coefficients.data() + last * stride, std::uint16_t{0});
                std::fill(made.unit.data() + first, made.unit.data() + last, 1.0f);
            }
            first = last;
        }
    });
    const auto each = static_cast<std::uint64_t>(links.per_cache);
    for (const std::uint64_t caches : lit) made.counts.links += caches * each;
    return made;
}

}  // namespace interreflect
