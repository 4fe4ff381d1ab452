/// Texture::nearest of one texture and level, inline for sRGB: a triangle's samples differ in their coordinates only.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "data/texture.h"

namespace interreflect {

/// Linear values of sRGB bytes.
inline const std::array<float, 256> linear_values = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = srgb_to_linear(static_cast<std::uint8_t>(i));
    return values;
}();

class NearestTexel {
  public:
    void choose(const Texture& texture, int level) {
        texture_ = &texture;
        level_ = level;
        if (texture.srgb_texels().empty()) return;
        const Texture::Level& chosen = texture.level_table()[level];
        srgb_ = texture.srgb_texels().data() + chosen.first;
        width_ = chosen.width, height_ = chosen.height;
    }
    bool chosen() const { return texture_ != nullptr; }
    /// The chosen level of an sRGB texture; null for others.
    const std::uint32_t* srgb() const { return srgb_; }
    int width() const { return width_; }
    int height() const { return height_; }
    [[gnu::always_inline]] vec3 at(const vec2& uv) const {
        if (srgb_ == nullptr) return texture_->nearest(uv, level_);
        const std::uint32_t texel = srgb_[static_cast<std::size_t>(place(uv.y, height_)) * width_ + place(uv.x, width_)];
        return {linear_values[texel & 255], linear_values[(texel >> 8) & 255], linear_values[(texel >> 16) & 255]};
    }

  private:
    static int place(float coordinate, int size) {
        const float f = coordinate - std::floor(coordinate);  // 1 where a tiny negative coordinate is rounded
        return f < 1.0f ? std::min(static_cast<int>(f * static_cast<float>(size)), size - 1) : 0;
    }

    const Texture* texture_ = nullptr;
    const std::uint32_t* srgb_ = nullptr;  // the level's first texel
    int level_ = 0, width_ = 1, height_ = 1;
};

}  // namespace interreflect
