#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "data/geometry.h"
#include "visibility/surface.h"
#include "voxels/voxelize/inner_vertices.h"
#include "voxels/voxelize/nearest_texel.h"
#include "voxels/voxelize/sample_pattern.h"
#include "voxels/voxelize/sample_sums.h"
#include "voxels/voxelize/unseen.h"

namespace interreflect {
namespace {

constexpr int cells = 16;

/// Triangles of at most `size` voxels about places in a box a little larger than the domain.
std::shared_ptr<const Geometry> scattered(std::uint32_t count, float size) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-1.0f, cells + 1.0f), offset(-0.5f * size, 0.5f * size);
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    for (std::uint32_t t = 0; t < count; ++t) {
        const vec3 middle(place(random), place(random), place(random));
        for (int i = 0; i < 3; ++i) positions.push_back(middle + vec3(offset(random), offset(random), offset(random)));
        triangles.push_back(uvec3(0, 1, 2) + 3U * t);
    }
    const MeshView mesh{positions, triangles, {}, {}, 0};
    const Placement placement;
    return make_geometry({&mesh, 1}, {&placement, 1});
}

Domain sixteen() { return {.cells = ivec3(cells)}; }

TEST(TrianglePacket, HoldsWhatEachTriangleHasByItself) {
    const auto geometry = scattered(37, 3.0f);
    const PacketSource source(*geometry, sixteen(), 0);
    TrianglePacket packet;
    for (std::uint32_t first = 0; first < 37; first += TrianglePacket::width) {
        const std::uint32_t count = std::min<std::uint32_t>(TrianglePacket::width, 37 - first);
        load_packet(source, first, count, packet);
        EXPECT_EQ(packet.with_area, (1U << count) - 1U);
        for (std::uint32_t k = 0; k < count; ++k) {
            const int lane = static_cast<int>(k);
            const Corners at = world_corners(*geometry, 0, first + k);
            EXPECT_EQ(packet.corner_of(lane, 0), at.a);
            EXPECT_EQ(packet.corner_of(lane, 2), at.c);
            EXPECT_EQ(packet.cross_of(lane), glm::cross(at.b - at.a, at.c - at.a));
            EXPECT_EQ(packet.offset[lane], self_hit_offset(at.a, at.b, at.c));
            const vec3 lower = glm::min(glm::min(at.a, at.b), at.c), upper = glm::max(glm::max(at.a, at.b), at.c);
            const bool outside = glm::any(glm::lessThan(upper, vec3(0))) || glm::any(glm::greaterThan(lower, vec3(cells)));
            EXPECT_EQ((packet.outside >> k & 1U) != 0, outside);
        }
    }
}

/// Whether a sample lies within a triangle seen along an axis, by its edges in double precision.
bool covers(const Corners& at, int axis, const glm::dvec2& sample) {
    std::array<glm::dvec2, 3> p;
    for (int i = 0; i < 3; ++i) {
        const vec3& corner = i == 0 ? at.a : i == 1 ? at.b : at.c;
        p[i] = {corner[(axis + 1) % 3], corner[(axis + 2) % 3]};
    }
    int left = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec2 along = p[(i + 1) % 3] - p[i], to = sample - p[i];
        left += along.x * to.y - along.y * to.x > 0.0 ? 1 : -1;
    }
    return left == 3 || left == -3;
}
bool covers_any(const Corners& at, std::span<const vec2> samples) {
    const vec3 n = glm::abs(glm::cross(at.b - at.a, at.c - at.a));
    const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    for (int u = -4; u < cells + 4; ++u)
        for (int v = -4; v < cells + 4; ++v)
            for (const vec2& sample : samples)
                if (covers(at, axis, {u + sample.x, v + sample.y})) return true;
    return false;
}

