#include "shading/shade.h"

#include <stdexcept>

#include "math/parallel.h"

namespace interreflect {

Buffer<vec3> shade(const GBuffer& gbuffer, const GatheredLight& light, const GlossyLight* glossy) {
    if (light.width != gbuffer.width || light.height != gbuffer.height)
        throw std::invalid_argument("shade: light was gathered for a picture of another size");
    if (glossy != nullptr && (glossy->width != gbuffer.width || glossy->height != gbuffer.height))
        throw std::invalid_argument("shade: glossy light belongs to a picture of another size");
    Buffer<vec3> image(gbuffer.pixels());
    parallel_blocks(gbuffer.pixels(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            image[i] = gbuffer.hit(i) ? gbuffer.albedo[i] * light.irradiance[i] / pi : vec3(0);
            if (glossy != nullptr) image[i] += glossy->radiance[i];
        }
    });
    return image;
}

}  // namespace interreflect
