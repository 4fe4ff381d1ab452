#include "virtual_lights/sample/every_rsm_pixel.h"

#include "math/rng.h"
#include "virtual_lights/sample/texel_lights.h"

namespace interreflect {
namespace {

/// Numbers of all texels that send light on, map after map.
struct Senders {
    std::vector<std::size_t> map, texel;
};
Senders senders_of(const LightMaps& maps) {
    Senders all;
    for (std::size_t m = 0; m < maps.maps.size(); ++m)
        for (std::size_t i = 0; i < maps.maps[m].texels(); ++i)
            if (sends(maps.maps[m], i)) all.map.push_back(m), all.texel.push_back(i);
    return all;
}

}  // namespace

VirtualLights sample_lights(const EveryRsmPixel& technique, const LightMaps& maps, std::uint32_t seed) {
    const Senders all = senders_of(maps);
    const auto first = first_texels(maps);
    const bool every = technique.samples == 0 || all.map.empty();
    const std::size_t n = every ? all.map.size() : static_cast<std::size_t>(technique.samples);
    VirtualLights lights = make_virtual_lights(n);
    lights.map_sizes = sizes_of(maps);
    lights.counts.virtual_lights = n;
    if (every) {
        for (std::size_t i = 0; i < n; ++i)
            set_texel_light(lights, i, maps.maps[all.map[i]], all.texel[i], first[all.map[i]], 1.0f);
        return lights;
    }
    std::vector<double> below(all.map.size() + 1, 0.0);
    for (std::size_t i = 0; i < all.map.size(); ++i)
        below[i + 1] = below[i] + luminance(maps.maps[all.map[i]].flux[all.texel[i]]);
    // Systematic: one of every n-th of the flux, all shifted by one random number.
    const double step = below.back() / static_cast<double>(n), shift = Rng(seed, 0, 0x5a3du).uniform();
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double flux = (static_cast<double>(i) + shift) * step;
        while (at + 1 < all.map.size() && below[at + 1] <= flux) ++at;
        const double share = step / (below[at + 1] - below[at]);
        const ReflectiveShadowMap& map = maps.maps[all.map[at]];
        set_texel_light(lights, i, map, all.texel[at], first[all.map[at]], static_cast<float>(share));
        lights.area[i] = map.area[all.texel[at]];  // it stands for others, but is no larger than it is
    }
    return lights;
}

}  // namespace interreflect
