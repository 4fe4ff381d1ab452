/// Virtual lights: disks of lit surface that send light on, and what they see.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "data/buffer.h"
#include "data/counts.h"
#include "math/vectors.h"

namespace interreflect {

inline constexpr std::uint32_t no_virtual_light = std::numeric_limits<std::uint32_t>::max();

/// Texels of one light, chosen by their flux: where rays towards them end, off the surface, and their normals. Each stands for as
/// much flux as the others.
struct alignas(64) MemberPlaces {
    static constexpr int count = 16;
    float position[3][count];  // world space
    float normal[3][count];    // unit
};

/// In parallel arrays. Each is a disk that reflects diffusely, and stands for texels of reflective shadow maps, which follow each
/// other map by map, row by row.
struct VirtualLights {
    Buffer<vec3> position, normal;  // world space; unit
    Buffer<vec3> flux;              // sent on, W
    Buffer<float> area;             // scene units squared
    Buffer<float> offset;           // how far off the surface rays start (surface.h), scene units
    Buffer<std::uint32_t> texel;    // where it stands
    Buffer<std::uint32_t> members;  // texels that it stands for
    Buffer<std::uint32_t>
        cluster;                 // of every texel: its light, or no_virtual_light where the texel sends nothing on; KMeans' alone
    std::vector<int> map_sizes;  // texels on a side
    Buffer<MemberPlaces> places;  // of every light; none where lights stand for one texel each
    Counts counts;

    std::size_t size() const { return position.size(); }
    std::size_t bytes() const {
        return size() * (3 * sizeof(vec3) + 2 * sizeof(float) + 2 * sizeof(std::uint32_t)) + cluster.bytes() + places.bytes();
    }
};
inline VirtualLights make_virtual_lights(std::size_t n) {
    return {Buffer<vec3>(n),
            Buffer<vec3>(n),
            Buffer<vec3>(n),
            Buffer<float>(n),
            Buffer<float>(n),
            Buffer<std::uint32_t>(n),
            Buffer<std::uint32_t>(n),
            {},
            {},
            {},
            {}};
}

/// Points of a scene's surface that stand for it in shadow maps of virtual lights, spread evenly by area, in the space of the
/// instance that they move with.
struct SurfacePoints {
    Buffer<vec3> position, normal;   // unit
    Buffer<std::uint32_t> instance;  // of the geometry
    float area = 0;                  // of the whole surface as it was when they were made, scene units squared
    std::size_t instances = 0;       // of that geometry

    std::size_t size() const { return position.size(); }
    std::size_t bytes() const { return size() * (2 * sizeof(vec3) + sizeof(std::uint32_t)); }
};

/// What virtual lights see of a scene.
struct LightShadows {
    enum class Kind { unshadowed, traced, maps };
    Kind kind = Kind::unshadowed;
    int size = 0;  // texels of a map along each side
    Buffer<float>
        depth;  // radial distance, paraboloid maps (math/paraboloid_map.h) about Frame(normal), light by light; infinite: open
    float bias = 0;  // how much nearer something must be to cast a shadow, scene units
    Counts counts;

    std::size_t bytes() const { return depth.bytes(); }
};

}  // namespace interreflect
