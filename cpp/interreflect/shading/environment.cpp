#include "shading/environment.h"

#include <algorithm>

#include "data/environment.h"
#include "math/sampling.h"
#include "shading/table.h"

namespace interreflect {
namespace {
constexpr float uniform_density = 1.0f / (4.0f * pi);
}

EnvironmentSampler::EnvironmentSampler(const Environment* environment) : environment_(environment) {
    if (environment_ == nullptr) return;
    if (environment_->width == 0)
        black_ = max_component(environment_->radiance) <= 0.0f;
    else
        build_table();
}

void EnvironmentSampler::build_table() {
    const int w = environment_->width, h = environment_->height;
    row_cosine_.resize(h + 1);
    for (int y = 0; y <= h; ++y) row_cosine_[y] = static_cast<float>(std::cos(std::numbers::pi * y / h));
    row_cdf_.assign(h + 1, 0.0f);
    column_cdf_.assign(static_cast<std::size_t>(h) * (w + 1), 0.0f);
    const auto light = [&](int x, int y) {
        return luminance(environment_->radiance * texel((x + w) % w, std::clamp(y, 0, h - 1)));
    };
    // The mean of a bilinear interpolation over the middle of three texels weighs them 1 : 6 : 1.
    const auto across = [&](int x, int y) { return light(x - 1, y) + 6.0f * light(x, y) + light(x + 1, y); };
    for (int y = 0; y < h; ++y) {
        const std::span<float> row(&column_cdf_[static_cast<std::size_t>(y) * (w + 1)], w + 1);
        for (int x = 0; x < w; ++x) row[x + 1] = across(x, y - 1) + 6.0f * across(x, y) + across(x, y + 1);
        row_cdf_[y + 1] = static_cast<float>(make_cdf(row)) * (row_cosine_[y] - row_cosine_[y + 1]);
    }
    black_ = make_cdf(row_cdf_) <= 0;
}

int EnvironmentSampler::row_of(const vec3& local) const {
    const auto below = std::upper_bound(row_cosine_.begin() + 1, row_cosine_.end() - 1, local.y, std::greater<>());
    return static_cast<int>(below - row_cosine_.begin()) - 1;
}

int EnvironmentSampler::column_of(const vec3& local) const {
    const float u = 0.5f + std::atan2(local.x, -local.z) / (2.0f * pi);
    return std::clamp(static_cast<int>(u * static_cast<float>(environment_->width)), 0, environment_->width - 1);
}

vec3 EnvironmentSampler::radiance(const vec3& direction) const {
    return environment_ == nullptr ? vec3(0) : environment_radiance(*environment_, direction);
}

vec3 EnvironmentSampler::sample(const vec2& u) const {
    const int w = environment_->width;
    if (w == 0 || black_) return uniform_sphere(u);
    const Chosen row = choose_entry(row_cdf_, u.y);
    const Chosen column = choose_entry({&column_cdf_[row.index * (w + 1)], static_cast<std::size_t>(w) + 1}, u.x);
    const float cosine = row_cosine_[row.index] + (row_cosine_[row.index + 1] - row_cosine_[row.index]) * row.rest;
    const float angle = (static_cast<float>(column.index) + column.rest) / static_cast<float>(w) * 2.0f * pi - pi;
    const float sine = std::sqrt(glm::max(0.0f, 1.0f - cosine * cosine));
    return environment_->world_from_light * vec3(sine * std::sin(angle), cosine, -sine * std::cos(angle));
}

float EnvironmentSampler::pdf(const vec3& direction) const {
    if (black_) return 0.0f;
    const int w = environment_->width;
    if (w == 0) return uniform_density;
    const vec3 local = direction * environment_->world_from_light;
    const int y = row_of(local), x = column_of(local);
    const float* column = &column_cdf_[static_cast<std::size_t>(y) * (w + 1)];
    const float chance = (row_cdf_[y + 1] - row_cdf_[y]) * (column[x + 1] - column[x]);
    return chance * static_cast<float>(w) / (2.0f * pi * (row_cosine_[y] - row_cosine_[y + 1]));
}

}  // namespace interreflect
