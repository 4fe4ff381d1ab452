/// Radiance caches: where they stand, what arrives there, and the same convolved with lobes.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "data/buffer.h"
#include "data/camera.h"
#include "data/counts.h"
#include "math/vectors.h"

namespace interreflect {

inline constexpr std::uint32_t no_cache = std::numeric_limits<std::uint32_t>::max();

/// Points of the picture where radiance is gathered for the pixels around them: caches in the order of their tiles (row by row),
/// in parallel arrays. Each was placed for a cluster of pixels of its tile.
struct CachePlaces {
    int width = 0, height = 0;         // of the picture
    int tile = 1;                      // pixels on a side
    int columns = 0, rows = 0;         // of tiles
    Buffer<vec3> position;             // of the surface, world space
    Buffer<vec3> normal;               // unit: the hemisphere's axis, the surface's shading normal
    Buffer<vec3> geometric_normal;     // unit
    Buffer<vec2> screen;               // where each is seen, pixels from the upper left corner
    Buffer<float> footprint;           // how long a tile is on the surface there (tile_footprint), scene units
    Buffer<float> offset;              // how far off the surface rays start (surface.h), scene units
    Buffer<std::uint32_t> body;        // 0 is "world"
    Buffer<std::uint32_t> pixel;       // the pixel that was chosen, or where a reused one is seen: row * width + column
    Buffer<std::uint32_t> members;     // pixels of its cluster
    std::vector<std::uint32_t> first;  // caches of tile t: first[t] up to first[t + 1]
    Buffer<std::uint32_t> cluster;     // of each pixel: the cache of its cluster; no_cache where nothing was hit, or none stands
    /// By what the next frame finds them again.
    struct Track {
        Camera camera;
        std::vector<mat4x3> poses;       // of every instance of the scene: world_from_local
        Buffer<std::uint32_t> instance;  // that each stands on
        Buffer<std::uint32_t> age;       // frames that it has been kept; 0: placed in this one
        std::size_t bytes() const { return poses.size() * sizeof(mat4x3) + instance.bytes() + age.bytes(); }
    };
    std::optional<Track> track;  // of ReuseCaches alone
    Counts counts;

    std::size_t size() const { return position.size(); }
    std::size_t bytes() const {
        return size() * (3 * sizeof(vec3) + sizeof(vec2) + 2 * sizeof(float) + 3 * sizeof(std::uint32_t)) +
               first.size() * sizeof(std::uint32_t) + cluster.bytes() + (track ? track->bytes() : 0);
    }
};

/// The radiance that arrives at caches, as hemisphere maps (math/hemisphere_map.h) about their normals, in Frame(normal).
///
/// A texel is four half floats R G B A: mean radiance over it, divided by `scale`, and the share of it that meets nothing; where
/// directions within it are told apart, they count by their cosine to the normal as all that a surface reflects does. Maps follow
/// each other cache by cache, row by row.
struct FilledCaches {
    std::shared_ptr<const CachePlaces> places;
    int resolution = 0;  // texels on a side
    float scale = 1.0f;  // radiance = texel * scale, W/(m^2 sr)
    Buffer<std::uint16_t> texels;
    Buffer<std::uint16_t> sky;  // radiance of an environment image through what is open, over `sky_scale`; empty without one
    float sky_scale = 1.0f;     // dark surfaces under a bright sky have another range than it
    vec3 sky_radiance{0};       // of a constant environment
    Counts counts;

    std::size_t texels_each() const { return static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution); }
    std::size_t bytes() const { return texels.bytes() + sky.bytes(); }
};

/// How wide a lobe is taken to be when a level is chosen for it.
enum class LobeWidth { one_percent, resultant };

/// Filled caches ready for lobes of every width: a chain of ever coarser maps and a table of the cosine lobe; or neither, where
/// lobes are integrated over the filled maps by `samples` directions.
struct ConvolvedCaches {
    std::shared_ptr<const FilledCaches> filled;
    int samples = 0;                // of each lobe; 0: by levels
    std::vector<int> level_sizes;   // texels on a side of level 0 (the filled map), 1, ... down to 1
    std::vector<int> level_begins;  // of level i in a cache's chain, texels; level 0 is not stored again
    int chain_texels = 0;           // of one cache's chain
    int table_size = 0;             // texels on a side of the cosine table
    LobeWidth width = LobeWidth::one_percent;
    float level_bias = 0;
    struct Layer {
        Buffer<std::uint16_t> chain;  // levels 1 and on of every cache
        Buffer<std::uint16_t> table;  // mean over the hemisphere about the texel's direction, weighted by the cosine, as texels
    };
    Layer light, sky;
    Counts counts;

    int levels() const { return static_cast<int>(level_sizes.size()); }
    std::size_t bytes() const { return light.chain.bytes() + light.table.bytes() + sky.chain.bytes() + sky.table.bytes(); }
};

}  // namespace interreflect
