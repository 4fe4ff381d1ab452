// Where surfels stand: on the surface, as many as its area asks for, ever more evenly.
#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include "math/rng.h"
#include "surfels/place.h"
#include "surfels/place/spacing.h"

namespace interreflect {
namespace {

float random(std::uint32_t i) { return unit_float(hash32(i)); }

struct World {
    std::vector<vec3> positions;
    std::vector<vec2> texcoords;
    std::vector<uvec3> triangles;
    Scene scene;
    std::shared_ptr<const Intersector> intersector;

    void triangle(const vec3& a, const vec3& b, const vec3& c) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const vec3& p : {a, b, c}) positions.push_back(p), texcoords.push_back({p.x, p.y});
        triangles.push_back({first, first + 1, first + 2});
    }
    void parallelogram(const vec3& corner, const vec3& a, const vec3& b) {
        triangle(corner, corner + a, corner + a + b);
        triangle(corner, corner + a + b, corner + b);
    }
    void finish() {
        if (scene.materials.empty()) scene.materials.resize(1);
        const MeshView mesh{positions, triangles, {}, texcoords, 0};
        const Placement placement{};
        scene.geometry = make_geometry({&mesh, positions.empty() ? 0u : 1u}, {&placement, positions.empty() ? 0u : 1u});
        finish_scene(scene);
        intersector = std::make_shared<Intersector>(scene.geometry, scene.materials, scene.masks);
    }
    template <class Technique>
    Surfels place(const Technique& technique) const {
        return place_surfels(technique, scene, *intersector);
    }
    double area(std::size_t t) const {
        const vec3 a = positions[triangles[t].x], b = positions[triangles[t].y], c = positions[triangles[t].z];
        return 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
    }
    double area() const {
        double sum = 0;
        for (std::size_t t = 0; t < triangles.size(); ++t) sum += area(t);
        return sum;
    }
};

World square() {
    World w;
    w.parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    w.finish();
    return w;
}
/// Triangles of areas between a ten-millionth and one, some of them none at all.
World crumbs() {
    World w;
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const auto corner = [i](std::uint32_t k) {
            return vec3(random(16 * i + k), random(16 * i + k + 1), random(16 * i + k + 2));
        };
        const float size = std::pow(10.0f, -3.5f * random(16 * i + 9));
        const vec3 a = 10.0f * corner(0);
        if (i % 50 == 0)
            w.triangle(a, a + vec3(1), a + vec3(2));
        else
            w.triangle(a, a + size * corner(3), a + size * corner(6));
    }
    w.finish();
    return w;
}
/// A box and a half cylinder of 24 sides, which faces outwards: edges, corners, curves.
World room() {
    World w;
    const vec3 x(2, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0);
    w.parallelogram(o, y, x), w.parallelogram(z, x, y);
    w.parallelogram(o, x, z), w.parallelogram(y, z, x);
    w.parallelogram(o, z, y), w.parallelogram(x, y, z);
    const auto rim = [](int i, float height) {
        const float turn = pi * static_cast<float>(i) / 24;
        return vec3(4 + std::cos(turn), std::sin(turn), height);
    };
    for (int i = 0; i < 24; ++i) w.parallelogram(rim(i, 0), rim(i + 1, 0) - rim(i, 0), {0, 0, 2});
    w.finish();
    return w;
}

/// Every surfel lies where its triangle and barycentric weights say, and points to the triangle's front.
void expect_on_surface(const World& w, const Surfels& s) {
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Corners c = world_corners(*w.scene.geometry, 0, s.triangle[i]);
        const vec2 b = s.barycentric[i];
        // The ray library's own rounding.
        EXPECT_GE(std::min({b.x, b.y, 1 - b.x - b.y}), -1e-5f);
        EXPECT_LE(glm::length(c.a + (c.b - c.a) * b.x + (c.c - c.a) * b.y - s.position[i]), 1e-6f * s.extent);
        EXPECT_GE(glm::dot(s.normal[i], glm::normalize(glm::cross(c.b - c.a, c.c - c.a))), 1 - 1e-6f);
    }
}

template <class Technique>
class SurfelPlaces : public testing::Test {};
using Techniques = testing::Types<HaltonSurfels, XorshiftSurfels, RelaxedSurfels>;
TYPED_TEST_SUITE(SurfelPlaces, Techniques);

