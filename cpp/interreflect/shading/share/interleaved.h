#pragma once
#include <span>

#include "data/gbuffer.h"
#include "data/technique.h"
#include "math/parallel.h"
#include "shading/share/window.h"

namespace interreflect {

/// Each pixel of a block does its part of the work; a pixel takes each other part from the neighbours that lie on its own surface
/// and did that part: the mean over a window one block wide (a tent where the width is even), by which every part counts once.
/// A part that no such neighbour did is left out and the others count for it.
struct Interleaved {
    int width = 2;
    int height = 2;
    double normal_angle = 25.0;
    double plane_distance = 1.5;

    bool operator==(const Interleaved&) const = default;
    static constexpr auto description =
        describe("Interleaved",
                 "Each pixel of a block does its part of the work; the parts are merged over neighbours on the same surface.",
                 Source{"Keller and Heidrich 2001; Segovia et al. 2006", "interleaved sampling, geometry-aware filter"},
                 Param{"width", &Interleaved::width, "pixels of a block, horizontally", Unit::pixels, between(1, 8)},
                 Param{"height", &Interleaved::height, "pixels of a block, vertically", Unit::pixels, between(1, 8)},
                 Param{"normal_angle", &Interleaved::normal_angle,
                       "largest angle between the shading normals of neighbours that share", Unit::degrees, between(0, 90)},
                 Param{"plane_distance", &Interleaved::plane_distance,
                       "largest distance of a neighbour from the pixel's plane, in widths of the pixel at its depth",
                       Unit::pixels, above(0)});
};

/// How the pixels of blocks get what their neighbours gathered: as merge() of share.h.
struct InterleavedMerge {
    const Interleaved& share;
    const GBuffer& gbuffer;
    std::span<const float> weights;
    const Buffer<vec4>& partial;
    Window window{share.width, share.height};

    /// What the pixels of a tile of at most merge_tile_size on a side get, in rows of as many.
    void tile(const Tile& tile, vec4* merged) const;
};
inline constexpr int merge_tile_size = 32;  // pixels

}  // namespace interreflect
