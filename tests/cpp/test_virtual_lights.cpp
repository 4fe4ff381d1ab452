// Virtual lights: form factors against closed forms, the metric, the warp of points, point maps and the filling of their holes.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <numeric>

#include "math/paraboloid_map.h"
#include "math/radical_inverse.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "virtual_lights/cluster/member_places.h"
#include "virtual_lights/filter/poisson_disk.h"
#include "virtual_lights/sample/importance_pyramid.h"
#include "virtual_lights/shade.h"
#include "virtual_lights/shadow/point_maps.h"

using namespace interreflect;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

VirtualLights one_disk(float radius) {
    VirtualLights lights = make_virtual_lights(1);
    lights.position[0] = {0, 0, 0}, lights.normal[0] = {0, 0, 1}, lights.flux[0] = vec3(1);
    lights.area[0] = pi * radius * radius, lights.offset[0] = 0, lights.members[0] = 1, lights.texel[0] = 0;
    return lights;
}

/// Pixels that look down at the disk's plane from height h, moved sideways.
std::unique_ptr<Receivers> receivers_at(std::initializer_list<vec2> places, const vec3& normal = {0, 0, -1}) {
    auto made = std::make_unique<Receivers>();
    for (const vec2& at : places) {
        const vec3 position{at.x, 0, at.y};
        for (int k = 0; k < 3; ++k) {
            made->position[k][made->count] = position[k];
            made->normal[k][made->count] = made->geometric_normal[k][made->count] = normal[k];
        }
        made->offset[made->count] = 0, made->pixel[made->count] = static_cast<std::uint32_t>(made->count), ++made->count;
    }
    made->fill_up();
    return made;
}

/// Share of the receiver's hemisphere: irradiance of unit radiosity.
template <class Technique>
float form_factor(const Technique& technique, float radius, float sideways, float height, const vec3& normal = {0, 0, -1}) {
    const VirtualLights lights = one_disk(radius);
    const auto receivers = receivers_at({{sideways, height}}, normal);
    PerReceiver result;
    irradiance(technique, DiskLight(lights, 0), *receivers, 1.0f, result);
    return result[0] * lights.area[0];
}

TEST(VirtualLights, TheExactFormFactorIsThatOfClosedForm8) {
    // The polygon of 48 sides departs from the circle by less than a thousandth.
    EXPECT_NEAR(form_factor(DiskIntegral{}, 1, 0, 1), 0.5f, 5e-4f);
    EXPECT_NEAR(form_factor(DiskIntegral{}, 1, 1, 1), 0.276393f, 5e-4f);
    // Upright receivers see the upper half of what is in front: half a disk cut at the horizon.
    const float upright = form_factor(DiskIntegral{}, 1, 0, 1, {1, 0, 0}),
                other = form_factor(DiskIntegral{}, 1, 0, 1, {-1, 0, 0});
    EXPECT_NEAR(upright, other, 1e-6f);
    // Perpendicular receiver on the axis of a disk: (1/pi)(atan(1/X) - X / (1 + X^2)) with X = h / r [Howell B-27].
    EXPECT_NEAR(upright, (std::atan(1.0f) - 0.5f) / pi, 5e-4f);
}

TEST(VirtualLights, PointToDiskIsExactOnTheAxisAndTooSmallOffIt) {
    for (const float height : {0.1f, 1.0f, 10.0f})
        EXPECT_NEAR(form_factor(PointToDisk{}, 1, 0, height), 1 / (1 + height * height), 1e-5f);
    // ERRATA.md: R = h = offset = 1.
    EXPECT_NEAR(form_factor(PointToDisk{}, 1, 1, 1), 0.166667f, 1e-5f);
}

TEST(VirtualLights, TheDisksVectorIsExact) {
    for (const float height : {0.05f, 0.5f, 2.0f})
        for (const float sideways : {0.0f, 0.4f, 1.5f})
            EXPECT_NEAR(form_factor(DiskVector{}, 1, sideways, height), form_factor(DiskIntegral{}, 1, sideways, height), 1e-3f)
                << height << ' ' << sideways;
    const vec3 tilted = glm::normalize(vec3(-1, 0.3f, -0.5f));
    EXPECT_NEAR(form_factor(DiskVector{}, 1, 3, 2, tilted), form_factor(DiskIntegral{}, 1, 3, 2, tilted), 1e-4f);
    EXPECT_NEAR(form_factor(DiskVector{}, 1, 1, 1), 0.276393f, 1e-6f);
}