TYPED_TEST(SurfelPlaces, AreasAddUpToTheSurfacesWhateverTheCount) {
    for (const World& w : {square(), crumbs(), room()})
        for (const int count : {1, 10, 1000, 100000}) {
            TypeParam technique{count};
            if constexpr (requires { technique.iterations; }) technique.iterations = 2;
            const Surfels s = w.place(technique);
            ASSERT_EQ(s.size(), static_cast<std::size_t>(count));
            const double sum = std::accumulate(s.area.begin(), s.area.end(), 0.0);
            EXPECT_NEAR(sum, w.area(), 1e-7 * w.area());  // each area is rounded to a float
            EXPECT_EQ(*std::min_element(s.area.begin(), s.area.end()), *std::max_element(s.area.begin(), s.area.end()));
        }
}

TYPED_TEST(SurfelPlaces, AllLieOnTheirTriangles) {
    for (const World& w : {square(), crumbs(), room()}) expect_on_surface(w, w.place(TypeParam{3000}));
}

TYPED_TEST(SurfelPlaces, NothingHasNoSurfels) {
    World empty;
    empty.finish();
    EXPECT_EQ(empty.place(TypeParam{100}).size(), 0u);
    EXPECT_EQ(square().place(TypeParam{0}).size(), 0u);
    World flat;
    flat.triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    flat.finish();
    EXPECT_EQ(flat.place(TypeParam{100}).size(), 0u);
    EXPECT_EQ(surfel_spacing(flat.place(TypeParam{100})).size(), 0u);
}

TYPED_TEST(SurfelPlaces, WhatAMaskLeavesOutHasNone) {
    World w;
    for (int i = 0; i < 30; ++i)
        for (int j = 0; j < 30; ++j) w.parallelogram(vec3(i, j, 0) / 30.0f, {1.0f / 30, 0, 0}, {0, 1.0f / 30, 0});
    w.scene.materials.resize(1);
    w.scene.materials[0].mask = 0;
    std::vector<std::uint8_t> checks(16 * 16);
    for (std::size_t i = 0; i < checks.size(); ++i) checks[i] = ((i / 4) ^ (i / 64)) & 1;
    w.scene.masks.push_back(std::make_shared<Mask>(checks, 16, 16));
    w.finish();
    const Surfels s = w.place(TypeParam{4000});
    for (const vec3& p : s.position) EXPECT_TRUE(w.scene.masks[0]->solid({p.x, p.y})) << p.x << ' ' << p.y;
    // Half of it, to four standard deviations of random points.
    EXPECT_NEAR(std::accumulate(s.area.begin(), s.area.end(), 0.0), 0.5, 4 * 0.5 / std::sqrt(4000.0));
}

TYPED_TEST(SurfelPlaces, ThreadsDoNotChangeThem) {
    const World w = room();
    const Surfels all = w.place(TypeParam{5000});
    oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    const Surfels again = w.place(TypeParam{5000});
    EXPECT_TRUE(std::equal(all.position.begin(), all.position.end(), again.position.begin(), again.position.end()));
    EXPECT_TRUE(std::equal(all.triangle.begin(), all.triangle.end(), again.triangle.begin(), again.triangle.end()));
}

TEST(SurfelsByArea, EveryTriangleGetsItsShareToOne) {
    const World w = crumbs();
    for (const int count : {10, 777, 20000}) {
        std::vector<double> got(w.triangles.size());
        for (const std::uint32_t t : w.place(HaltonSurfels{count}).triangle) ++got[t];
        for (std::size_t t = 0; t < got.size(); ++t) EXPECT_NEAR(got[t], w.area(t) / w.area() * count, 1) << t;
    }
}

struct Evenness {
    double fifth_percentile, mean, variation;  // of distances over the root of the area; deviation over the mean
};
Evenness evenness(const Surfels& s) {
    Buffer<float> spacing = surfel_spacing(s);
    std::sort(spacing.begin(), spacing.end());
    double sum = 0, squares = 0;
    for (const float d : spacing) sum += static_cast<double>(d), squares += static_cast<double>(d) * static_cast<double>(d);
    const double n = static_cast<double>(spacing.size()), mean = sum / n;
    return {static_cast<double>(spacing[spacing.size() / 20]), mean, std::sqrt(squares / n - mean * mean) / mean};
}

