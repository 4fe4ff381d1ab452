#include "voxels/prefilter/bricks.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>
#include <vector>

#include "math/parallel.h"
#include "voxels/prefilter/brick_index.h"

namespace interreflect {
namespace {

constexpr int coarse_side = TexelBlock::side / 2, coarse_edge = coarse_side + 2;

/// Texels of a level that are not air: their cells, and for each its volumes' texels one after the other.
struct PackedTexels {
    std::vector<std::uint32_t> cell;
    std::vector<std::uint16_t> halves;
};

/// The texels of one block of a finer level in bricks, and room for those made of them.
class BlockScratch {
  public:
    explicit BlockScratch(const Pyramid::Level& fine, int coarse_faces)
        : fine_level_(fine), coarse_faces_(static_cast<std::size_t>(coarse_faces)) {
        fine_.resize(static_cast<std::size_t>(fine.faces) * 4 * TexelBlock::volume);
        coarse_.resize(coarse_faces_ * 4 * coarse_edge * coarse_edge * coarse_edge);
    }

    /// Fills in the block of coarse texels from 4 * at on. Returns false where all is air.
    bool gather(const ivec3& at) {
        clear();
        const ivec3 left = glm::min(fine_level_.size - at * TexelBlock::side, ivec3(TexelBlock::side));
        const TexelBricks& bricks = fine_level_.bricks;
        // Texel -1 of the block is the first of a brick.
        for (int z = 0; z < left.z + 2; ++z)
            for (int y = 0; y < left.y + 2; ++y) gather_row(bricks, at * TexelBlock::side, y, z, left.x + 2);
        if (filled_.empty()) return false;
        const std::size_t volume = fine_level_.volume();
        for (const std::uint32_t place : filled_)
            for (std::size_t v = 0; v < static_cast<std::size_t>(fine_level_.faces); ++v)
                std::memcpy(&fine_[4 * (v * TexelBlock::volume + place)], &fine_level_.texels[4 * (v * volume + number_[place])],
                            8);
        const ivec3 made = (left + 1) / 2;
        constexpr std::size_t row = 4 * TexelBlock::edge, coarse_row = 4 * coarse_edge;
        block_ = {{fine_.data(), left.x, left.y, left.z, fine_level_.faces, row, row * TexelBlock::edge,
                   row * TexelBlock::edge * TexelBlock::edge},
                  {coarse_.data(), made.x, made.y, made.z, static_cast<int>(coarse_faces_), coarse_row, coarse_row * coarse_edge,
                   coarse_row * coarse_edge * coarse_edge},
                  number_};
        return true;
    }
    const TexelBlock& block() const { return block_; }

    /// Appends what was made and is not air.
    void pack(const ivec3& at, const ivec3& size, PackedTexels& packed) const {
        const LevelView& made = block_.coarse;
        for (int z = 0; z < made.nz; ++z)
            for (int y = 0; y < made.ny; ++y)
                for (int x = 0; x < made.nx; ++x) {
                    const std::size_t place = 4 * (x + 1 + coarse_edge * (y + 1 + coarse_edge * (z + 1)));
                    std::uint64_t any = 0, texel[8];
                    for (std::size_t v = 0; v < coarse_faces_; ++v) {
                        std::memcpy(&texel[v], &coarse_[v * made.volume + place], sizeof(texel[v]));
                        any |= texel[v];
                    }
                    if (any == 0) continue;
                    const ivec3 cell = at * coarse_side + ivec3(x, y, z);
                    packed.cell.push_back(static_cast<std::uint32_t>(cell.x + size.x * (cell.y + size.y * cell.z)));
                    const std::size_t count = packed.halves.size();
                    packed.halves.resize(count + 4 * coarse_faces_);
                    std::memcpy(&packed.halves[count], texel, 8 * coarse_faces_);
                }
    }

  private:
    void clear() {
        for (const std::uint32_t place : filled_) {
            number_[place] = 0;
            for (std::size_t v = 0; v < static_cast<std::size_t>(fine_level_.faces); ++v)
                std::memset(&fine_[4 * (v * TexelBlock::volume + place)], 0, 8);
        }
        filled_.clear();
    }

    /// `first`: the block's first texel, whose row (y, z) is counted from its border on, as are its `count` texels.
    void gather_row(const TexelBricks& bricks, const ivec3& first, int y, int z, int count) {
        for (int x = 0; x < count;) {
            const ivec3 tap = first + ivec3(x, y, z), brick = glm::min(tap / TexelBricks::side, bricks.count - 1);
            const ivec3 in = tap - brick * TexelBricks::side;
            const auto of =
                bricks.brick[static_cast<std::size_t>(brick.x + bricks.count.x * (brick.y + bricks.count.y * brick.z))];
            const int end = std::min(count, x + TexelBricks::edge - in.x);
            if (of != 0) {
                const std::uint32_t* numbers = &bricks.texel[static_cast<std::size_t>(of) * TexelBricks::volume] + in.x +
                                               TexelBricks::edge * (in.y + TexelBricks::edge * in.z);
                for (int i = x; i < end; ++i) {
                    if (numbers[i - x] == 0) continue;
                    const auto place = static_cast<std::uint32_t>(i + TexelBlock::edge * (y + TexelBlock::edge * z));
                    number_[place] = numbers[i - x];
                    filled_.push_back(place);
                }
            }
            x = end;
        }
    }

