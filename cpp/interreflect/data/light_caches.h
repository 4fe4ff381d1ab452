/// Caches of incident radiance in spherical harmonics: where they stand, what they are linked to, and the light in them.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "data/buffer.h"
#include "data/counts.h"
#include "data/geometry.h"
#include "math/vectors.h"

namespace interreflect {

inline constexpr std::uint32_t no_cache = std::numeric_limits<std::uint32_t>::max();
inline constexpr int most_bands = 8;
/// Of so many bands, in one channel.
inline constexpr std::size_t coefficients_of(int bands) {
    return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

inline constexpr std::uint32_t no_chart = std::numeric_limits<std::uint32_t>::max();

/// Where the light map lies on a triangle. Rows: its texel coordinates as affine functions of the position in world space, and
/// its front's normal, of any length; column by column, so that a position takes four multiply-adds of four lanes.
struct alignas(64) ChartPlane {
    vec4 column[4];
};

/// Texels of a square map over the still surface that have caches.
struct LightMapSites {
    int size = 0;                    // texels on a side; 0: there is no map
    Buffer<std::uint32_t> cache;     // of every texel, row by row from v = 0; no_cache where none lies near
    Buffer<std::uint32_t> triangle;  // those with charts, global numbers
    Buffer<vec2> texcoord;           // of their corners, three each, in texels
    Buffer<ChartPlane> planes;       // of each of them; follows from its corners
    Buffer<std::uint32_t> plane_of;  // of every triangle of the scene: the number of its plane, or no_chart

    std::size_t bytes() const { return cache.bytes() + triangle.bytes() + texcoord.bytes() + planes.bytes() + plane_of.bytes(); }
};
/// A box of caches, x fastest; or several of them over each other, each with half as many cells along an axis as the one before.
struct GridSites {
    ivec3 size{0};  // caches along each axis of the finest level; 0: there is no grid
    Bounds box{};
    Buffer<std::uint32_t> cache;    // of every cell, from the finest level on; no_cache inside of solids
    Buffer<std::uint32_t> nearest;  // of every cell: its own, or that of its level's nearest that has one, by steps between cells
    int levels = 1;
    float reach = 0;  // how far from the camera pixels read the finest level, scene units; each next one reaches twice as far
    float normal_offset = 0;  // how far along their geometric normals pixels look, cells

    ivec3 size_of(int level) const { return (size + ((1 << level) - 1)) / (1 << level); }
    std::size_t cells_of(int level) const {
        const ivec3 n = size_of(level);
        return static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z);
    }
    /// Cells of the levels before one.
    std::size_t first_of(int level) const {
        std::size_t first = 0;
        for (int l = 0; l < level; ++l) first += cells_of(l);
        return first;
    }
};
inline constexpr int most_grid_levels = 8;

struct CacheSites {
    Buffer<vec3> position;  // world space
    Buffer<vec3> normal;    // unit: light comes over that hemisphere; (0, 0, 0): from everywhere
    Buffer<float> offset;   // how far off the surface rays start, scene units
    LightMapSites map;
    GridSites grid;
    bool pixels = false;  // one for every pixel that sees a surface, in order
    Counts counts;

    std::size_t size() const { return position.size(); }
    std::size_t bytes() const {
        return position.bytes() + normal.bytes() + offset.bytes() + map.bytes() + grid.cache.bytes() + grid.nearest.bytes();
    }
};

/// One light path to a cache in 12 bytes.
struct ConeLink {
    std::uint32_t node;
    std::uint16_t factor;        // half float: 1 / (pi area), over the unit of the links
    std::uint16_t one_less_cos;  // half float: 1 - cosine of the half angle
    std::uint16_t x, y;          // octahedral direction from the cache, over the unit square
};
static_assert(sizeof(ConeLink) == 12);

/// Which nodes of the tree send light to each cache: `per_cache` of them, one cache after the other; places without one have
/// coefficients 0.
struct CacheLinks {
    enum class Kind { projected, cones };
    Kind kind = Kind::projected;
    int per_cache = 0;
    int bands = 0;           // of the projected coefficients; 0: of cones
    bool radiosity = false;  // what the nodes' light must be: flux, or radiosity
    float unit = 1.0f;       // what coefficients are multiples of, 1 / scene units squared
    std::size_t caches = 0;
    Buffer<std::uint32_t> node;          // projected: of every link
    Buffer<std::uint16_t> coefficients;  // projected: bands^2 half floats a link, (1/pi) integral of V y over the area
    Buffer<ConeLink> cones;
    std::uint64_t nodes = 0;  // of the tree that they point into
    Counts counts;

    std::size_t bytes() const { return node.bytes() + coefficients.bytes() + cones.bytes(); }
};

/// What frames choose links from: of every cache a binary tree of cones, the root first, children side by side.
struct LinkCandidates {
    CacheLinks nodes;             // cones; places without one have factor 0
    Buffer<std::uint16_t> child;  // of each node: place of the first of its two children among the cache's; 0: it has none

    std::size_t bytes() const { return nodes.bytes() + child.bytes(); }
};

/// Incident radiance of every cache: coefficients of luma (or red), then of both chrominances (or green and blue), cache by
/// cache. Half floats as in the paper, but each cache has its own unit: they neither overflow nor flush at any brightness.
struct LightCaches {
    int bands = 0, chrominance_bands = 0;
    bool ycocg = false;
    std::size_t caches = 0;
    Buffer<std::uint16_t> coefficients;  // half floats; a vector's length more than there are, so that vectors may read on
    Buffer<float> unit;                  // of each cache: a power of two; before a window the largest coefficient lies in [1, 2)
    Counts counts;

    int luma() const { return bands * bands; }
    int chrominance() const { return chrominance_bands * chrominance_bands; }
    int stride() const { return luma() + 2 * chrominance(); }
    std::size_t bytes() const { return coefficients.bytes() + unit.bytes(); }
};

}  // namespace interreflect
