#include "visibility/kernel_material.h"

namespace interreflect {

std::vector<KernelMaterial> kernel_materials(const Scene& scene) {
    std::vector<KernelMaterial> table;
    for (const Material& material : scene.materials) {
        KernelMaterial entry;
        for (int c = 0; c < 3; ++c) entry.albedo[c] = material.albedo[c], entry.specular[c] = material.specular[c];
        entry.alpha = material.alpha;
        entry.two_sided = material.two_sided;
        entry.plain = !material.emits();
        if (material.albedo_map >= 0) {
            const Texture& texture = *scene.textures[material.albedo_map];
            if (texture.srgb_texels().empty()) entry.plain = false;
            entry.texels = texture.srgb_texels().data();
            entry.levels = texture.level_table().data();
            entry.level_count = texture.levels();
        }
        table.push_back(entry);
    }
    return table;
}

}  // namespace interreflect
