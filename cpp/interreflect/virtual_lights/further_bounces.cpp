#include "virtual_lights/further_bounces.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace interreflect {

LightMaps bounce_maps(const Scene& scene, const Intersector& intersector, const VirtualLights& lights, int size) {
    if (size < 1) throw std::invalid_argument("size must be at least 1 texel, got " + std::to_string(size));
    LightMaps result;
    const double views = static_cast<double>(std::max<std::size_t>(lights.size(), 1));
    const int each = std::max(1, static_cast<int>(std::lround(static_cast<double>(size) / std::sqrt(views))));
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const DiskView disk{lights.position[i], lights.normal[i], lights.flux[i], lights.offset[i]};
        result.maps.push_back(reflective_shadow_map(scene, intersector, disk, each));
        result.counts += result.maps.back().counts;
    }
    return result;
}

VirtualLights join_lights(std::span<const VirtualLights* const> lists) {
    std::size_t n = 0;
    std::size_t places = 0;
    for (const auto* list : lists) n += list->size(), places += list->places.size();
    if (places != 0 && places != n)
        throw std::invalid_argument("join_lights: some lights stand for many texels, and others for one each");
    VirtualLights joined = make_virtual_lights(n);
    joined.places = Buffer<MemberPlaces>(places);
    std::size_t to = 0;
    for (const auto* list : lists) {
        const auto copy = [to](const auto& from, auto& into) { std::ranges::copy(from, into.begin() + to); };
        copy(list->position, joined.position), copy(list->normal, joined.normal), copy(list->flux, joined.flux);
        copy(list->area, joined.area), copy(list->offset, joined.offset);
        copy(list->texel, joined.texel), copy(list->members, joined.members);
        if (places > 0) copy(list->places, joined.places);
        to += list->size();
    }
    return joined;
}

}  // namespace interreflect
