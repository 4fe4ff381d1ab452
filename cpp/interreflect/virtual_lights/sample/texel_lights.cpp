#include "virtual_lights/sample/texel_lights.h"

namespace interreflect {

void set_texel_light(VirtualLights& lights, std::size_t light, const ReflectiveShadowMap& map, std::size_t texel,
                     std::size_t first_of_map, float share) {
    lights.position[light] = map.position[texel];
    lights.normal[light] = map.normal[texel];
    lights.flux[light] = map.flux[texel] * share;
    lights.area[light] = map.area[texel] * share;
    lights.offset[light] = map.offset[texel];
    lights.texel[light] = static_cast<std::uint32_t>(first_of_map + texel);
    lights.members[light] = 1;
}

std::vector<std::size_t> first_texels(const LightMaps& maps) {
    std::vector<std::size_t> first{0};
    for (const auto& map : maps.maps) first.push_back(first.back() + map.texels());
    return first;
}

std::vector<int> sizes_of(const LightMaps& maps) {
    std::vector<int> sizes;
    for (const auto& map : maps.maps) sizes.push_back(map.size);
    return sizes;
}

}  // namespace interreflect
