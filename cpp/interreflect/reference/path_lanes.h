/// The paths of one tile between two steps, side by side: what the vector kernels of the path tracer read and write.
#pragma once
#include <cstdint>

#include "math/vectors.h"
#include "visibility/surface_kernel.h"

namespace interreflect {

inline constexpr int tracing_tile = 32;
inline constexpr int tracing_tile_pixels = tracing_tile * tracing_tile;

// One packet more than there can be paths: vectors are stored whole.
inline constexpr int most_lanes = tracing_tile_pixels + RayPacket::width;
using FloatColumn = float[most_lanes];
using NumberColumn = std::uint32_t[most_lanes];

struct alignas(64) Column3 {
    FloatColumn x, y, z;

    vec3 at(std::uint32_t i) const { return {x[i], y[i], z[i]}; }
    void set(std::uint32_t i, const vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

/// Paths at a vertex.
struct alignas(64) PathLanes {
    std::uint32_t count = 0;
    bool any_lobe = false;
    Column3 position{}, geometric_normal{}, normal{}, albedo{};
    Column3 direction{}, throughput{};  // direction: of travel, towards the vertex
    FloatColumn offset{};
    NumberColumn lobe{}, pixel{}, pattern{};  // lobe: as in SurfacePacket

    void clear() { count = 0, any_lobe = false; }
    /// The surface of one path, for what is not done in vectors.
    SurfacePoint surface(std::uint32_t i, std::span<const Material> materials) const;
};

/// The rays that go on from them.
struct alignas(64) StepLanes {
    std::uint32_t count = 0;
    Column3 origin{}, direction{}, throughput{};
    FloatColumn pdf{};
    NumberColumn path{}, pixel{}, pattern{};  // path: the number of the path that the ray leaves
};

/// Rays towards lights, and what each adds where nothing is in its way.
struct alignas(64) ShadowLanes {
    std::uint32_t count = 0;
    Column3 origin{}, direction{}, light{};
    FloatColumn far{};
    NumberColumn pixel{};
};

/// A pair of random numbers for each pattern of pixels.
struct alignas(64) PairTable {
    FloatColumn x, y;
};

}  // namespace interreflect