TEST(VirtualLights, TheDisksVectorIsExactWhereTheHorizonCutsIt) {
    Rng random(3, 1);
    int cut = 0;
    for (int i = 0; i < 4000; ++i) {
        const float height = std::exp2(6 * random.uniform() - 4), sideways = std::exp2(6 * random.uniform() - 4);
        const float u = random.uniform();
        const vec3 normal = uniform_sphere({u, random.uniform()});
        const float exact = form_factor(DiskIntegral{}, 1, sideways, height, normal);
        const float middle = -glm::dot(normal, vec3(sideways, 0, height));
        cut += std::fabs(middle) < std::sqrt(1 - normal.z * normal.z) ? 1 : 0;
        // The polygon departs by up to a thousandth of the disk where a corner stands out of the horizon.
        EXPECT_NEAR(form_factor(DiskVector{}, 1, sideways, height, normal), exact, 2e-3f) << i;
    }
    EXPECT_GT(cut, 1000);
    // On the axis the part above is Howell's B-27, as of the polygon above.
    EXPECT_NEAR(form_factor(DiskVector{}, 1, 0, 1, {1, 0, 0}), (std::atan(1.0f) - 0.5f) / pi, 1e-5f);
}

TEST(VirtualLights, TheDisksVectorIsNeverMoreThanAHemisphere) {
    for (const float height : {1e-10f, 1e-7f, 1e-5f, 1e-3f, 0.1f})
        for (const float sideways : {0.0f, 0.5f, 0.999999f, 1.0f, 1.000001f, 1.5f})
            for (const vec3& normal : {vec3(0, 0, -1), vec3(1, 0, 0), vec3(-1, 0, 0)}) {
                const float factor = form_factor(DiskVector{}, 1, sideways, height, normal);
                EXPECT_TRUE(factor >= 0 && factor <= 1.00001f) << factor << ' ' << height << ' ' << sideways;
            }
}

TEST(VirtualLights, FromFarAwayAllFormFactorsAreThePoints) {
    for (const float sideways : {0.0f, 30.0f}) {
        const float point = form_factor(Point{}, 0.1f, sideways, 40);
        EXPECT_NEAR(form_factor(PointToDisk{}, 0.1f, sideways, 40) / point, 1, 1e-4f);
        EXPECT_NEAR(form_factor(DiskIntegral{}, 0.1f, sideways, 40) / point, 1, 1e-4f);
        EXPECT_NEAR(form_factor(DiskVector{}, 0.1f, sideways, 40) / point, 1, 1e-4f);
    }
    // Both sides of the distance from which on the exact one is a point.
    EXPECT_NEAR(form_factor(DiskIntegral{}, 1, 0, 99.0f) * 99 * 99, form_factor(DiskIntegral{}, 1, 0, 101.0f) * 101 * 101, 2e-3f);
}

TEST(VirtualLights, AClampedPointHasItsBound) {
    const float near = form_factor(ClampedPoint{.bound = 2.0}, 1, 0, 0.01f) / one_disk(1).area[0];
    EXPECT_NEAR(near, 2 / pi, 1e-5f);
    EXPECT_FLOAT_EQ(form_factor(ClampedPoint{.bound = 2.0}, 1, 0, 3), form_factor(Point{}, 1, 0, 3));
}

TEST(VirtualLights, NothingArrivesBehindADiskOrBelowAHorizon) {
    const auto dark = [](const auto& technique) {
        EXPECT_EQ(form_factor(technique, 1, 0, -1, {0, 0, 1}), 0);
        EXPECT_EQ(form_factor(technique, 1, 0, 1, {0, 0, 1}), 0);
    };
    dark(Point{}), dark(ClampedPoint{}), dark(PointToDisk{}), dark(DiskIntegral{}), dark(DiskVector{});
}

TEST(VirtualLights, RoundingDoesNotLiftAReceiverOffItsOwnPlanesDisk) {
    for (const float height : {1e-9f, 1e-7f, 1e-6f})
        for (const float tilt : {0.0f, 1e-7f})
            EXPECT_EQ(form_factor(DiskIntegral{}, 1, 0.3f, height, glm::normalize(vec3(tilt, 0, 1))), 0);
}

TEST(VirtualLights, TheParaboloidMapUndoesItself) {
    for (const vec3& d : {vec3(0, 0, 1), glm::normalize(vec3(1, 2, 3)), glm::normalize(vec3(-5, 1, 0.1f)), vec3(1, 0, 0)}) {
        const vec3 back = paraboloid_direction(paraboloid_square(d));
        EXPECT_NEAR(glm::length(back - d), 0, 1e-6f);
    }
}

