#include "voxels/prefilter/bricks.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "math/parallel.h"
#include "voxels/prefilter/brick_index.h"
#include "voxels/prefilter/brick_layer.h"

namespace interreflect {
namespace {

constexpr std::size_t texel = 4;  // halves

/// Texels of a level that are not air: their cells, and for each its volumes' texels one after the other.
struct PackedTexels {
    std::vector<std::uint32_t> cell;
    std::vector<std::uint16_t> halves;
};

/// One slice of a level that is to be in bricks, made as a dense one.
class CoarseSlice {
  public:
    explicit CoarseSlice(const Pyramid::Level& level)
        : level_(level), halves_(texel * level.slice() * static_cast<std::size_t>(level.faces)) {}

    /// Slice z of the level.
    LevelView at(int z) {
        const ivec3 size = level_.size;
        const std::size_t slice = texel * level_.slice();
        return {halves_.data() - static_cast<std::size_t>(z + 1) * slice,
                size.x,
                size.y,
                size.z,
                level_.faces,
                texel * level_.row(),
                slice,
                slice};
    }
    /// Appends what is not air, in ascending order of the cells.
    void pack(int z, PackedTexels& packed) const {
        for (int y = 0; y < level_.size.y; ++y) {
            const std::size_t row = texel * (static_cast<std::size_t>(y + 1) * level_.row() + 1);
            for (int x = 0; x < level_.size.x; ++x) pack_texel(row + texel * static_cast<std::size_t>(x), {x, y, z}, packed);
        }
    }

  private:
    void pack_texel(std::size_t place, const ivec3& at, PackedTexels& packed) const {
        const auto faces = static_cast<std::size_t>(level_.faces);
        std::uint64_t any = 0, texels[8];
        for (std::size_t v = 0; v < faces; ++v) {
            std::memcpy(&texels[v], &halves_[v * texel * level_.slice() + place], sizeof(texels[v]));
            any |= texels[v];
        }
        if (any == 0) return;
        packed.cell.push_back(static_cast<std::uint32_t>(at.x + level_.size.x * (at.y + level_.size.y * at.z)));
        const auto* first = reinterpret_cast<const std::uint16_t*>(texels);
        packed.halves.insert(packed.halves.end(), first, first + texel * faces);
    }

    const Pyramid::Level& level_;
    Buffer<std::uint16_t> halves_;
};

/// Room for so many texels after the one of air.
void allocate_packed(Pyramid::Level& level, std::size_t count) {
    const std::size_t halves = texel * static_cast<std::size_t>(level.faces);
    level.texels = Buffer<std::uint16_t>(halves * (count + 1));
    std::fill_n(level.texels.begin(), halves, std::uint16_t{0});
}

/// The texels of all layers. Returns their cells.
std::vector<std::uint32_t> store_packed(Pyramid::Level& level, const std::vector<PackedTexels>& layers) {
    std::vector<std::size_t> first(layers.size() + 1, 0);
    for (std::size_t i = 0; i < layers.size(); ++i) first[i + 1] = first[i] + layers[i].cell.size();
    allocate_packed(level, first.back());
    std::vector<std::uint32_t> cells(first.back());
    parallel_pieces(layers.size(), [&](std::size_t i) {
        std::copy(layers[i].cell.begin(), layers[i].cell.end(), cells.begin() + static_cast<std::ptrdiff_t>(first[i]));
        std::copy(layers[i].halves.begin(), layers[i].halves.end(),
                  level.texels.begin() + texel * static_cast<std::size_t>(level.faces) * (first[i] + 1));
    });
    return cells;
}

void pack_finest(Pyramid::Level& level, const VoxelView& voxels, const PackVoxels& pack) {
    allocate_packed(level, voxels.end);
    parallel_blocks(voxels.end, 4096, [&](std::size_t begin, std::size_t end) {
        VoxelView some = voxels;
        some.begin = begin, some.end = end;
        pack(&level.texels[texel * static_cast<std::size_t>(level.faces)], some);
    });
}

/// The bricks of level i, whose texels stand in `cells`, and the next level: if that is to be in bricks, its texels by layers.
std::vector<PackedTexels> build_layers(Pyramid& pyramid, std::size_t i, std::span<const std::uint32_t> cells,
                                       const BrickFilter& filter) {
    Pyramid::Level& fine = pyramid.levels[i];
    Pyramid::Level* coarse = i + 1 < pyramid.levels.size() ? &pyramid.levels[i + 1] : nullptr;
    const ReduceLayer& reduce = i == 0 && filter.second ? filter.second : filter.reduce;
    const int laid_out = std::min(filter.laid_out, fine.faces);
    number_bricks(fine, cells);
    std::vector<PackedTexels> made(static_cast<std::size_t>(fine.bricks.count.z));
    // Kept by threads, not by pieces: megabytes of fresh pages cost more than what is written there.
    oneapi::tbb::enumerable_thread_specific<BrickLayer> layers([&] { return BrickLayer(fine, cells, laid_out); });
    oneapi::tbb::enumerable_thread_specific<CoarseSlice> slices([&] { return CoarseSlice(*coarse); });
    parallel_pieces(made.size(), [&](std::size_t piece) {
        BrickLayer& bricks = layers.local();
        bricks.fill(static_cast<int>(piece));
        bricks.write_bricks(fine.bricks.texel.data());
        if (coarse == nullptr) return;
        const int first = TexelBricks::side / 2 * static_cast<int>(piece),
                  end = std::min(first + TexelBricks::side / 2, coarse->size.z);
        for (int z = first; z < end; ++z) {
            if (coarse->dense()) {
                reduce(bricks.texels(), bricks.packed(), view(*coarse), z);
                continue;
            }
            CoarseSlice& slice = slices.local();
            reduce(bricks.texels(), bricks.packed(), slice.at(z), z);
            slice.pack(z, made[piece]);
        }
    });
    return made;
}

}  // namespace

std::size_t build_bricks(Pyramid& pyramid, const VoxelView& voxels, const BrickFilter& filter) {
    pack_finest(pyramid.levels[0], voxels, filter.pack);
    std::span<const std::uint32_t> cells(voxels.cell, voxels.end);
    std::vector<std::uint32_t> own;
    for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
        const std::vector<PackedTexels> made = build_layers(pyramid, i, cells, filter);
        if (i + 1 == pyramid.levels.size() || pyramid.levels[i + 1].dense()) return i + 1;
        own = store_packed(pyramid.levels[i + 1], made);
        cells = own;
    }
    return pyramid.levels.size();
}

}  // namespace interreflect
