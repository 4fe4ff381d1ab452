#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "caches/distribute/normal_axes.h"
#include "caches/distribute/tile_clusters.h"
#include "caches/distribute/tile_kernels.h"
#include "caches/distribute/tile_pixels.h"
#include "math/rng.h"
#include "math/sampling.h"

namespace interreflect {
namespace {

constexpr int bins = 8;
constexpr float smoothing = 20.0f * degrees_to_radians, exponent = 8.0f;

std::vector<vec3> random_normals(std::size_t count, std::uint32_t seed) {
    Rng rng(seed, 1);
    std::vector<vec3> normals(count);
    for (auto& normal : normals) {
        const float x = rng.uniform();
        normal = uniform_sphere({x, rng.uniform()});
    }
    return normals;
}

Coordinates coordinates_of(std::span<const vec3> vectors) {
    Coordinates coordinates;
    copy_vectors(vectors, {0, vectors.size(), vectors.size(), 1}, coordinates);
    return coordinates;
}

/// Of those where `depth` is finite.
std::vector<float> histogram_of(const std::vector<vec3>& normals, std::vector<float> depth) {
    std::vector<float> histogram(bins * bins);
    depth.resize(with_room(normals.size()), 1.0f);
    count_normals(coordinates_of(normals), depth.data(), normals.size(), bins, histogram.data());
    return histogram;
}

std::array<vec3, 3> axes_of(const std::vector<vec3>& normals) {
    return NormalAxes(bins, smoothing, exponent).choose(histogram_of(normals, {}));
}

std::uint32_t axis_of(const std::array<vec3, 3>& axes, const vec3& normal) {
    std::vector<std::uint32_t> axis(with_room(1));
    nearest_axes(coordinates_of({&normal, 1}), 1, axes, axis.data());
    return axis[0];
}

TEST(TileKernels, CountTheNormalsInEachBinOfTheOctahedralMap) {
    auto normals = random_normals(1003, 3);                               // not whole vectors
    std::fill(normals.begin() + 300, normals.begin() + 700, normals[5]);  // a wall
    std::erase_if(normals, [](const vec3& normal) {
        const vec2 at = octahedral_square(normal) * static_cast<float>(bins), border = glm::abs(at - glm::round(at));
        return std::min(border.x, border.y) < 1e-4f;  // either side may hold it
    });
    std::vector<float> depth(normals.size(), 1.0f), expected(bins * bins);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const vec2 at = octahedral_square(normals[i]) * static_cast<float>(bins);
        if (i % 7 == 3)
            depth[i] = std::numeric_limits<float>::infinity();
        else
            expected[static_cast<std::size_t>(at.x) + bins * static_cast<std::size_t>(at.y)] += 1.0f;
    }
    EXPECT_EQ(histogram_of(normals, depth), expected);
}

TEST(TileKernels, FindTheFirstOfTheLargestNumbers) {
    Rng rng(11, 1);
    for (std::size_t count = 1; count < 70; ++count) {
        std::vector<float> numbers(count);
        for (float& number : numbers) number = std::floor(4.0f * rng.uniform());
        const auto first = std::max_element(numbers.begin(), numbers.end()) - numbers.begin();
        numbers.resize(with_room(count), 9.0f);
        EXPECT_EQ(first_largest(numbers.data(), count), static_cast<std::size_t>(first));
    }
}

TEST(TileKernels, TellTheTwoEndsOfAnAxisApart) {
    const std::array<vec3, 3> axes = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(axis_of(axes, axes[static_cast<std::size_t>(k)]), static_cast<std::uint32_t>(2 * k));
        EXPECT_EQ(axis_of(axes, -axes[static_cast<std::size_t>(k)]), static_cast<std::uint32_t>(2 * k + 1));
    }
    const auto normals = random_normals(517, 5);
    std::vector<std::uint32_t> axis(with_room(normals.size()));
    nearest_axes(coordinates_of(normals), normals.size(), axes, axis.data());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const vec3 towards = axes[axis[i] / 2] * (axis[i] % 2 == 1 ? -1.0f : 1.0f);
        ASSERT_GE(glm::dot(towards, normals[i]) + 1e-6f, max_component(glm::abs(normals[i])));
    }
}