TEST(VirtualLights, RadicalInversesMirrorDigits) {
    EXPECT_FLOAT_EQ(radical_inverse(2, 6), 0.375f);
    EXPECT_FLOAT_EQ(radical_inverse(3, 5), 7.0f / 9.0f);
}

ReflectiveShadowMap map_of(int size, const std::vector<float>& flux) {
    ReflectiveShadowMap map;
    map.size = size;
    map.flux = Buffer<vec3>(flux.size());
    for (std::size_t i = 0; i < flux.size(); ++i) map.flux[i] = vec3(flux[i]);
    return map;
}

TEST(VirtualLights, WarpedPointsFallOnTexelsInProportionToTheirImportance) {
    LightMaps maps;
    maps.maps.push_back(map_of(3, {0, 1, 2, 3, 0, 0, 5, 0, 1}));
    maps.maps.push_back(map_of(1, {0}));
    maps.maps.push_back(map_of(2, {0, 0, 4, 0}));
    const ImportancePyramid pyramid(maps, [](const ReflectiveShadowMap& map, std::size_t i) { return map.flux[i].x; });
    EXPECT_DOUBLE_EQ(pyramid.total(), 16);
    std::vector<std::vector<int>> hits{std::vector<int>(9), std::vector<int>(1), std::vector<int>(4)};
    constexpr int n = 1 << 14;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto chosen = pyramid.choose(radical_inverse(2, i), radical_inverse(3, i));
        ++hits[chosen.map][chosen.texel];
        EXPECT_NEAR(chosen.probability, maps.maps[chosen.map].flux[chosen.texel].x / 16, 1e-12);
    }
    for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t i = 0; i < hits[m].size(); ++i)
            EXPECT_NEAR(hits[m][i] / static_cast<double>(n), maps.maps[m].flux[i].x / 16, 2e-3) << m << ' ' << i;
}

TEST(VirtualLights, ADiskIsDrawnWhereTheLightSeesItAtItsPlanesDepth) {
    constexpr int size = 64;
    const auto directions = paraboloid_directions(size);
    std::vector<float> depth(size * size);
    PointMap map(depth, directions, size, vec3(0), vec3(0, 0, 1));
    map.draw_disk({{0, 0, 2}, {0, 0, 1}}, 0.5f);
    double solid_angle = 0;
    for (int i = 0; i < size * size; ++i) {
        if (!std::isfinite(depth[i])) continue;
        EXPECT_NEAR(depth[i] * directions[i].z, 2, 1e-5f);
        const float scale = 2.0f / size * (1 + directions[i].z);  // the paraboloid's: (1 + cos)^2 times the square's area
        solid_angle += scale * scale;
    }
    EXPECT_NEAR(solid_angle, 2 * pi * (1 - std::cos(std::atan(0.25f))), 0.02f);
}

TEST(VirtualLights, HolesAreFilledFromCoarserLevelsAndCounted) {
    constexpr int size = 8;
    const auto directions = paraboloid_directions(size);
    std::vector<float> depth(size * size, 3.0f);
    depth[3 * size + 3] = infinity;
    const Filled filled = pull_push(depth, size, 1, directions);
    EXPECT_EQ(filled.empty, 1u);
    EXPECT_EQ(filled.filled, 1u);
    EXPECT_EQ(depth[3 * size + 3], 3.0f);
    // A hole of 4 x 4 texels: two levels up every coarse texel of its middle has neighbours.
    for (int y = 2; y < 6; ++y)
        for (int x = 2; x < 6; ++x) depth[y * size + x] = infinity;
    auto again = depth;
    EXPECT_EQ(pull_push(again, size, 1, directions).filled, 0u);
    EXPECT_EQ(pull_push(depth, size, 2, directions).filled, 16u);
    std::vector<float> none(size * size, infinity);
    EXPECT_EQ(pull_push(none, size, 3, directions).filled, 0u);
}

TEST(VirtualLights, PoissonDisksKeepTheirDistance) {
    const auto& points = poisson_disk();
    for (const int n : {8, 16, 64}) {
        float least = 2;
        for (int i = 0; i < n; ++i) {
            EXPECT_LE(glm::length(points[i]), 1.0f);
            for (int j = 0; j < i; ++j) least = std::min(least, glm::length(points[i] - points[j]));
        }
        // A hexagonal lattice has 1.9 / sqrt(n).
        EXPECT_GT(least, 0.9f / std::sqrt(static_cast<float>(n))) << n;
    }
}

