#include "data/texture.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "math/parallel.h"

namespace interreflect {
namespace {

float decode(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }
float encode(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f; }

const std::array<float, 256>& decode_table() {
    static const auto table = [] {
        std::array<float, 256> t{};
        for (std::size_t i = 0; i < t.size(); ++i) t[i] = decode(static_cast<float>(i) / 255.0f);
        return t;
    }();
    return table;
}

/// Finely spaced answers of `encode`: 4096 steps in the square root of the value keep dark tones exact to a byte.
const std::array<std::uint8_t, 4097>& encode_table() {
    static const auto table = [] {
        std::array<std::uint8_t, 4097> t{};
        for (std::size_t i = 0; i < t.size(); ++i) {
            const float root = static_cast<float>(i) / 4096.0f;
            t[i] = static_cast<std::uint8_t>(std::lround(255.0f * encode(root * root)));
        }
        return t;
    }();
    return table;
}

/// A coordinate wrapped into [0, 1).
float wrap(float x) {
    const float f = x - std::floor(x);
    return f < 1.0f ? f : 0.0f;
}

/// The source texels, and their weights, that one texel of a half-size level averages (three where the size is odd).
struct Taps {
    int first, count;
    std::array<float, 3> weight;
};
Taps taps(int i, int fine, int coarse) {
    const double scale = static_cast<double>(fine) / coarse, begin = i * scale, end = begin + scale;
    Taps t{static_cast<int>(begin), 0, {}};
    for (int k = t.first; k < end - 1e-9 && k < fine && t.count < 3; ++k)
        t.weight[t.count++] = static_cast<float>((std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k))) / scale);
    return t;
}

void check_size(std::size_t values, int width, int height, int channels) {
    if (width < 1 || height < 1 || values != static_cast<std::size_t>(width) * height * channels)
        throw std::invalid_argument("texture: pixels do not fill width x height x channels");
}

}  // namespace

float srgb_to_linear(std::uint8_t value) { return decode_table()[value]; }
std::uint8_t linear_to_srgb(float value) {
    return encode_table()[std::lround(4096.0f * std::sqrt(std::clamp(value, 0.0f, 1.0f)))];
}

Texture Texture::from_srgb8(std::span<const std::uint8_t> pixels, int width, int height, int channels) {
    if (channels != 3 && channels != 4) throw std::invalid_argument("texture: 3 or 4 channels expected");
    check_size(pixels.size(), width, height, channels);
    Texture texture;
    texture.allocate_levels(width, height, true);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto* p = &pixels[(static_cast<std::size_t>(height - 1 - y) * width + x) * channels];
            texture.srgb_[static_cast<std::size_t>(y) * width + x] = static_cast<std::uint32_t>(p[0] | p[1] << 8 | p[2] << 16);
        }
    texture.fill_levels();
    return texture;
}

Texture Texture::from_linear(std::span<const float> pixels, int width, int height) {
    check_size(pixels.size(), width, height, 3);
    Texture texture;
    texture.allocate_levels(width, height, false);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto* p = &pixels[(static_cast<std::size_t>(height - 1 - y) * width + x) * 3];
            texture.linear_[static_cast<std::size_t>(y) * width + x] = {p[0], p[1], p[2]};
        }
    texture.fill_levels();
    return texture;
}

std::size_t Texture::bytes() const { return srgb_.bytes() + linear_.bytes(); }

vec3 Texture::texel(const Level& level, int x, int y) const {
    const std::size_t i = static_cast<std::size_t>(level.first) + static_cast<std::size_t>(y) * level.width + x;
    if (srgb_.empty()) return linear_[i];
    const std::uint32_t s = srgb_[i];
    const auto& table = decode_table();
    return {table[s & 255], table[(s >> 8) & 255], table[(s >> 16) & 255]};
}

/// Fills a level from the finer one before it.
void Texture::fill_level(std::size_t number) {
    const Level fine = levels_[number - 1], coarse = levels_[number];
    parallel_blocks(coarse.height, 16, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            const Taps ty = taps(y, fine.height, coarse.height);
            for (int x = 0; x < coarse.width; ++x) {
                const Taps tx = taps(x, fine.width, coarse.width);
                vec3 sum{0};
                for (int j = 0; j < ty.count; ++j)
                    for (int i = 0; i < tx.count; ++i)
                        sum += texel(fine, tx.first + i, ty.first + j) * (tx.weight[i] * ty.weight[j]);
                const std::size_t out = static_cast<std::size_t>(coarse.first) + static_cast<std::size_t>(y) * coarse.width + x;
                if (srgb_.empty())
                    linear_[out] = sum;
                else
                    srgb_[out] = static_cast<std::uint32_t>(linear_to_srgb(sum.x) | linear_to_srgb(sum.y) << 8 |
                                                            linear_to_srgb(sum.z) << 16);
            }
        }
    });
}

