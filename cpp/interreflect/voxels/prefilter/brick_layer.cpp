#include "voxels/prefilter/brick_layer.h"

#include <algorithm>
#include <cstring>

#include "voxels/prefilter/brick_index.h"

namespace interreflect {
namespace {

constexpr int side = TexelBricks::side, edge = TexelBricks::edge;
constexpr std::size_t texel = 4;  // halves

}  // namespace

BrickLayer::BrickLayer(const Pyramid::Level& level, std::span<const std::uint32_t> cells, int volumes)
    : level_(level),
      cells_(cells),
      volumes_(volumes),
      row_(static_cast<std::size_t>(side * level.bricks.count.x) + 1),
      slice_(row_ * (static_cast<std::size_t>(side * level.bricks.count.y) + 1)),
      texel_row_(texel * level.row()),
      texel_slice_(texel * level.slice()),
      number_(slices * slice_),
      texels_(slices * texel_slice_ * static_cast<std::size_t>(volumes)) {}

void BrickLayer::fill(int layer) {
    layer_ = layer;
    std::fill(number_.begin(), number_.end(), 0U);
    std::fill(texels_.begin(), texels_.end(), std::uint16_t{0});
    put_rows();
    repeat_outermost();
}

void BrickLayer::put_rows() {
    const int first = first_slice();
    const std::size_t laid_out = slices * texel_slice_;
    const auto faces = static_cast<std::size_t>(level_.faces);
    over_rows(level_.size, cells_, first, first + slices, [&](const ivec3& at, std::size_t begin, std::size_t end) {
        const auto z = static_cast<std::size_t>(at.z - first), y = static_cast<std::size_t>(at.y) + 1;
        std::uint32_t* numbers = &number_[z * slice_ + y * row_];
        const std::size_t row = z * texel_slice_ + y * texel_row_;
        const auto before = static_cast<std::uint32_t>(level_.size.x * (at.y + level_.size.y * at.z));
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t x = cells_[i] - before + 1;
            const std::size_t number = faces * (i + 1);
            numbers[x] = static_cast<std::uint32_t>(number);
            for (std::size_t v = 0; v < static_cast<std::size_t>(volumes_); ++v)
                std::memcpy(&texels_[v * laid_out + row + texel * x], &level_.texels[texel * (number + v)], 8);
        }
        const auto last = static_cast<std::size_t>(level_.size.x);
        numbers[0] = numbers[1], numbers[last + 1] = numbers[last];
        for (std::size_t v = 0; v < static_cast<std::size_t>(volumes_); ++v) {
            std::uint16_t* first_texel = &texels_[v * laid_out + row];
            std::memcpy(first_texel, first_texel + texel, 8);
            std::memcpy(first_texel + texel * (last + 1), first_texel + texel * last, 8);
        }
    });
}

void BrickLayer::repeat_outermost() {
    const ivec3 size = level_.size;
    const int first = first_slice(), begin = std::max(first, 0), end = std::min(first + slices, size.z);
    const auto copy = [&](std::size_t z, std::size_t y, std::size_t from_z, std::size_t from_y, std::size_t rows) {
        std::memcpy(&number_[z * slice_ + y * row_], &number_[from_z * slice_ + from_y * row_], rows * row_ * sizeof(number_[0]));
        for (std::size_t v = 0; v < static_cast<std::size_t>(volumes_); ++v) {
            std::uint16_t* volume = &texels_[v * slices * texel_slice_];
            std::memcpy(volume + z * texel_slice_ + y * texel_row_, volume + from_z * texel_slice_ + from_y * texel_row_,
                        rows * texel_row_ * sizeof(texels_[0]));
        }
    };
    const auto last = static_cast<std::size_t>(size.y), rows = last + 2;
    for (int k = begin; k < end; ++k) {
        const auto z = static_cast<std::size_t>(k - first);
        copy(z, 0, z, 1, 1);
        copy(z, last + 1, z, last, 1);
    }
    if (first < 0) copy(0, 0, 1, 0, rows);
    const auto beyond = static_cast<std::size_t>(size.z - first);
    if (first + slices > size.z) copy(beyond, 0, beyond - 1, 0, rows);
}

void BrickLayer::write_bricks(std::uint32_t* out) const {
    const ivec3 count = level_.bricks.count;
    const std::int32_t* brick =
        &level_.bricks
             .brick[static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) * static_cast<std::size_t>(layer_)];
    for (int by = 0; by < count.y; ++by)
        for (int bx = 0; bx < count.x; ++bx, ++brick) {
            if (*brick == 0) continue;
            std::uint32_t* to = out + static_cast<std::size_t>(*brick) * TexelBricks::volume;
            const std::uint32_t* from =
                &number_[static_cast<std::size_t>(by * side) * row_ + static_cast<std::size_t>(bx * side)];
            for (std::size_t z = 0; z < edge; ++z)
                for (std::size_t y = 0; y < edge; ++y, to += edge)
                    std::memcpy(to, from + z * slice_ + y * row_, edge * sizeof(*to));
        }
}

LevelView BrickLayer::texels() const {
    const std::ptrdiff_t shift = volumes_ == 0 ? 0 : -(first_slice() + 1) * static_cast<std::ptrdiff_t>(texel_slice_);
    return {const_cast<std::uint16_t*>(texels_.data()) + shift,
            level_.size.x,
            level_.size.y,
            level_.size.z,
            volumes_,
            texel_row_,
            texel_slice_,
            slices * texel_slice_};
}

PackedView BrickLayer::packed() const {
    const std::ptrdiff_t shift = static_cast<std::ptrdiff_t>(row_) + 1 - first_slice() * static_cast<std::ptrdiff_t>(slice_);
    return {level_.texels.data(), number_.data() + shift, row_, slice_};
}

}  // namespace interreflect
