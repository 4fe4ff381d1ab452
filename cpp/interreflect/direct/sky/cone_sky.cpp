#include "direct/sky/cone_sky.h"

#include <stdexcept>

#include "math/parallel.h"

namespace interreflect {

DirectLight sky(const ConeSky&, const GBuffer& g, std::span<const vec3> irradiance, std::span<const vec3> glossy) {
    if (irradiance.size() != g.pixels() || (!glossy.empty() && glossy.size() != g.pixels()))
        throw std::invalid_argument("ConeSky: the gathered light is of another size than the G-buffer");
    DirectLight result(g.width, g.height);
    parallel_blocks(g.pixels(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const vec3 diffuse = g.hit(i) ? g.albedo[i] * irradiance[i] / pi : vec3(0);
            result.radiance[i] = !glossy.empty() && g.hit(i) ? diffuse + glossy[i] : diffuse;
        }
    });
    return result;
}

}  // namespace interreflect
