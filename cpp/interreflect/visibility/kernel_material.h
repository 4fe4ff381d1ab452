/// Materials as vector kernels read them.
#pragma once
#include <vector>

#include "data/scene.h"

namespace interreflect {

struct KernelMaterial {
    float albedo[3], specular[3], alpha;
    bool two_sided = true;
    bool plain = true;                      // false: emits, or has a float texture; its hits are shaded one by one
    const std::uint32_t* texels = nullptr;  // sRGB texture of the albedo, or null
    const Texture::Level* levels = nullptr;
    int level_count = 0;
};

/// By number of material. They point into the scene's textures.
std::vector<KernelMaterial> kernel_materials(const Scene& scene);

}  // namespace interreflect
