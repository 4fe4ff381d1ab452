/// Textures: linear reflectance or radiance with box-filtered mip levels; masks: solid or cut out.
///
/// (u, v) = (0, 0) is the bottom left corner of the picture, both directions repeat, and texel centres lie at (i + 0.5) / size.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "data/buffer.h"
#include "math/vectors.h"

namespace interreflect {

/// How texture coordinates change from one pixel to the next, to the right and down.
struct Footprint {
    vec2 dx{0}, dy{0};
};

class Texture {
  public:
    /// 8-bit pixels (height x width x channels, top row first, 3 or 4 channels, the fourth unused), sRGB: decoded at every
    /// look-up.
    static Texture from_srgb8(std::span<const std::uint8_t> pixels, int width, int height, int channels);
    /// Linear float pixels (height x width x 3, top row first).
    static Texture from_linear(std::span<const float> pixels, int width, int height);

    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }
    int levels() const { return static_cast<int>(levels_.size()); }
    std::size_t bytes() const;
    /// Bilinear look-up in the finest level.
    vec3 bilinear(const vec2& uv) const { return bilinear(uv, 0); }
    /// Bilinear look-up in one level.
    vec3 bilinear(const vec2& uv, int level) const;
    /// The nearest texel of one level: for look-ups that are averaged.
    vec3 nearest(const vec2& uv, int level) const;
    /// Trilinear look-up in the levels whose texels are as large as the footprint (its parallelogram's area, in texels).
    vec3 filtered(const vec2& uv, const Footprint& footprint) const;
    /// Asks for the memory of a look-up in the finest level ahead of time.
    void prefetch(const vec2& uv) const;
    /// The mean over all texels.
    vec3 mean() const { return texel(levels_.back(), 0, 0); }

    /// One level's place in the array of all texels.
    struct Level {
        std::int32_t width, height, first;
    };
    /// The texels of all levels, finest first, each row by row from the bottom; for kernels that read sixteen at a time.
    std::span<const Level> level_table() const { return levels_; }
    /// R, G, B, unused: one sRGB byte each; empty for float textures.
    std::span<const std::uint32_t> srgb_texels() const { return srgb_.span(); }

  private:
    vec3 texel(const Level& level, int x, int y) const;
    void fill_level(std::size_t number);
    void allocate_levels(int width, int height, bool srgb);
    void fill_levels();

    std::vector<Level> levels_;
    Buffer<std::uint32_t> srgb_;  // huge pages: rows lie pages apart
    Buffer<vec3> linear_;         // empty for sRGB textures
};

/// Cut-out: solid where the value is true, looked up at the nearest texel.
class Mask {
  public:
    /// height x width, top row first; nonzero is solid.
    Mask(std::span<const std::uint8_t> solid, int width, int height);
    bool solid(const vec2& uv) const;
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    int width_, height_, words_;        // words a row
    std::vector<std::uint32_t> solid_;  // one bit a texel, lowest first
};

/// sRGB byte to linear value.
float srgb_to_linear(std::uint8_t value);
/// Linear value to the nearest sRGB byte, clamped to [0, 1].
std::uint8_t linear_to_srgb(float value);

}  // namespace interreflect
