// Pixels between caches, lobes against caches, and the sun by its map, vectors of pixels against one pixel at a time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "direct/shadow/sun_lanes.h"
#include "math/half.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "math/spherical_harmonics.h"
#include "surfels/evaluate/cache_finder.h"
#include "surfels/evaluate/lobe_sums.h"
#include "surfels/light_caches.h"
#include "surfels/light_kernel.h"

namespace interreflect {
namespace {

vec3 direction(Rng& random) {
    const float z = 1 - 2 * random.uniform(), r = std::sqrt(std::max(0.0f, 1 - z * z)), turn = 2 * pi * random.uniform();
    return {r * std::cos(turn), r * std::sin(turn), z};
}

/// Pixels in the unit cube, of one triangle in z = 0 each third; every fifth sees nothing, of which nothing else is defined.
GBuffer pixels(int count, std::uint32_t seed) {
    Rng random(seed, 0);
    const auto n = static_cast<std::size_t>(count);
    GBuffer g;
    g.width = count, g.height = 1;
    g.position = Buffer<vec3>(n), g.geometric_normal = Buffer<vec3>(n, vec3(0)), g.normal = Buffer<vec3>(n, vec3(0));
    g.albedo = Buffer<vec3>(n, vec3(0)), g.offset = Buffer<float>(n, 0.0f);
    g.triangle = Buffer<std::uint32_t>(n, no_hit), g.instance = Buffer<std::uint32_t>(n, no_hit);
    for (std::size_t i = 0; i < n; ++i) {
        g.position[i] = vec3(std::nanf(""));
        if (i % 5 == 4) continue;
        const bool charted = i % 3 == 0;
        g.position[i] = {random.uniform(), random.uniform(), charted ? 0.0f : random.uniform()};
        if (i % 7 == 0) g.position[i] = vec3(2, 2, charted ? 0 : 2) * g.position[i] - vec3(0.5f, 0.5f, 0);  // beyond map and box
        g.geometric_normal[i] = charted ? vec3(0, 0, i % 2 == 0 ? 1 : -1) : direction(random);
        g.normal[i] = direction(random);
        g.albedo[i] = {random.uniform(), random.uniform(), random.uniform()};
        g.triangle[i] = charted ? 0U : 1U, g.instance[i] = 0;
    }
    return g;
}

/// A map of 8 x 8 texels over z = 0 and a grid of 3 x 1 x 4 cells, in which every third cache is missing.
CacheSites sites(int levels = 1) {
    CacheSites s;
    s.map.size = 8;
    s.map.cache = Buffer<std::uint32_t>(64);
    s.map.plane_of = Buffer<std::uint32_t>(2, no_chart);
    s.map.plane_of[0] = 0;
    s.map.planes = Buffer<ChartPlane>(1);
    s.map.planes[0] = {{vec4(8, 0, 0, 0), vec4(0, 8, 0, 0), vec4(0, 0, 1, 0), vec4(0)}};
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < 64; ++i) s.map.cache[i] = i % 3 == 0 || i < 24 ? no_cache : next++;
    s.grid.size = {3, 1, 4}, s.grid.box = {vec3(0), vec3(1)}, s.grid.levels = levels, s.grid.reach = 0.3f;
    s.grid.normal_offset = levels == 3 ? 0.4f : 0.0f;
    const std::size_t cells = s.grid.first_of(levels);
    s.grid.cache = Buffer<std::uint32_t>(cells), s.grid.nearest = Buffer<std::uint32_t>(cells);
    for (std::size_t i = 0; i < cells; ++i) s.grid.cache[i] = i % 3 == 1 || i < 5 ? no_cache : next++;
    for (std::size_t i = 0; i < cells; ++i) s.grid.nearest[i] = s.grid.cache[i] == no_cache ? next - 1 : s.grid.cache[i];
    s.position = Buffer<vec3>(next);
    return s;
}

using Weights = std::map<std::uint32_t, float>;

Weights normalised(Weights weights) {
    float sum = 0;
    for (const auto& [cache, weight] : weights) sum += weight;
    for (auto& [cache, weight] : weights) weight /= sum;
    return weights;
}

/// What a level is given at a distance from the camera: all within its reach, fading out over its last fifth.
float share_of_level(const GridSites& grid, int level, float distance) {
    const auto beyond = [&](int l) {
        if (l == 0) return 1.0f;
        if (l == grid.levels) return 0.0f;
        const float end = grid.reach * std::exp2(static_cast<float>(l - 1));
        return std::clamp((distance - 0.8f * end) / (0.2f * end), 0.0f, 1.0f);
    };
    return beyond(level) - beyond(level + 1);
}

/// Trilinear in a level, else its stand-in.
Weights near_in_level(const GridSites& grid, int level, const vec3& p, const vec3& normal) {
    Weights found;
    const ivec3 cells = grid.size_of(level);
    const vec3 size(cells), at = glm::clamp(p * size - 0.5f + grid.normal_offset * normal, vec3(0), size - 1.0f);
    const vec3 low = glm::min(glm::floor(at), glm::max(size - 2.0f, vec3(0))), share = at - low;
    float most = -1;
    std::uint32_t nearest = no_cache;
    for (int k = 0; k < 8; ++k) {
        const ivec3 step(k & 1, (k >> 1) & 1, k >> 2), cell = ivec3(low) + step;
        if (cell.x >= cells.x || cell.y >= cells.y || cell.z >= cells.z) continue;
        float weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= step[axis] != 0 ? share[axis] : 1 - share[axis];
        const auto number = grid.first_of(level) + static_cast<std::size_t>((cell.z * cells.y + cell.y) * cells.x + cell.x);
        if (weight > most) most = weight, nearest = grid.nearest[number];
        if (grid.cache[number] != no_cache && weight > 0.0f) found[grid.cache[number]] += weight;
    }
    if (found.empty()) found[nearest] = 1;
    return normalised(found);
}

/// Bilinear in the map, else trilinear in the grid, else its stand-in: the definition, a pixel at a time.
Weights near_one(const CacheSites& s, const GBuffer& g, std::size_t i) {
    Weights found;
    if (!g.hit(i)) return found;
    const auto add = [&](std::uint32_t cache, float weight) {
        if (cache != no_cache && weight > 0.0f) found[cache] += weight;
    };
    const vec3 p = g.position[i];
    if (g.triangle[i] == 0 && g.geometric_normal[i].z >= 0.0f) {
        const vec2 at = vec2(p) * 8.0f - 0.5f, low = glm::floor(at), share = at - low;
        for (int k = 0; k < 4; ++k) {
            const int x = static_cast<int>(low.x) + (k & 1), y = static_cast<int>(low.y) + (k >> 1);
            if (x < 0 || y < 0 || x >= 8 || y >= 8) continue;
            add(s.map.cache[static_cast<std::size_t>(y * 8 + x)],
                ((k & 1) != 0 ? share.x : 1 - share.x) * ((k >> 1) != 0 ? share.y : 1 - share.y));
        }
        if (!found.empty()) return normalised(found);
    }
    for (int level = 0; level < s.grid.levels; ++level) {
        const float share = share_of_level(s.grid, level, g.seen_head_on ? 1e9f : glm::length(p - g.camera.position));
        for (const auto& [cache, weight] : near_in_level(s.grid, level, p, g.geometric_normal[i]))
            if (share > 0.0f) found[cache] += share * weight;
    }
    return normalised(found);
}

void expect_what_one_pixel_finds(const CacheSites& s, const GBuffer& g) {
    const CacheFinder finder(s, g);
    NearCaches near;
    for (const int count : {256, 5, 1, 17})
        for (std::size_t first = 0; first + static_cast<std::size_t>(count) <= 1000; first += 233) {
            finder.find(first, count, near);
            for (int k = 0; k < count; ++k) {
                Weights found;
                for (int slot = 0; slot < near.slots; ++slot)
                    if (near.weight[slot][k] > 0.0f) found[near.cache[slot][k]] += near.weight[slot][k];
                const Weights expected = near_one(s, g, first + static_cast<std::size_t>(k));
                for (const auto& [cache, weight] : expected) ASSERT_NEAR(found[cache], weight, 1e-5f);
                float sum = 0;
                for (const auto& [cache, weight] : found) sum += weight;
                ASSERT_NEAR(sum, expected.empty() ? 0.0f : 1.0f, 1e-5f);
            }
        }
}

TEST(CacheFinder, VectorsOfPixelsFindWhatOnePixelFinds) { expect_what_one_pixel_finds(sites(), pixels(1000, 1)); }

TEST(CacheFinder, VectorsOfPixelsFindWhatOnePixelFindsInLevels) {
    for (const int levels : {2, 3}) {
        GBuffer g = pixels(1000, 1);
        g.camera.position = vec3(0.1f, 0.2f, 0.3f);
        expect_what_one_pixel_finds(sites(levels), g);
        g.seen_head_on = true;
        expect_what_one_pixel_finds(sites(levels), g);
    }
}

/// Random coefficients that differ between caches by powers of ten.
std::vector<std::array<std::array<float, 64>, 3>> fill(LightCaches& caches, std::uint32_t seed) {
    std::vector<std::array<std::array<float, 64>, 3>> given(caches.caches);
    Rng random(seed, 0);
    for (std::size_t cache = 0; cache < caches.caches; ++cache) {
        alignas(64) float colours[3][64] = {};
        const float brightness = std::pow(10.0f, static_cast<float>(cache % 60) - 30.0f);
        for (int i = 0; i < caches.luma(); ++i)
            for (auto& colour : colours) colour[i] = brightness * (random.uniform() - 0.5f + (i == 0 ? 4.0f : 0.0f));
        store_cache(caches, cache, colours[0], colours[1], colours[2]);
        for (std::size_t c = 0; c < 3; ++c) std::copy_n(colours[c], 64, given[cache][c].begin());
    }
    return given;
}

TEST(LightCaches, HalfFloatsKeepElevenBitsOfACachesLargestAtAnyBrightness) {
    for (int bands = 1; bands <= 8; ++bands) {
        LightCaches caches = make_light_caches(60, {bands, 0});
        const auto given = fill(caches, static_cast<std::uint32_t>(bands));
        for (std::size_t cache = 0; cache < caches.caches; ++cache)
            for (int c = 0; c < 3; ++c)
                for (int i = 0; i < caches.luma(); ++i) {
                    const auto at =
                        cache * static_cast<std::size_t>(caches.stride()) + static_cast<std::size_t>(c * caches.luma() + i);
                    const float stored = from_half(caches.coefficients[at]) * caches.unit[cache];
                    EXPECT_LE(std::fabs(stored - given[cache][static_cast<std::size_t>(c)][static_cast<std::size_t>(i)]),
                              caches.unit[cache] * 0x1p-11f);  // half of the last place of [1, 2)
                }
    }
}

TEST(LobeSums, VectorsOfPixelsSeeWhatOnePixelSees) {
    const CacheSites s = sites();
    const GBuffer g = pixels(256, 2);
    const CacheFinder finder(s, g);
    const auto near = std::make_unique<NearCaches>();
    finder.find(0, 256, *near);
    for (int bands = 1; bands <= 8; ++bands)
        for (const int chrominance : {0, (bands + 1) / 2}) {
            LightCaches caches = make_light_caches(s.size(), {bands, chrominance});
            Rng random(7, static_cast<std::uint32_t>(bands));
            for (std::size_t cache = 0; cache < caches.caches; ++cache) {
                alignas(64) float colours[3][64] = {};
                for (auto& colour : colours)
                    for (int i = 0; i < caches.luma(); ++i) colour[i] = random.uniform() - 0.5f + (i == 0 ? 2.0f : 0.0f);
                store_cache(caches, cache, colours[0], colours[1], colours[2]);
            }
            const auto lobes = std::make_unique<Lobes>();
            for (int i = 0; i < 256; ++i) {
                lobes->axis[i] = direction(random);
                lobes->exponent[i] = bands % 2 == 0 ? 1.0f : 40.0f * random.uniform();
            }
            (bands % 2 == 0 ? sum_cosines : sum_lobes)(caches, *near, 256, *lobes);
            for (int i = 0; i < 256; ++i) {
                std::array<double, 3> mean{};
                const vec3 axis = lobes->axis[i];
                for (const auto& near_cache : near_one(s, g, static_cast<std::size_t>(i))) {
                    const std::uint32_t cache = near_cache.first;
                    const float weight = near_cache.second;
                    spherical_harmonics(axis, bands, [&](int number, float y) {
                        const int band = static_cast<int>(std::sqrt(static_cast<float>(number) + 0.5f));
                        const double part = static_cast<double>(weight * caches.unit[cache]) * static_cast<double>(y) *
                                            static_cast<double>(lobe_scale(band, lobes->exponent[i]));
                        const std::size_t first = cache * static_cast<std::size_t>(caches.stride());
                        for (int c = 0; c < 3; ++c) {
                            if (c > 0 && number >= caches.chrominance()) continue;
                            const int begin = c == 0 ? 0 : caches.luma() + (c - 1) * caches.chrominance();
                            const std::uint16_t half = caches.coefficients[first + static_cast<std::size_t>(begin + number)];
                            mean[static_cast<std::size_t>(c)] += part * static_cast<double>(from_half(half));
                        }
                    });
                }
                if (caches.ycocg) {
                    const auto [y, co, cg] = mean;
                    mean = {y - cg + co, y + cg, y - cg - co};
                }
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(lobes->mean[i][c], std::max(mean[static_cast<std::size_t>(c)], 0.0),
                                2e-5);  // floats in sums of 192
            }
        }
}

TEST(SunLanes, VectorsOfPixelsAreAsLitAsOne) {
    const Intersector nothing(make_geometry({}, {}), {}, {});
    const DirectionalLight light{glm::normalize(vec3(0.3f, -1, 0.2f)), vec3(3, 2, 1)};
    DepthMap map(view_of(light, {vec3(0.2f), vec3(0.7f)}, 16), nothing);  // some pixels lie beyond it
    Rng random(3, 0);
    for (float& depth : map.depth) depth = 2.0f * random.uniform();
    const GBuffer g = pixels(2000, 4);
    const LightSampler::Delta sun{-light.direction, std::numeric_limits<float>::infinity(), light.irradiance};
    const auto run = std::make_unique<SunlitRun>();
    run->count = 201;  // not a multiple of a vector's length
    int lit = 0, part = 0, outside = 0;
    for (std::size_t pixel = 0; pixel < 9 * 201; ++pixel) {
        const auto i = static_cast<int>(pixel % 201);
        if (i == 0) light_by_sun(sun, map, 1.0f, g, pixel, *run);
        float expected = 0;
        const bool faces = g.hit(pixel) && glm::dot(g.normal[pixel], sun.direction) > 0 &&
                           glm::dot(g.geometric_normal[pixel], sun.direction) > 0;
        if (faces && map.view.project(g.position[pixel]).inside)
            expected = map.lit(g.position[pixel], g.geometric_normal[pixel], 1.0f, g.offset[pixel]);
        else if (faces)
            expected = 1, ++outside;
        EXPECT_NEAR(run->lit[i], expected, 1e-6f);
        lit += expected == 1.0f ? 1 : 0, part += expected > 0.0f && expected < 1.0f ? 1 : 0;
        const vec3 reflected =
            g.albedo[pixel] / pi * sun.irradiance * (expected * std::max(glm::dot(g.normal[pixel], sun.direction), 0.0f));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(run->diffuse[i][c], g.hit(pixel) ? reflected[c] : 0.0f, 1e-6f);
    }
    EXPECT_GT(lit, 10);
    EXPECT_GT(part, 10);
    EXPECT_GT(outside, 10);
}

}  // namespace
}  // namespace interreflect