TEST(SurfelSpacing, IsTheDistanceToTheNearestOnTheSameSide) {
    Surfels s = make_surfels(500);
    s.extent = 45;
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        s.position[i] = {random(5 * i), random(5 * i + 1), i % 20 == 0 ? 1 + random(5 * i + 2) : 0.0f};
        s.normal[i] = {0, 0, i % 3 == 0 ? -1.0f : 1.0f};
        s.area[i] = 1e-3f * (1 + random(5 * i + 3));
    }
    s.position[7] = {40, 0, 0};            // far from all
    s.normal[11] = {1, 0, 0};              // alone on its side
    s.position[13] = s.position[14];       // at one place, on both sides
    s.position[22] = s.position[13 + 12];  // at one place, on one side
    const Buffer<float> spacing = surfel_spacing(s);
    for (std::size_t i = 0; i < s.size(); ++i) {
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t j = 0; j < s.size(); ++j)
            if (j != i && glm::dot(s.normal[i], s.normal[j]) > 0.5f)
                nearest = std::min(nearest, glm::length(s.position[j] - s.position[i]));
        EXPECT_EQ(spacing[i], nearest / std::sqrt(s.area[i])) << i;
    }
}

TEST(SurfelSpacing, RandomPointsAreSpacedAsTheoryHasIt) {
    const Evenness e = evenness(square().place(XorshiftSurfels{100000}));
    // Rayleigh's distribution: mean 1/2, deviation over it sqrt(4/pi - 1), fifth percentile sqrt(-ln 0.95 / pi). A percentile's
    // standard error is 0.001; the border, 4 * 0.003 of the points, adds a thousandth.
    EXPECT_NEAR(e.mean, 0.5, 0.004);
    EXPECT_NEAR(e.variation, 0.5227, 0.006);
    EXPECT_NEAR(e.fifth_percentile, 0.1278, 0.004);
}

TEST(SurfelSpacing, HaltonIsMoreEvenThanRandomAndRelaxedMoreThanHalton) {
    for (const World& w : {square(), room()}) {
        const Evenness random = evenness(w.place(XorshiftSurfels{6000})), halton = evenness(w.place(HaltonSurfels{6000})),
                       relaxed = evenness(w.place(RelaxedSurfels{6000}));
        EXPECT_GT(halton.fifth_percentile, 1.5 * random.fifth_percentile);
        EXPECT_GT(relaxed.fifth_percentile, 1.5 * halton.fifth_percentile);
        EXPECT_LT(halton.variation, 0.9 * random.variation);
        EXPECT_LT(relaxed.variation, 0.5 * halton.variation);
    }
}

TEST(SurfelSpacing, RelaxedSurfelsAreBlueNoise) {
    // Random disks that fill 0.547 of the plane [Hinrichsen et al. 1986] are nowhere nearer than 2 sqrt(0.547 / pi).
    EXPECT_GT(evenness(square().place(RelaxedSurfels{6000})).fifth_percentile, 0.8346);
}

TEST(RelaxedSurfels, WithoutIterationsAreHaltons) {
    const World w = room();
    const Surfels relaxed = w.place(RelaxedSurfels{1000, 0}), halton = w.place(HaltonSurfels{1000});
    EXPECT_TRUE(std::equal(relaxed.position.begin(), relaxed.position.end(), halton.position.begin(), halton.position.end()));
}

TEST(RelaxedSurfels, StayOnTheirLayer) {
    // A sheet a tenth of the spacing above a floor, half as large: none climbs up to it or falls from it.
    World w;
    w.parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    w.parallelogram({0.2f, 0.2f, 0.002f}, {0.7f, 0, 0}, {0, 0.7f, 0});
    w.finish();
    const auto above = [&](const Surfels& s) {
        return std::count_if(s.triangle.begin(), s.triangle.end(), [](std::uint32_t t) { return t >= 2; });
    };
    EXPECT_EQ(above(w.place(RelaxedSurfels{3000})), above(w.place(HaltonSurfels{3000})));
}

}  // namespace
}  // namespace interreflect