TEST(TileKernels, CutDepthsAtPowersOfARatio) {
    // One slice an octave of near = 2: [2, 4) is slice 0, [4, 8) slice 1, [1, 2) slice -1.
    std::vector<float> depth = {2.001f, 3.999f, 4.001f, 1.999f, 1.001f, 500.0f, std::numeric_limits<float>::infinity(), 1e-30f};
    const std::size_t count = depth.size();
    depth.resize(with_room(count), 1.0f);
    std::vector<std::uint32_t> slice(depth.size());
    slice_depths(depth.data(), count, 0.5f, 1.0f, slice.data());
    slice.resize(count);
    const std::uint32_t middle = 1U << 20;
    EXPECT_EQ(slice,
              (std::vector<std::uint32_t>{middle, middle, middle + 1, middle - 1, middle - 1, middle + 7, no_cache, slice[7]}));
    EXPECT_LT(slice[7], middle - 90);
}

TEST(NormalAxes, AreThreeThatDiffer) {
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        const auto axes = axes_of(random_normals(1 + seed % 7, seed));
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < i; ++j)
                EXPECT_LT(std::fabs(glm::dot(axes[static_cast<std::size_t>(i)], axes[static_cast<std::size_t>(j)])), 0.9f)
                    << seed;
    }
}

TEST(NormalAxes, StandAlongTheNormalsThatAreThere) {
    // A box seen from a corner: each wall's axis is within a bin's half diagonal (the octahedral map's bins are up to 22
    // degrees).
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const Frame frame(random_normals(1, seed)[0]);
        const std::array<vec3, 3> walls = {frame.to_world({1, 0, 0}), frame.to_world({0, 1, 0}), frame.to_world({0, 0, 1})};
        std::vector<vec3> normals;
        for (const vec3& wall : walls) normals.insert(normals.end(), 100, wall);
        const auto axes = axes_of(normals);
        for (const vec3& wall : walls) {
            const std::uint32_t k = axis_of(axes, wall) / 2;
            EXPECT_GT(std::fabs(glm::dot(axes[k], wall)), std::cos(30.0f * degrees_to_radians)) << seed;
        }
    }
}

TEST(NormalAxes, OfOneWallLeaveTheOthersFarFromIt) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        // Beyond 41 degrees: two of the map's bins, however many normals there are.
        const auto axes = axes_of(std::vector<vec3>(1 + 500 * seed, random_normals(1, seed)[0]));
        EXPECT_LT(std::fabs(glm::dot(axes[0], axes[1])), 0.75f) << seed;
        EXPECT_LT(std::fabs(glm::dot(axes[0], axes[2])), 0.75f) << seed;
    }
}

/// A picture of `size` pixels a side of a wavy surface, whose lengths are in units of `unit`; some pixels see the sky.
GBuffer waves(int size, float unit) {
    GBuffer gbuffer;
    gbuffer.width = gbuffer.height = size;
    const std::size_t pixels = gbuffer.pixels();
    gbuffer.position = Buffer<vec3>(pixels), gbuffer.normal = Buffer<vec3>(pixels),
    gbuffer.triangle = Buffer<std::uint32_t>(pixels), gbuffer.depth = Buffer<float>(pixels, 1.0f);
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto x = static_cast<float>(i % static_cast<std::size_t>(size)),
                   y = static_cast<float>(i / static_cast<std::size_t>(size));
        gbuffer.position[i] = unit * vec3(x, y, 3.0f * std::sin(0.4f * x) + 2.0f * std::cos(0.3f * y));
        gbuffer.normal[i] = glm::normalize(vec3(-1.2f * std::cos(0.4f * x), 0.6f * std::sin(0.3f * y), 1.0f));
        gbuffer.triangle[i] = i % 11 == 3 ? no_hit : 0U;
    }
    return gbuffer;
}

TilePixels pixels_of(const GBuffer& gbuffer, const Tile& tile) {
    TilePixels pixels;
    pixels.load(gbuffer, tile), pixels.load_positions(gbuffer);
    return pixels;
}

TEST(TilePixels, AreThoseOfTheTileRowByRow) {
    const GBuffer gbuffer = waves(37, 1.0f);
    for (const Tile& tile : {Tile{0, 0, 37, 37, 0}, Tile{5, 7, 9, 9, 0}, Tile{20, 30, 37, 37, 0}, Tile{36, 36, 37, 37, 0}}) {
        const TilePixels pixels = pixels_of(gbuffer, tile);
        std::size_t i = 0;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x, ++i) {
                const std::size_t pixel = static_cast<std::size_t>(y) * 37 + static_cast<std::size_t>(x);
                ASSERT_EQ(pixels.in_picture(i), pixel);
                ASSERT_EQ(pixels.depth[i], gbuffer.depth[pixel]);
                for (int k = 0; k < 3; ++k) {
                    ASSERT_EQ(pixels.normal[static_cast<std::size_t>(k)][i], gbuffer.normal[pixel][k]);
                    ASSERT_EQ(pixels.position[static_cast<std::size_t>(k)][i], gbuffer.position[pixel][k]);
                }
            }
        EXPECT_EQ(pixels.count(), i);
    }
}