    const Pyramid::Level& fine_level_;
    std::size_t coarse_faces_;
    std::uint32_t number_[TexelBlock::volume] = {};
    std::vector<std::uint32_t> filled_;
    std::vector<std::uint16_t> fine_, coarse_;
    TexelBlock block_{};
};

/// All blocks of four slices of the coarser level, in ascending order of the cells.
PackedTexels reduce_layer(const Pyramid::Level& fine, const Pyramid::Level& coarse, int z, const ReduceBlock& reduce) {
    BlockScratch scratch(fine, coarse.faces);
    PackedTexels packed, sorted;
    const ivec3 count = (coarse.size + coarse_side - 1) / coarse_side;
    for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x) {
            if (!scratch.gather({x, y, z})) continue;
            reduce(scratch.block());
            scratch.pack({x, y, z}, coarse.size, packed);
        }
    std::vector<std::uint32_t> order(packed.cell.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return packed.cell[a] < packed.cell[b]; });
    const std::size_t halves = 4 * static_cast<std::size_t>(coarse.faces);
    sorted.halves.resize(packed.halves.size());
    for (const std::uint32_t i : order) {
        std::memcpy(&sorted.halves[halves * sorted.cell.size()], &packed.halves[halves * i], halves * sizeof(std::uint16_t));
        sorted.cell.push_back(packed.cell[i]);
    }
    return sorted;
}

/// The texels, volume by volume from number 1 on, and their bricks.
void store_in_bricks(Pyramid::Level& level, const std::vector<PackedTexels>& layers) {
    std::vector<std::size_t> first(layers.size() + 1, 0);
    for (std::size_t i = 0; i < layers.size(); ++i) first[i + 1] = first[i] + layers[i].cell.size();
    const auto faces = static_cast<std::size_t>(level.faces);
    const std::size_t volume = first.back() + 1;
    level.texels = Buffer<std::uint16_t>(4 * volume * faces);
    for (std::size_t v = 0; v < faces; ++v) std::memset(&level.texels[4 * v * volume], 0, 8);
    std::vector<std::uint32_t> cells(first.back());
    parallel_pieces(layers.size(), [&](std::size_t i) {
        std::copy(layers[i].cell.begin(), layers[i].cell.end(), cells.begin() + static_cast<std::ptrdiff_t>(first[i]));
        for (std::size_t k = 0; k < layers[i].cell.size(); ++k)
            for (std::size_t v = 0; v < faces; ++v)
                std::memcpy(&level.texels[4 * (v * volume + first[i] + k + 1)], &layers[i].halves[4 * (k * faces + v)], 8);
    });
    index_bricks(level, cells);
}

/// The texels of a dense level, without its border.
void store_dense(Pyramid::Level& level, const std::vector<PackedTexels>& layers) {
    const auto faces = static_cast<std::size_t>(level.faces);
    parallel_blocks(level.texels.size(), std::size_t{1} << 20, [&](std::size_t begin, std::size_t end) {
        std::fill(level.texels.begin() + begin, level.texels.begin() + end, std::uint16_t{0});
    });
    parallel_pieces(layers.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < layers[i].cell.size(); ++k) {
            const auto cell = static_cast<int>(layers[i].cell[k]);
            const int row = cell / level.size.x;
            const std::size_t place = level.index(cell % level.size.x, row % level.size.y, row / level.size.y);
            for (std::size_t v = 0; v < faces; ++v)
                std::memcpy(&level.texels[4 * (v * level.volume() + place)], &layers[i].halves[4 * (k * faces + v)], 8);
        }
    });
}

void pack_finest(Pyramid::Level& level, const VoxelView& voxels, const PackVoxels& pack) {
    const std::size_t count = voxels.end, volume = 4 * (count + 1);
    const auto faces = static_cast<std::size_t>(level.faces);
    level.texels = Buffer<std::uint16_t>(volume * faces);
    for (std::size_t v = 0; v < faces; ++v) std::memset(&level.texels[v * volume], 0, 8);
    parallel_blocks(count, 4096, [&](std::size_t begin, std::size_t end) {
        VoxelView some = voxels;
        some.begin = begin, some.end = end;
        pack(level.texels.data() + 4, volume, some);
    });
    index_bricks(level, {voxels.cell, count});
}

}  // namespace

std::size_t build_bricks(Pyramid& pyramid, const VoxelView& voxels, const PackVoxels& pack, const ReduceBlock& reduce,
                         const ReduceBlock& second) {
    pack_finest(pyramid.levels[0], voxels, pack);
    for (std::size_t i = 1; i < pyramid.levels.size(); ++i) {
        const Pyramid::Level& fine = pyramid.levels[i - 1];
        Pyramid::Level& coarse = pyramid.levels[i];
        std::vector<PackedTexels> layers(static_cast<std::size_t>((coarse.size.z + coarse_side - 1) / coarse_side));
        parallel_pieces(layers.size(), [&](std::size_t z) {
            layers[z] = reduce_layer(fine, coarse, static_cast<int>(z), i == 1 && second ? second : reduce);
        });
        if (coarse.dense()) {
            store_dense(coarse, layers);
            return i;
        }
        store_in_bricks(coarse, layers);
    }
    return pyramid.levels.size();
}

}  // namespace interreflect
