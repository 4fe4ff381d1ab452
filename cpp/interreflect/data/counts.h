/// Work counts: they compare across machines where milliseconds do not.
#pragma once
#include <cstdint>
#include <string_view>

namespace interreflect {

struct Counts {
    std::uint64_t rays = 0;               // nearest-hit rays
    std::uint64_t shadow_rays = 0;        // any-hit rays
    std::uint64_t paths = 0;              // camera paths
    std::uint64_t samples = 0;            // surface samples taken to voxelize
    std::uint64_t voxels = 0;             // voxels written
    std::uint64_t cones = 0;              // cones marched
    std::uint64_t cone_steps = 0;         // steps of all cones
    std::uint64_t voxel_fetches = 0;      // filtered look-ups of the voxel pyramid
    std::uint64_t clusters = 0;           // of pixels
    std::uint64_t caches = 0;             // placed or filled
    std::uint64_t reused_caches = 0;      // of those, kept from the last frame
    std::uint64_t cache_evaluations = 0;  // of a cache for a pixel, with a weight above 0
    std::uint64_t covered_pixels = 0;     // whose caches' weights sum up to more than 0
    std::uint64_t uncovered_pixels = 0;   // the other ones that see a surface
    std::uint64_t virtual_lights = 0;     // made
    std::uint64_t stray_texels = 0;       // of reflective shadow maps, that no cluster's splat covered
    std::uint64_t reseeded_lights = 0;    // clusters that lost all their texels and began anew
    std::uint64_t surface_points = 0;     // drawn into shadow maps
    std::uint64_t empty_texels = 0;       // of shadow maps, that no point was drawn into
    std::uint64_t filled_texels = 0;      // of those, filled from coarser levels
    std::uint64_t light_evaluations = 0;  // of a virtual light for a pixel that it reaches
    std::uint64_t shadow_lookups = 0;     // of shadow maps
    std::uint64_t links = 0;              // from patches of surfels to caches: made, or summed up

    Counts& operator+=(const Counts& other);
};

struct NamedCount {
    std::string_view name;
    std::uint64_t Counts::*member;
};
/// All of them, in order.
inline constexpr NamedCount every_count[] = {
    {"rays", &Counts::rays},
    {"shadow_rays", &Counts::shadow_rays},
    {"paths", &Counts::paths},
    {"samples", &Counts::samples},
    {"voxels", &Counts::voxels},
    {"cones", &Counts::cones},
    {"cone_steps", &Counts::cone_steps},
    {"voxel_fetches", &Counts::voxel_fetches},
    {"clusters", &Counts::clusters},
    {"caches", &Counts::caches},
    {"reused_caches", &Counts::reused_caches},
    {"cache_evaluations", &Counts::cache_evaluations},
    {"covered_pixels", &Counts::covered_pixels},
    {"uncovered_pixels", &Counts::uncovered_pixels},
    {"virtual_lights", &Counts::virtual_lights},
    {"stray_texels", &Counts::stray_texels},
    {"reseeded_lights", &Counts::reseeded_lights},
    {"surface_points", &Counts::surface_points},
    {"empty_texels", &Counts::empty_texels},
    {"filled_texels", &Counts::filled_texels},
    {"light_evaluations", &Counts::light_evaluations},
    {"shadow_lookups", &Counts::shadow_lookups},
    {"links", &Counts::links},
};
static_assert(sizeof(every_count) / sizeof(NamedCount) == sizeof(Counts) / sizeof(std::uint64_t));

inline Counts& Counts::operator+=(const Counts& other) {
    for (const NamedCount& count : every_count) this->*count.member += other.*count.member;
    return *this;
}

}  // namespace interreflect
