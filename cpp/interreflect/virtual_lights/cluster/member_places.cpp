#include "virtual_lights/cluster/member_places.h"

#include <algorithm>
#include <cmath>

#include "virtual_lights/sample/texel_lights.h"

namespace interreflect {
namespace {

struct Member {
    const ReflectiveShadowMap* map;
    std::size_t texel;
    float flux;
};

/// Every so many texels along and across, moved sideways from row to row: about as many looks a cluster as make its places even.
constexpr double looks = 2.0 * MemberPlaces::count;

std::vector<std::vector<Member>> some_members(const LightMaps& maps, const Buffer<std::uint32_t>& cluster, std::size_t clusters) {
    std::vector<std::vector<Member>> found(clusters);
    const auto first = first_texels(maps);
    const auto step = static_cast<std::size_t>(
        std::max(1.0, std::floor(std::sqrt(static_cast<double>(cluster.size()) / (looks * static_cast<double>(clusters))))));
    for (std::size_t m = 0; m < maps.maps.size(); ++m) {
        const ReflectiveShadowMap& map = maps.maps[m];
        const auto side = static_cast<std::size_t>(map.size);
        for (std::size_t y = step / 2; y < side; y += step)
            for (std::size_t x = (y * 5 / 8) % step; x < side; x += step) {
                const std::size_t texel = y * side + x;
                const std::uint32_t c = cluster[first[m] + texel];
                if (c != no_virtual_light) found[c].push_back({&map, texel, luminance(map.flux[texel])});
            }
    }
    return found;
}

void set_place(MemberPlaces& places, int i, const ReflectiveShadowMap& map, std::size_t texel) {
    const vec3 at = map.position[texel] + map.normal[texel] * map.offset[texel];
    for (int k = 0; k < 3; ++k) places.position[k][i] = at[k], places.normal[k][i] = map.normal[texel][k];
}

/// At the middles of equal shares of the members' flux.
void spread(MemberPlaces& places, std::span<const Member> members) {
    float all = 0;
    for (const Member& member : members) all += member.flux;
    std::size_t at = 0;
    float passed = members[0].flux;
    for (int i = 0; i < MemberPlaces::count; ++i) {
        const float share = all * (static_cast<float>(i) + 0.5f) / static_cast<float>(MemberPlaces::count);
        while (passed < share && at + 1 < members.size()) passed += members[++at].flux;
        set_place(places, i, *members[at].map, members[at].texel);
    }
}

}  // namespace

Buffer<MemberPlaces> member_places(const LightMaps& maps, const Buffer<std::uint32_t>& cluster,
                                   std::span<const std::uint32_t> centres) {
    const auto found = some_members(maps, cluster, centres.size());
    const auto first = first_texels(maps);
    Buffer<MemberPlaces> places(centres.size());
    for (std::size_t c = 0; c < centres.size(); ++c) {
        if (!found[c].empty()) {
            spread(places[c], found[c]);
            continue;
        }
        const auto map = static_cast<std::size_t>(std::ranges::upper_bound(first, std::size_t{centres[c]}) - first.begin()) - 1;
        for (int i = 0; i < MemberPlaces::count; ++i) set_place(places[c], i, maps.maps[map], centres[c] - first[map]);
    }
    return places;
}

}  // namespace interreflect
