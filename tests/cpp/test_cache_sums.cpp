#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "caches/fill/texels.h"
#include "caches/interpolate/cache_reader.h"
#include "caches/interpolate/sum_caches.h"
#include "caches/interpolate/view_lanes.h"
#include "caches/preconvolve.h"
#include "math/rng.h"

namespace interreflect {
namespace {

vec3 unit_vector(Rng& rng) { return glm::normalize(vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5f); }

/// Caches all about the unit cube, half of them on a wall whose normal has a zero of either sign; noise in every texel.
std::shared_ptr<const FilledCaches> noisy_caches(std::size_t count, int resolution, bool image, Rng& rng) {
    auto places = std::make_shared<CachePlaces>();
    places->tile = 8;
    places->position = Buffer<vec3>(count), places->normal = Buffer<vec3>(count), places->screen = Buffer<vec2>(count);
    places->footprint = Buffer<float>(count, 0.4f);
    for (std::size_t i = 0; i < count; ++i) {
        places->position[i] = {rng.uniform(), rng.uniform(), rng.uniform()};
        places->normal[i] = i % 4 < 2 ? vec3(1.0f, 0.0f, i % 2 == 0 ? -0.0f : 0.0f) : unit_vector(rng);
        places->screen[i] = {16 * rng.uniform(), 16 * rng.uniform()};
    }
    FilledCaches filled;
    filled.resolution = resolution;
    const auto noise = [&] {
        Buffer<std::uint16_t> texels(4 * count * filled.texels_each());
        for (std::size_t i = 0; i < texels.size(); i += 4)
            write_texel(texels.data() + i, vec3(rng.uniform(), rng.uniform(), rng.uniform()), rng.uniform());
        return texels;
    };
    filled.texels = noise();
    if (image) filled.sky = noise();
    filled.places = std::move(places);
    return std::make_shared<const FilledCaches>(std::move(filled));
}

/// Pixels all about the cube, two thirds of them with a lobe, of any level. Neighbours in the second half of the groups stand
/// close together and are alike, as in pictures, so that caches pass over some groups and lobes look between the same texels.
void look_about(int count, int levels, Rng& rng, PixelViews& views) {
    views.count = count;
    views.finest = 0, views.coarsest = levels - 1;
    for (int i = 0; i < PixelViews::capacity; ++i) {
        const bool some = i < count;
        const vec3 normal = unit_vector(rng), direction = unit_vector(rng);
        views.pixel[i] = static_cast<std::uint32_t>(i);
        for (int k = 0; k < 3; ++k) {
            views.position[k][i] = some ? rng.uniform() : std::numeric_limits<float>::infinity();
            views.normal[k][i] = normal[k], views.direction[k][i] = direction[k];
        }
        views.screen[0][i] = 16 * rng.uniform(), views.screen[1][i] = 16 * rng.uniform();
        if (const int first = i - i % PixelViews::group; i > PixelViews::capacity / 2 && i > first && some) {
            vec3 near, along;
            for (int k = 0; k < 3; ++k) {
                near[k] = views.normal[k][first] + 0.2f * views.normal[k][i];
                along[k] = views.direction[k][first] + 0.02f * views.direction[k][i];
            }
            for (int k = 0; k < 3; ++k) {
                views.normal[k][i] = glm::normalize(near)[k], views.direction[k][i] = glm::normalize(along)[k];
                views.position[k][i] = views.position[k][first] + 0.05f * views.position[k][i];
            }
            for (int k = 0; k < 2; ++k) views.screen[k][i] = views.screen[k][first] + 0.25f * views.screen[k][i];
        }
        views.level[i] = i % 3 == 0 || !some ? PixelViews::no_lobe : rng.uniform() * static_cast<float>(levels - 1);
    }
    bound_groups(views);
}

void expect_near(const vec4& got, const vec4& expected, float tolerance) {
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(got[k], expected[k], tolerance);
}

/// On every vector target that this machine has; the best one again in the end.
template <class Body>
void on_every_target(const Body& body) {
    for (std::int64_t rest = hwy::SupportedTargets(); rest != 0; rest &= rest - 1) {
        hwy::SetSupportedTargetsForTest(rest & -rest);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        body();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

void compare(int resolution) {
    Rng rng(1, static_cast<std::uint64_t>(resolution));

    const GBuffer gbuffer;
    const Scene scene;
    PixelViews views;
    auto sums = std::make_unique<CacheSums>();
    for (const bool image : {false, true})
        for (const bool world_alone : {false, true}) {
            const auto filled = noisy_caches(400, resolution, image, rng);
            const ConvolvedCaches caches = preconvolve(MipChain{}, filled);
            const CacheWeights weights(WeightKnobs{}, *filled->places, world_alone);
            const CacheReader reader(caches, gbuffer, scene);
            const CacheSummer summer(caches, weights, gbuffer, scene);
            look_about(201, caches.levels(), rng, views);
            std::vector<std::uint32_t> all(filled->places->size());
            std::iota(all.begin(), all.end(), 0u);
            const std::uint64_t evaluations = summer.sum(all, views, *sums);
            std::array<CacheSum, PixelViews::capacity> expected;
            std::uint64_t reached = 0;
            for (std::size_t cache = 0; cache < filled->places->size(); ++cache)
                for (int i = 0; i < views.count; ++i)
                    if (const float weight = weights.weight(cache, views.view(i)); weight > 0.0f)
                        expected[static_cast<std::size_t>(i)].add(reader.read(cache, views.view(i)), weight), ++reached;
            ASSERT_GT(reached, 2000u);
            // Rounding may put a weight of some 1e-7 on either side of zero.
            EXPECT_NEAR(static_cast<double>(evaluations), static_cast<double>(reached), 3.0);
            for (int i = 0; i < views.count; ++i) {
                const CacheSum a = sums->at(i), b = expected[static_cast<std::size_t>(i)];
                // Texels are below 1 and a place is right to 3e-7 sqrt(resolution), or where 1 - z rounds to 4e-4 texels.
                const float tolerance = 2e-3f * b.weight + 1e-6f;
                EXPECT_NEAR(a.weight, b.weight, 1e-5f);
                expect_near(a.diffuse, b.diffuse, tolerance);
                expect_near(a.glossy, b.glossy, tolerance);
                expect_near(vec4(a.diffuse_sky, 0), vec4(b.diffuse_sky, 0), tolerance);
                expect_near(vec4(a.glossy_sky, 0), vec4(b.glossy_sky, 0), tolerance);
                if (i % 3 == 0) {
                    EXPECT_EQ(a.glossy, vec4(0));
                }
                if (!image) {
                    EXPECT_EQ(a.diffuse_sky, vec3(0));
                }
            }
        }
}

TEST(CacheSums, AreWhatIsReadOneByOneOnEveryTarget) {
    // Vectors look into one cell or into many; a map of 1 x 1 has none, one of 2 x 2 one.
    for (const int resolution : {1, 2, 3, 5, 7, 8, 16, 32}) {
        SCOPED_TRACE(resolution);
        on_every_target([&] { compare(resolution); });
    }
}

TEST(CacheWeights, AreZeroWhereARadiusIsZeroAndFiniteWhereTheAngleIsAlmost) {
    Rng rng(5, 5);
    const auto filled = noisy_caches(50, 4, false, rng);
    PixelViews views;
    look_about(200, 3, rng, views);
    WeightKnobs knobs;
    for (const auto& [radius, world_radius, max_angle] : {std::array{0.0, 1.0, 60.0}, {2.0, 0.0, 60.0}, {2.0, 1.0, 1e-4}}) {
        knobs.radius = radius, knobs.world_radius = world_radius, knobs.max_angle = max_angle;
        const CacheWeights weights(knobs, *filled->places, false);
        for (std::size_t cache = 0; cache < 50; ++cache) {
            PixelViews::View view = views.view(static_cast<int>(cache));
            view.position = filled->places->position[cache], view.screen = filled->places->screen[cache];
            view.normal = filled->places->normal[cache];
            const float weight = weights.weight(cache, view);
            EXPECT_TRUE(std::isfinite(weight));
            if (max_angle > 1.0) {
                EXPECT_EQ(weight, 0.0f);
            }
        }
    }
}

}  // namespace
}  // namespace interreflect