void Texture::allocate_levels(int w, int h, bool srgb) {
    // A chain holds at most twice the finest level (a texture one texel wide); its texels are numbered with 31 bits.
    if (static_cast<std::size_t>(w) * h >= (std::size_t{1} << 30)) throw std::invalid_argument("texture: more than 2^30 pixels");
    std::int32_t total = 0;
    while (true) {
        levels_.push_back({w, h, total});
        total += w * h;
        if (w == 1 && h == 1) break;
        w = std::max(1, w / 2), h = std::max(1, h / 2);
    }
    if (srgb)
        srgb_ = Buffer<std::uint32_t>(total);
    else
        linear_ = Buffer<vec3>(total);
}

void Texture::fill_levels() {
    for (std::size_t i = 1; i < levels_.size(); ++i) fill_level(i);
}

vec3 Texture::bilinear(const vec2& uv, int index) const {
    const Level& level = levels_[index];
    const float x = wrap(uv.x) * static_cast<float>(level.width) - 0.5f, y = wrap(uv.y) * static_cast<float>(level.height) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    const float wx = x - fx, wy = y - fy;
    int x0 = static_cast<int>(fx), y0 = static_cast<int>(fy);
    int x1 = x0 + 1, y1 = y0 + 1;
    if (x0 < 0) x0 += level.width;
    if (y0 < 0) y0 += level.height;
    if (x1 >= level.width) x1 -= level.width;
    if (y1 >= level.height) y1 -= level.height;
    const vec3 bottom = glm::mix(texel(level, x0, y0), texel(level, x1, y0), wx);
    const vec3 top = glm::mix(texel(level, x0, y1), texel(level, x1, y1), wx);
    return glm::mix(bottom, top, wy);
}

vec3 Texture::nearest(const vec2& uv, int index) const {
    const Level& level = levels_[index];
    const int x = std::min(static_cast<int>(wrap(uv.x) * static_cast<float>(level.width)), level.width - 1);
    const int y = std::min(static_cast<int>(wrap(uv.y) * static_cast<float>(level.height)), level.height - 1);
    return texel(level, x, y);
}

void Texture::prefetch(const vec2& uv) const {
    const Level& level = levels_.front();
    const int x = static_cast<int>(wrap(uv.x) * static_cast<float>(level.width) - 0.5f);
    const int y = static_cast<int>(wrap(uv.y) * static_cast<float>(level.height) - 0.5f);
    const std::size_t below = static_cast<std::size_t>(level.first) + static_cast<std::size_t>(y) * level.width + x;
    const std::size_t above = below + (y + 1 < level.height ? level.width : 0);
    for (const std::size_t i : {below, above})
        __builtin_prefetch(srgb_.empty() ? static_cast<const void*>(&linear_[i]) : static_cast<const void*>(&srgb_[i]));
}

vec3 Texture::filtered(const vec2& uv, const Footprint& footprint) const {
    const float area = std::fabs(footprint.dx.x * footprint.dy.y - footprint.dx.y * footprint.dy.x);
    const float texels = area * static_cast<float>(width()) * static_cast<float>(height());
    if (!(texels > 1.0f)) return bilinear(uv, 0);
    const float level = std::min(0.5f * std::log2(texels), static_cast<float>(levels() - 1));
    const int fine = static_cast<int>(level);
    const float t = level - static_cast<float>(fine);
    if (fine + 1 >= levels() || t == 0.0f) return bilinear(uv, fine);
    return glm::mix(bilinear(uv, fine), bilinear(uv, fine + 1), t);
}

Mask::Mask(std::span<const std::uint8_t> solid, int width, int height)
    : width_(width), height_(height), words_((width + 31) / 32), solid_(static_cast<std::size_t>(words_) * height) {
    check_size(solid.size(), width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            solid_[static_cast<std::size_t>(y) * words_ + x / 32] |=
                static_cast<std::uint32_t>(solid[static_cast<std::size_t>(height - 1 - y) * width + x] != 0) << (x % 32);
}

bool Mask::solid(const vec2& uv) const {
    const int x = std::min(static_cast<int>(wrap(uv.x) * static_cast<float>(width_)), width_ - 1);
    const int y = std::min(static_cast<int>(wrap(uv.y) * static_cast<float>(height_)), height_ - 1);
    return ((solid_[static_cast<std::size_t>(y) * words_ + x / 32] >> (x % 32)) & 1U) != 0;
}

}  // namespace interreflect
