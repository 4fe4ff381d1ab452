/// Parallel loops over fixed pieces: the pieces never depend on the number of threads, so neither does a result that is kept
/// per piece. A cancelled loop (Ctrl-C in Python) throws Cancelled once the pieces under way have ended.
#pragma once
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <cstddef>
#include <exception>

namespace interreflect {

/// Thrown out of a parallel loop whose task group was cancelled; its results are incomplete.
struct Cancelled : std::exception {
    const char* what() const noexcept override { return "cancelled"; }
};

/// Calls body(piece) for every piece in [0, pieces), in any order, on all threads of the current arena.
template <class Body>
void parallel_pieces(std::size_t pieces, const Body& body) {
    using Blocks = oneapi::tbb::blocked_range<std::size_t>;
    oneapi::tbb::parallel_for(
        Blocks(0, pieces, 1),
        [&](const Blocks& range) {
            for (std::size_t piece = range.begin(); piece != range.end(); ++piece) body(piece);
        },
        oneapi::tbb::simple_partitioner());
    if (oneapi::tbb::is_current_task_group_canceling()) throw Cancelled();
}

/// Calls body(begin, end) for consecutive blocks of `block` items of [0, count).
template <class Body>
void parallel_blocks(std::size_t count, std::size_t block, const Body& body) {
    parallel_pieces((count + block - 1) / block, [&](std::size_t piece) {
        const std::size_t begin = piece * block;
        body(begin, std::min(begin + block, count));
    });
}

/// Pixels [x0, x1) x [y0, y1) of one square tile, and the tile's number in row order.
struct Tile {
    int x0, y0, x1, y1;
    std::size_t index;
};

inline std::size_t tile_count(int width, int height, int size) {
    return static_cast<std::size_t>((width + size - 1) / size) * static_cast<std::size_t>((height + size - 1) / size);
}

/// Calls body(Tile) for every tile of a picture, `size` pixels on a side (fewer at the right and lower border).
template <class Body>
void parallel_tiles(int width, int height, int size, const Body& body) {
    const int columns = (width + size - 1) / size;
    parallel_pieces(tile_count(width, height, size), [&](std::size_t index) {
        const int x = static_cast<int>(index % columns) * size, y = static_cast<int>(index / columns) * size;
        body(Tile{x, y, std::min(x + size, width), std::min(y + size, height), index});
    });
}

}  // namespace interreflect
