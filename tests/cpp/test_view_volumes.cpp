#include <glm/gtc/packing.hpp>

#include <gtest/gtest.h>

#include "math/rng.h"
#include "math/sampling.h"
#include "voxels/march/march_cones.h"
#include "voxels/march/march_warped.h"

namespace interreflect {
namespace {

constexpr int cells = 32;

/// A view volume full of thin mist, with its eye at the origin, turned and tilted.
Pyramid misty_view(Warp::Kind kind, bool linear_depth) {
    Pyramid pyramid;
    pyramid.domain.cells = ivec3(cells);
    Warp& warp = pyramid.domain.warp;
    warp.kind = kind;
    warp.linear_depth = linear_depth;
    warp.forward = glm::normalize(vec3(1, 0.3f, -0.5f));
    warp.right = glm::normalize(glm::cross(warp.forward, vec3(0, 1, 0)));
    warp.up = glm::cross(warp.right, warp.forward);
    warp.near = 2, warp.far = 40, warp.half_x = 0.9f, warp.half_y = 0.5f;
    if (kind == Warp::Kind::spherical) warp.elevation = 0.2f;
    for (int side = cells; side >= 1; side /= 2) {
        Pyramid::Level level;
        level.size = ivec3(side);
        level.texels = Buffer<std::uint16_t>(4 * level.volume(), glm::packHalf1x16(1e-4f));
        pyramid.levels.push_back(std::move(level));
    }
    return pyramid;
}

/// Whether a point (linear voxels) lies in the volume, to within `margin` voxels of it.
bool holds(const Domain& domain, const vec3& p, float margin) {
    const vec3 q = domain.place(p).voxels;
    return glm::dot(domain.warp.forward, p) > 0.0f && glm::all(glm::greaterThanEqual(q, vec3(-margin))) &&
           glm::all(glm::lessThanEqual(q, vec3(static_cast<float>(cells) + margin)));
}

/// What `visit` gets are cones that begin within and around the volume and go anywhere.
template <class Visit>
void for_each_view(const Visit& visit) {
    for (const auto& [kind, linear] : {std::pair(Warp::Kind::perspective, true), std::pair(Warp::Kind::perspective, false),
                                       std::pair(Warp::Kind::spherical, true)})
        visit(misty_view(kind, linear));
}

TEST(ViewVolumes, AreSeenAtEverySampleThatLiesInThem) {
    for_each_view([](const Pyramid& pyramid) {
        Rng rng(3, 1);
        const AirMap air(pyramid);
        const ConeSchedule schedule = make_schedule({0.01f, 0.25f, 0.25f, -3.0f}, pyramid);
        std::uint64_t seen = 0, least = 0, most = 0;
        for (int i = 0; i < 2000; ++i) {
            ConeBatch batch{};
            batch.count = 1;
            const vec3 at = (vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5f) * 100.0f;
            const vec3 direction = uniform_sphere({rng.uniform(), rng.uniform()});
            set_start(batch, 0, pyramid.domain, at, {0, 0, 1}, 0.0f, true);
            set_direction(batch, 0, direction);
            seen += march_cones(pyramid, air, schedule, 0.0f, batch).fetches / 2;  // two levels a sample
            for (const auto& step : schedule.steps) {
                const vec3 p = at + direction * (batch.scale[0] * step.distance);
                least += holds(pyramid.domain, p, -1e-3f);
                most += holds(pyramid.domain, p, 1e-3f);
            }
        }
        EXPECT_GT(least, 10000);
        EXPECT_GE(seen, least);
        EXPECT_LE(seen, most);
    });
}

TEST(ViewVolumes, StartVectorsOfReceiversWhereTheyStartSingleCones) {
    for_each_view([](const Pyramid& pyramid) {
        const Domain& domain = pyramid.domain;
        Rng rng(5, 1);
        Receivers receivers;
        receivers.count = 0;
        for (int i = 0; i < 99; ++i) {
            const vec3 place = vec3(rng.uniform(), rng.uniform(), rng.uniform()) * static_cast<float>(cells);
            const vec3 normal = uniform_sphere({rng.uniform(), rng.uniform()});
            receivers.add(static_cast<int>(i), domain.from_linear(domain.linear_of({0, place})), normal, normal);
        }
        ConeBatch many{}, one{};
        start_warped(domain, 1.5f, false, receivers, many);
        for (int i = 0; i < receivers.count; ++i) {
            const vec3 position(receivers.position[0][i], receivers.position[1][i], receivers.position[2][i]);
            const vec3 normal(receivers.facing[0][i], receivers.facing[1][i], receivers.facing[2][i]);
            set_start(one, 0, domain, domain.to_linear(position), normal, 1.5f, false);
            const auto expect_near = [&](const float* a, const float* b, float tolerance) {
                EXPECT_NEAR(a[i], b[0], tolerance * (1.0f + std::fabs(b[0]))) << i;
            };
            // Relative, of sums of terms of some tens of voxels in single precision.
            for (const auto field : {&ConeBatch::x, &ConeBatch::y, &ConeBatch::z, &ConeBatch::nx, &ConeBatch::ny, &ConeBatch::nz,
                                     &ConeBatch::width, &ConeBatch::scale, &ConeBatch::axis_cells})
                expect_near(many.*field, one.*field, 1e-4f);
            expect_near(many.height, one.height, 2e-4f * cells);
            EXPECT_EQ(many.aligned[i], 0.0f);
        }
    });
}

}  // namespace
}  // namespace interreflect