std::vector<std::uint32_t> keys_of_waves(const GBuffer& gbuffer) {
    std::vector<std::uint32_t> key(gbuffer.pixels());
    for (std::size_t i = 0; i < key.size(); ++i)
        key[i] = gbuffer.hit(i) ? hash32(static_cast<std::uint32_t>((gbuffer.normal[i].x + 2.0f) * 80.0f)) % 1000 : no_cache;
    return key;
}

TEST(TileClusters, HoldThePixelsOfEachKeyAndCountThem) {
    const GBuffer gbuffer = waves(37, 1.0f);
    const Tile tile{0, 0, 37, 37, 0};
    const auto key = keys_of_waves(gbuffer);
    TileClusters clusters;
    clusters.group(pixels_of(gbuffer, tile), key);
    ASSERT_GT(clusters.clusters.size(), 64U);  // more than the table starts with
    std::vector<std::uint32_t> members(clusters.clusters.size());
    std::vector<vec3> normal(clusters.clusters.size(), vec3(0));
    for (std::size_t i = 0; i < key.size(); ++i) {
        ASSERT_EQ(clusters.slot[i] == TileClusters::none, key[i] == no_cache);
        if (key[i] == no_cache) continue;
        const auto& cluster = clusters.clusters[clusters.slot[i]];
        ASSERT_EQ(cluster.key, key[i]);
        ASSERT_TRUE(glm::all(glm::lessThanEqual(cluster.lower, gbuffer.position[i])));
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(cluster.upper, gbuffer.position[i])));
        ++members[clusters.slot[i]], normal[clusters.slot[i]] += gbuffer.normal[i];
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        EXPECT_EQ(clusters.clusters[i].members, members[i]);
        EXPECT_LT(glm::length(clusters.clusters[i].normal - normal[i]), 1e-4f);
        if (i > 0) {
            EXPECT_LT(clusters.clusters[i - 1].key, clusters.clusters[i].key);
        }
    }
    EXPECT_EQ(TileClusters().count(key), members.size());
}

TEST(TileClusters, ChooseThePixelWithTheBestScoreWhateverTheUnit) {
    std::vector<std::uint32_t> chosen;
    for (const float unit : {1.0f, 1e-3f, 1e3f}) {
        const GBuffer gbuffer = waves(37, unit);
        const Tile tile{0, 0, 37, 37, 0};
        TileClusters clusters;
        const TilePixels pixels = pixels_of(gbuffer, tile);
        clusters.group(pixels, keys_of_waves(gbuffer));
        clusters.choose_pixels(pixels);
        std::vector<float> best(clusters.clusters.size(), -10.0f);
        const auto score = [&](const TileClusters::Cluster& c, std::size_t i) {
            const vec3 n = glm::normalize(c.normal), away = gbuffer.position[i] - 0.5f * (c.lower + c.upper);
            const float extent = glm::length(c.upper - c.lower), inverse = extent > 0.0f ? 1.0f / extent : 0.0f;
            const float out = glm::dot(away, n), aside = glm::length(away - out * n);
            return (glm::dot(gbuffer.normal[i], n) + out * inverse) / (1.0f + aside * inverse);
        };
        for (std::size_t i = 0; i < gbuffer.pixels(); ++i)
            if (const auto slot = clusters.slot[i]; slot != TileClusters::none)
                best[slot] = std::max(best[slot], score(clusters.clusters[slot], i));
        for (std::size_t k = 0; k < best.size(); ++k) {
            const auto& cluster = clusters.clusters[k];
            EXPECT_EQ(clusters.slot[cluster.pixel], k);
            EXPECT_NEAR(score(cluster, cluster.pixel), best[k], 1e-5f);  // ties differ in the last bits
        }
        // A key is shared by columns a wave apart, whose pixels score alike: only the score is the same to the last bits.
        if (unit == 1.0f)
            for (std::size_t k = 0; k < best.size(); ++k) chosen.push_back(static_cast<std::uint32_t>(best[k] * 1000.0f + 0.5f));
        else
            for (std::size_t k = 0; k < best.size(); ++k) EXPECT_NEAR(chosen[k], best[k] * 1000.0f, 0.6f) << unit;
    }
}

}  // namespace
}  // namespace interreflect