/// A map of one surface in the plane y = 0 whose texel (x, z) lies there; the right half sends three times as much on.
LightMaps flat_map(int side) {
    ReflectiveShadowMap map;
    const auto n = static_cast<std::size_t>(side) * side;
    map.size = side;
    map.position = Buffer<vec3>(n), map.normal = Buffer<vec3>(n), map.flux = Buffer<vec3>(n), map.offset = Buffer<float>(n);
    for (int z = 0; z < side; ++z)
        for (int x = 0; x < side; ++x) {
            const std::size_t i = static_cast<std::size_t>(z) * side + x;
            map.position[i] = {x, 0, z}, map.normal[i] = {0, 1, 0}, map.offset[i] = 0.25f;
            map.flux[i] = vec3(2 * x < side ? 1.0f : 3.0f);
        }
    LightMaps maps;
    maps.maps.push_back(std::move(map));
    return maps;
}

TEST(VirtualLights, PlacesAreMembersInProportionToTheirFlux) {
    constexpr int side = 48;  // of which every fourth texel is looked at, as many of either half
    const LightMaps maps = flat_map(side);
    // Cluster 0: the upper half; 1: one texel between those that are looked at; 2: the rest.
    Buffer<std::uint32_t> cluster(side * side);
    for (std::uint32_t i = 0; i < side * side; ++i) cluster[i] = i < side * side / 2 ? 0u : 2u;
    const std::uint32_t alone = 40 * side + 37, centres[] = {10 * side + 10, alone, 44 * side + 44};
    cluster[alone] = 1;
    const auto places = member_places(maps, cluster, centres);
    int bright = 0;
    for (int k = 0; k < MemberPlaces::count; ++k) {
        EXPECT_LT(places[0].position[2][k], 24.0f);
        EXPECT_GE(places[2].position[2][k], 24.0f);
        EXPECT_EQ(places[1].position[0][k], 37.0f);
        EXPECT_EQ(places[1].position[2][k], 40.0f);
        EXPECT_EQ(places[0].position[1][k], 0.25f);  // off the surface
        EXPECT_EQ(places[0].normal[1][k], 1.0f);
        bright += places[0].position[0][k] >= side / 2 ? 1 : 0;
    }
    EXPECT_EQ(bright, 12);  // three quarters of 16
}

TEST(VirtualLights, ADiskThatIsHeldToItsMembersBringsWhatTheirFormFactorsSay) {
    VirtualLights lights = one_disk(0.1f);
    lights.places = Buffer<MemberPlaces>(1);
    double expected = 0;
    for (int k = 0; k < MemberPlaces::count; ++k) {
        // Apart from each other, one behind the receiver's horizon and one turned away.
        const vec3 at{-1.0f + 0.2f * static_cast<float>(k), 0, k == 3 ? 1.5f : 0.0f};
        const vec3 normal = k == 5 ? vec3(0, 0, -1) : vec3(0, 0, 1);
        for (int i = 0; i < 3; ++i) lights.places[0].position[i][k] = at[i], lights.places[0].normal[i][k] = normal[i];
        const double square = (at.x - 0.5) * (at.x - 0.5) + 1.0;
        if (k != 3 && k != 5) expected += 1 / (square * (pi * square + lights.area[0] / 16)) / 16;
    }
    const auto receivers = receivers_at({{0.5f, 1}});
    PerReceiver result;
    irradiance(MemberBoundedDisk{.bound = 1.0}, DiskLight(lights, 0), *receivers, 1.0f, result);
    EXPECT_NEAR(result[0], expected, 1e-5 * expected);
    // Two of sixteen members bring nothing, and others are further away: the disk alone brings more, and by less than the bound.
    PerReceiver disk, loose, tight;
    irradiance(DiskVector{}, DiskLight(lights, 0), *receivers, 1.0f, disk);
    irradiance(MemberBoundedDisk{}, DiskLight(lights, 0), *receivers, 1.0f, loose);
    irradiance(MemberBoundedDisk{.bound = 1.1}, DiskLight(lights, 0), *receivers, 1.0f, tight);
    EXPECT_EQ(loose[0], disk[0]);
    EXPECT_NEAR(tight[0], (disk[0] > expected ? 1.1 : 1 / 1.1) * expected, 1e-5 * expected);
}

TEST(VirtualLights, ALightWithoutMembersIsItsDisk) {
    for (const float sideways : {0.0f, 0.4f, 1.5f})
        EXPECT_EQ(form_factor(MemberBoundedDisk{}, 1, sideways, 0.7f), form_factor(DiskVector{}, 1, sideways, 0.7f));
}

}  // namespace