TEST(Unseen, AreOnlyTrianglesThatCoverNoSampleAndNearlyAllOfThoseThatAreSmall) {
    constexpr std::uint32_t count = 512;
    const auto samples = sample_pattern(4);
    const auto geometry = scattered(count, 0.8f);
    const PacketSource source(*geometry, sixteen(), 0);
    const Unseen unseen(samples, 1);
    TrianglePacket packet;
    int empty = 0, found = 0;
    for (std::uint32_t first = 0; first < count; first += TrianglePacket::width) {
        load_packet(source, first, TrianglePacket::width, packet);
        const std::uint32_t passed = unseen.of(packet);
        for (std::uint32_t k = 0; k < TrianglePacket::width; ++k) {
            const bool covered = covers_any(world_corners(*geometry, 0, first + k), samples);
            EXPECT_FALSE(covered && (passed >> k & 1U) != 0) << first + k;
            empty += covered ? 0 : 1;
            found += static_cast<int>(passed >> k & 1U);
        }
    }
    EXPECT_GT(empty, 100);
    EXPECT_GT(found, empty * 9 / 10);  // the rest is too close to an edge to tell
}

TEST(SampleSums, AreThoseOfSamplesTakenOneByOne) {
    constexpr int count = 77, width = 8, height = 4;
    std::mt19937 random(11);
    std::vector<std::uint32_t> texels(width * height);
    for (auto& texel : texels) texel = static_cast<std::uint32_t>(random());
    SampledSurface surface{.corner = {-1, 3, 15},
                           .edge = {{9, 2, 0.5f}, {1, 12, 2}},
                           .texcoord = {-0.3f, 0.2f},
                           .texcoord_edge = {{2.5f, 0.1f}, {0.3f, 1.7f}},
                           .albedo = {0.5f, 0.75f, 1},
                           .srgb = texels.data(),
                           .width = width,
                           .height = height,
                           .cells = ivec3(cells)};
    std::array<float, count + SampleSums::spare> second{}, third{}, area{};
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int i = 0; i < count; ++i) second[i] = unit(random), third[i] = 1.0f - second[i], area[i] = unit(random);
    SampleSums sums;
    sum_samples(surface, {second.data(), third.data(), area.data(), 2.0f}, count, sums);
    int inside = 0;
    for (int i = 0; i < count; ++i) {
        const vec3 position = surface.corner + (surface.edge[0] * second[i] + surface.edge[1] * third[i]);
        const vec2 uv = surface.texcoord + (surface.texcoord_edge[0] * second[i] + surface.texcoord_edge[1] * third[i]);
        if (!sixteen().inside(position)) {
            EXPECT_EQ(sums.cell[i], SampleSums::outside);
            continue;
        }
        ++inside;
        EXPECT_EQ(sums.cell[i], sixteen().cell(ivec3(position)));
        const vec2 place = (uv - glm::floor(uv)) * vec2(width, height);
        const std::uint32_t texel = texels[static_cast<int>(place.y) * width + static_cast<int>(place.x)];
        const vec3 local = (position - glm::floor(position) - 0.5f) * (2.0f * area[i]);
        for (int c = 0; c < 3; ++c) {
            EXPECT_FLOAT_EQ(sums.albedo[i][c], surface.albedo[c] * linear_values[texel >> (8 * c) & 255U] * 2.0f * area[i]);
            EXPECT_FLOAT_EQ(sums.position[i][c], local[c]);
        }
        EXPECT_EQ(sums.albedo[i][3], 2.0f * area[i]);
        EXPECT_EQ(sums.position[i][3], 2.0f * area[i]);
    }
    EXPECT_GT(inside, 20);
    EXPECT_LT(inside, count);
}

TEST(InnerVertices, AreThoseOfThePatternThatDoNotLieOnTheBorder) {
    const InnerVertices vertices;
    for (const int inner : {1, 2, 5, 64}) {
        std::vector<vec3> expected;
        std::vector<float> shares;
        tessellation_inner_rows(inner, [&](const vec3& start, const vec3& along, int count, float share) {
            for (int j = 0; j < count; ++j) expected.push_back(start + along * static_cast<float>(j)), shares.push_back(share);
        });
        ASSERT_EQ(static_cast<std::size_t>(vertices.count(inner)), expected.size());
        for (int i = 0; i < vertices.count(inner); ++i) {
            const SampleWeights one = vertices.weights(inner, i, 3.0f);
            EXPECT_EQ(*one.second, expected[i].y);
            EXPECT_EQ(*one.third, expected[i].z);
            EXPECT_EQ(*one.area, shares[i]);
            EXPECT_EQ(one.scale, 3.0f);
            EXPECT_GT(std::min({expected[i].x, expected[i].y, expected[i].z}), 0.0f);
        }
    }
}

}  // namespace
}  // namespace interreflect
