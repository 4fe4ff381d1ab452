/// Textures: linear reflectance or radiance with box-filtered mip levels; masks: solid or cut out.
///
/// (u, v) = (0, 0) is the bottom left corner of the picture, both directions repeat, and texel centres lie at (i + 0.5) / size.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

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
    /// The mean over all texels.
    vec3 mean() const { return texel(levels_.back(), 0, 0); }

  private:
    struct Level {
        int width, height;
        std::vector<std::uint32_t> srgb;  // R, G, B, unused: one byte each; empty for float textures
        std::vector<vec3> linear;
    };
    static vec3 texel(const Level& level, int x, int y);
    static Level half_size(const Level& fine);
    void build_levels();

    std::vector<Level> levels_;
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
    int width_, height_;
    std::vector<std::uint8_t> solid_;
};

/// sRGB byte to linear value.
float srgb_to_linear(std::uint8_t value);
/// Linear value to the nearest sRGB byte, clamped to [0, 1].
std::uint8_t linear_to_srgb(float value);

}  // namespace interreflect
