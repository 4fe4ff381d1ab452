#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "voxels/voxelize/sample_pattern.h"
#include "voxels/voxelize/tessellation_pattern.h"

namespace interreflect {
namespace {

TEST(SamplePattern, HasAsManySamplesAsAskedNoTwoInARowOrColumnOfSixteenths) {
    for (const int count : {1, 2, 4, 8}) {
        std::set<float> rows, columns;
        for (const vec2& sample : sample_pattern(count)) {
            for (const float x : {sample.x, sample.y}) {
                EXPECT_GE(x, 0.0f);
                EXPECT_LT(x, 1.0f);
                EXPECT_EQ(x * 16.0f, std::floor(x * 16.0f));
            }
            columns.insert(sample.x), rows.insert(sample.y);
        }
        EXPECT_EQ(rows.size(), static_cast<std::size_t>(count));
        EXPECT_EQ(columns.size(), static_cast<std::size_t>(count));
    }
    for (const int count : {0, 3, 5, 6, 7, 9, 16}) EXPECT_TRUE(sample_pattern(count).empty());
}

TEST(SamplePattern, FourSamplesAreTheStandardOnes) {
    const auto four = sample_pattern(4);
    EXPECT_EQ(four[0], vec2(6, 2) / 16.0f);
    EXPECT_EQ(four[1], vec2(14, 6) / 16.0f);
    EXPECT_EQ(four[2], vec2(2, 10) / 16.0f);
    EXPECT_EQ(four[3], vec2(10, 14) / 16.0f);
}

struct Vertex {
    vec3 weights;
    float share;
};
std::vector<Vertex> vertices_of(const TessellationLevels& levels) {
    std::vector<Vertex> vertices;
    tessellation_rows(levels, [&](const vec3& start, const vec3& along, int count, float share) {
        for (int j = 0; j < count; ++j) vertices.push_back({start + along * static_cast<float>(j), share});
    });
    return vertices;
}

TEST(TessellationPattern, HasTheVerticesOfOpenGL) {
    const auto count = [](int inner, std::array<int, 3> outer) { return vertices_of({outer, inner}).size(); };
    EXPECT_EQ(count(1, {1, 1, 1}), 3U);
    EXPECT_EQ(count(2, {1, 1, 1}), 3U + 1U);
    EXPECT_EQ(count(3, {1, 1, 1}), 3U + 3U);
    EXPECT_EQ(count(4, {1, 1, 1}), 3U + 6U + 1U);
    EXPECT_EQ(count(5, {1, 1, 1}), 3U + 9U + 3U);
    // The thesis' figure 2.3: inner level 5, outer levels 4, 1 and 6.
    EXPECT_EQ(count(5, {4, 1, 6}), 11U + 9U + 3U);
    // An inner level of 1 with more than one part at the border is rounded up to 2: a centre.
    EXPECT_EQ(count(1, {2, 1, 1}), 4U + 1U);
}

TEST(TessellationPattern, InnerCornersLieWherePerpendicularsFromTheFirstPointsOfTheEdgesMeet) {
    // In an equilateral triangle of edge 1: points at 1/n along two edges of corner a, perpendiculars to these edges.
    const vec2 a(0, 0), b(1, 0), c(0.5f, std::sqrt(0.75f));
    const int n = 5;
    const vec2 expected(1.0f / n, 1.0f / (n * std::sqrt(3.0f)));
    float nearest = 1;
    for (const Vertex& v : vertices_of({{1, 1, 1}, n}))
        nearest = std::min(nearest, glm::distance(a * v.weights.x + b * v.weights.y + c * v.weights.z, expected));
    EXPECT_LT(nearest, 1e-6f);  // rounding
}

TEST(TessellationPattern, SharesSumToTheTriangleAndNoVertexLiesOutsideOrTwice) {
    for (int inner = 1; inner <= 9; ++inner)
        for (const std::array<int, 3>& outer : {std::array<int, 3>{1, 1, 1}, {3, 3, 3}, {4, 1, 6}, {7, 2, 64}}) {
            double sum = 0;
            vec3 mean{0};
            std::set<std::array<int, 3>> places;
            const auto vertices = vertices_of({outer, inner});
            for (const Vertex& v : vertices) {
                EXPECT_GT(v.share, 0.0f);
                EXPECT_GE(min_component(v.weights), -1e-6f);
                EXPECT_NEAR(v.weights.x + v.weights.y + v.weights.z, 1.0f, 1e-5f);
                sum += static_cast<double>(v.share);
                mean += v.weights * v.share;
                const vec3 scaled = glm::round(v.weights * 1e4f);
                places.insert({static_cast<int>(scaled.x), static_cast<int>(scaled.y), static_cast<int>(scaled.z)});
            }
            EXPECT_NEAR(sum, 1.0, 1e-5);  // a few dozen additions of single precision
            EXPECT_EQ(places.size(), vertices.size());
        }
}

}  // namespace
}  // namespace interreflect
