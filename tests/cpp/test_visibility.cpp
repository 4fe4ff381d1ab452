#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "data/environment.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "shading/lights.h"
#include "visibility/depth_map.h"
#include "visibility/trace_gbuffer.h"

namespace interreflect {
namespace {

struct World {
    Scene scene;
    std::shared_ptr<const Intersector> intersector;

    void finish() {
        finish_scene(scene);
        intersector = std::make_shared<Intersector>(scene.geometry, scene.materials, scene.masks);
    }
    GBuffer view(const Camera& camera, int width, int height) const {
        return trace_gbuffer(scene, *intersector, camera, width, height);
    }
};

struct Arrays {
    std::vector<vec3> positions, normals;
    std::vector<vec2> texcoords;
    std::vector<uvec3> triangles;
    MeshView mesh(std::uint32_t material = 0) const { return {positions, triangles, normals, texcoords, material}; }
};

/// A square of side 2 `half` in the plane z = 0 that faces +z, texture coordinates `repeats` times over it.
Arrays square(float half, float repeats = 1) {
    return {{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}},
            {},
            {{0, 0}, {repeats, 0}, {repeats, repeats}, {0, repeats}},
            {{0, 1, 2}, {0, 2, 3}}};
}
/// A unit sphere with its true normals.
Arrays sphere(int n) {
    Arrays a;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= 2 * n; ++i) {
            const float theta = pi * static_cast<float>(j) / n, phi = pi * static_cast<float>(i) / n;
            a.positions.push_back({std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)});
        }
    a.normals = a.positions;
    const auto row = static_cast<std::uint32_t>(2 * n + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(n); ++j)
        for (std::uint32_t i = 0; i + 1 < row; ++i) {
            const std::uint32_t p = j * row + i;
            if (j > 0) a.triangles.push_back({p, p + row, p + 1});
            if (j + 1 < static_cast<std::uint32_t>(n)) a.triangles.push_back({p + 1, p + row, p + row + 1});
        }
    return a;
}
Arrays soup(int count, std::uint32_t seed) {
    Rng rng(seed, 1);
    const auto point = [&] { return vec3(rng.uniform(), rng.uniform(), rng.uniform()); };
    Arrays a;
    for (int i = 0; i < count; ++i) {
        const vec3 centre = point();
        for (int k = 0; k < 3; ++k) {
            a.positions.push_back(centre + 0.7f * (point() - 0.5f));
            a.texcoords.push_back({rng.uniform(), rng.uniform()});
        }
        const auto first = static_cast<std::uint32_t>(3 * i);
        a.triangles.push_back({first, first + 1, first + 2});
    }
    return a;
}
World world_of(const std::vector<MeshView>& meshes, const std::vector<Placement>& placements) {
    World w;
    w.scene.geometry = make_geometry(meshes, placements);
    w.scene.materials.resize(1);
    return w;
}

/// Solid, cut-out and placed triangles together.
World mixed_world() {
    static const Arrays solid = soup(60, 1), cut = soup(60, 2), placed = soup(20, 3);
    mat4 there(0.5f);
    there[3] = vec4(0.6f, 0.2f, -0.3f, 1);
    World w = world_of({solid.mesh(0), cut.mesh(1), placed.mesh(1)}, {{0}, {1}, {2, there, 1}});
    w.scene.materials.resize(2);
    w.scene.materials[1].mask = 0;
    std::vector<std::uint8_t> checks(64 * 64);
    for (std::size_t i = 0; i < checks.size(); ++i) checks[i] = ((i / 4) ^ (i / 256)) & 1;
    w.scene.masks.push_back(std::make_shared<Mask>(checks, 64, 64));
    w.finish();
    return w;
}
std::vector<Ray> random_rays(int count) {
    Rng rng(7, 8);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        const vec3 from(2 * rng.uniform() - 0.5f, 2 * rng.uniform() - 0.5f, 2 * rng.uniform() - 0.5f);
        ray = {from, 0, uniform_sphere({rng.uniform(), rng.uniform()}), 1.5f};
    }
    return rays;
}

/// Any hits in every lane of a packet, the other lanes being idle.
std::vector<std::uint8_t> blocked_in_lanes(const Intersector& intersector, const std::vector<Ray>& rays) {
    std::vector<std::uint8_t> blocked(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        RayPacket packet;
        packet.set(static_cast<int>(i % RayPacket::width), rays[i]);
        blocked[i] = intersector.occluded(packet, 1U << (i % RayPacket::width)) != 0;
    }
    return blocked;
}

TEST(Intersector, PacketsAndStreamsFindWhatSingleRaysFind) {
    const World w = mixed_world();
    const std::vector<Ray> rays = random_rays(4099);
    std::vector<Hit> coherent(rays.size()), incoherent(rays.size());
    std::vector<std::uint8_t> streamed(rays.size()), blocked = blocked_in_lanes(*w.intersector, rays);
    w.intersector->nearest_coherent(rays, coherent);
    w.intersector->nearest_incoherent(rays, incoherent);
    w.intersector->occluded_incoherent(rays, streamed);
    int hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit single = w.intersector->nearest(rays[i]);
        hits += single.valid();
        for (const Hit& other : {coherent[i], incoherent[i]}) {
            EXPECT_EQ(other.triangle, single.triangle);
            EXPECT_EQ(other.instance, single.instance);
            EXPECT_EQ(other.distance, single.distance);
        }
        EXPECT_EQ(blocked[i] != 0, single.valid());
        EXPECT_EQ(streamed[i] != 0, single.valid());
        EXPECT_EQ(w.intersector->occluded(rays[i]), single.valid());
    }
    EXPECT_GT(hits, 500);  // the comparison saw both
    EXPECT_LT(hits, 4000);
    EXPECT_GT(w.intersector->bytes(), 140 * sizeof(vec3));  // at least the corners of the triangles
}

/// Leaves `value` where the frames of the next calls will lie.
[[gnu::noinline]] void dirty_the_stack(int value) {
    std::array<volatile std::uint8_t, 1 << 16> frames;
    for (auto& byte : frames) byte = static_cast<std::uint8_t>(value);
}

TEST(Intersector, WhatLiesOnTheStackDoesNotMatterToPackets) {
    const World w = mixed_world();
    for (const int left : {0, 0xbf, 0xff})
        for (const Ray& ray : random_rays(50)) {
            RayPacket packet;
            packet.set(0, ray);
            dirty_the_stack(left);
            EXPECT_EQ(w.intersector->occluded(packet, 1) != 0, w.intersector->nearest(ray).valid());
            packet.set(0, ray);
            dirty_the_stack(left);
            w.intersector->nearest(packet, 1);
            EXPECT_EQ(packet.hit(0).valid(), w.intersector->nearest(ray).valid());
        }
}

TEST(Intersector, HitsLieOnTheSolidPartOfTheTriangleTheyName) {
    const World w = mixed_world();
    for (const Ray& ray : random_rays(2000)) {
        const Hit hit = w.intersector->nearest(ray);
        if (!hit.valid()) continue;
        const HitGeometry at = hit_geometry(*w.scene.geometry, hit.instance, hit.triangle, hit.u, hit.v);
        EXPECT_LT(glm::length(ray.origin + ray.direction * hit.distance - at.position), 1e-5f);
        const int mask = w.scene.materials[w.scene.material_of(hit.triangle)].mask;
        EXPECT_TRUE(mask < 0 || w.scene.masks[mask]->solid(at.texcoord));
    }
}

TEST(GBuffer, APlaneSeenFromAboveHasItsDepthAndNormal) {
    const Arrays plane = square(100);
    World w = world_of({plane.mesh()}, {{0}});
    w.finish();
    const Camera camera{{0.3f, 0.2f, 2}, {1, 0.5f, 0}, {0, 0, 1}, 70};
    const GBuffer g = w.view(camera, 45, 31);  // no multiples of a packet
    const CameraRays rays(camera, 45, 31);
    for (int y = 0; y < 31; ++y)
        for (int x = 0; x < 45; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * 45 + x;
            const vec3 d = rays.direction(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            ASSERT_LT(d.z, 0.0f);
            EXPECT_NEAR(g.depth[i], -2 / d.z, 2e-6f * -2 / d.z);
            EXPECT_NEAR(g.position[i].z, 0, 1e-6f);
            EXPECT_EQ(g.normal[i], vec3(0, 0, 1));
            EXPECT_EQ(g.geometric_normal[i], vec3(0, 0, 1));
            EXPECT_EQ(g.albedo[i], vec3(0.5f));
            EXPECT_EQ(g.emission[i], vec3(0));
        }
    EXPECT_EQ(g.counts.rays, 45U * 31U);
}

TEST(GBuffer, ASphereIsSmoothAndBeyondItLiesTheEnvironment) {
    const Arrays ball = sphere(64);
    World w = world_of({ball.mesh()}, {{0}});
    w.scene.environment = Environment{vec3(1, 2, 3), 0, 0, {}, mat3(1)};
    w.finish();
    const GBuffer g = w.view({{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 50}, 64, 64);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < g.pixels(); ++i) {
        if (!g.hit(i)) {
            EXPECT_EQ(g.emission[i], vec3(1, 2, 3));
            EXPECT_TRUE(std::isinf(g.depth[i]));
            continue;
        }
        ++hits;
        // Interpolated normals follow the sphere's but for the square of an edge, pi / 64, over 8.
        const float facing = glm::dot(g.geometric_normal[i], glm::normalize(vec3(0, 0, 4) - g.position[i]));
        if (facing > 0.2f) {
            EXPECT_LT(glm::length(g.normal[i] - glm::normalize(g.position[i])), 3e-3f);
        }
        EXPECT_GT(glm::dot(g.normal[i], vec3(0, 0, 4) - g.position[i]), 0.0f);
    }
    EXPECT_GT(hits, 500U);
}

/// The scalar definition of every pixel, from single rays.
void expect_pixels_as_defined(const World& w, const Camera& camera, int width, int height) {
    const GBuffer g = w.view(camera, width, height);
    const CameraRays rays(camera, width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * width + x;
            const float cx = static_cast<float>(x) + 0.5f, cy = static_cast<float>(y) + 0.5f;
            const vec3 d = rays.direction(cx, cy);
            const Hit hit = w.intersector->nearest({rays.origin, 0, d});
            ASSERT_EQ(g.triangle[i], hit.triangle) << x << ", " << y;
            if (!hit.valid()) continue;
            const SurfacePoint p = surface_at(w.scene, hit, d, pixel_footprint(w.scene, hit, rays, cx, cy));
            // The vectors fuse multiplications and additions, and their sRGB curve is a polynomial.
            EXPECT_LT(glm::length(g.position[i] - p.position), 1e-5f);
            EXPECT_LT(glm::length(g.normal[i] - p.normal), 1e-4f);
            EXPECT_LT(glm::length(g.geometric_normal[i] - p.geometric_normal), 1e-5f);
            EXPECT_LT(glm::length(g.albedo[i] - p.albedo), 2e-4f);
            EXPECT_LT(glm::length(g.specular[i] - p.specular), 1e-6f);
            EXPECT_LT(glm::length(g.emission[i] - p.emission), 1e-6f);
            EXPECT_EQ(g.alpha[i], p.alpha);
            EXPECT_NEAR(g.offset[i], p.offset, 1e-7f * p.offset);
            EXPECT_EQ(g.instance[i], hit.instance);
            EXPECT_EQ(g.body[i], w.scene.geometry->instances[hit.instance].body);
        }
}

std::shared_ptr<const Texture> noise_texture(int width, int height) {
    Rng rng(3, 4);
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * height * 3);
    for (auto& p : pixels) p = static_cast<std::uint8_t>(rng.next() >> 24);
    return std::make_shared<Texture>(Texture::from_srgb8(pixels, width, height, 3));
}

TEST(GBuffer, VectorsShadeAsTheDefinitionSays) {
    World w = mixed_world();
    w.scene.textures = {noise_texture(37, 64), noise_texture(16, 5)};
    w.scene.materials[0].albedo_map = 0;
    w.scene.materials[1].albedo_map = 1;
    w.scene.materials[1].specular = vec3(0.3f, 0.2f, 0.1f);
    w.scene.materials[1].two_sided = false;
    expect_pixels_as_defined(w, {{0.5f, 0.4f, 2.5f}, {0.5f, 0.5f, 0}, {0, 1, 0}, 45}, 50, 43);
    w.scene.materials[0].emission = vec3(1, 2, 3);
    expect_pixels_as_defined(w, {{0.5f, 0.4f, 2.5f}, {0.5f, 0.5f, 0}, {0, 1, 0}, 45}, 21, 17);
}

TEST(GBuffer, AnInstanceLooksLikeItsBakedCopy) {
    const Arrays ball = sphere(12);
    mat4 there(1.0f);
    there[0] = vec4(0.6f, 0.8f, 0, 0), there[1] = vec4(-0.8f, 0.6f, 0, 0), there[3] = vec4(0.2f, -0.1f, 0.3f, 1);
    World baked = world_of({ball.mesh()}, {{0, there, 0}}), placed = world_of({ball.mesh()}, {{0, there, 1}});
    baked.finish();
    placed.finish();
    const Camera camera{{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40};
    const GBuffer a = baked.view(camera, 48, 48), b = placed.view(camera, 48, 48);
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        ASSERT_EQ(a.hit(i), b.hit(i));
        if (!a.hit(i)) continue;
        EXPECT_LT(glm::length(a.position[i] - b.position[i]), 1e-5f);
        EXPECT_LT(glm::length(a.normal[i] - b.normal[i]), 1e-4f);
        EXPECT_EQ(b.body[i], 1U);
    }
}

TEST(GBuffer, FilteredTexturesAgreeWithSupersampling) {
    // A tilted, finely textured square: about eight texels a pixel nearby, more far away.
    const Arrays plane = square(20, 20);
    World w = world_of({plane.mesh()}, {{0}});
    w.scene.textures = {noise_texture(64, 64)};
    w.scene.materials[0].albedo = vec3(1);
    w.scene.materials[0].albedo_map = 0;
    w.finish();
    const Camera camera{{0, -6, 6}, {0, 0, 0}, {0, 0, 1}, 40};
    constexpr int size = 24, finer = 32;
    const GBuffer coarse = w.view(camera, size, size), fine = w.view(camera, size * finer, size * finer);
    double filtered = 0, centre = 0;
    const CameraRays rays(camera, size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            vec3 mean(0);
            for (int j = 0; j < finer; ++j)
                for (int i = 0; i < finer; ++i)
                    mean += fine.albedo[static_cast<std::size_t>(y * finer + j) * size * finer + x * finer + i];
            mean /= static_cast<float>(finer * finer);
            const vec3 d = rays.direction(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const vec3 unfiltered = surface_at(w.scene, w.intersector->nearest({rays.origin, 0, d}), d).albedo;
            const vec3 error = coarse.albedo[static_cast<std::size_t>(y) * size + x] - mean;
            filtered += glm::dot(error, error);
            centre += glm::dot(unfiltered - mean, unfiltered - mean);
        }
    // Noise that eight by eight texels average loses all but an eighth of its deviation; the filter's own shape may cost as much.
    EXPECT_LT(std::sqrt(filtered / centre), 0.25);
}

TEST(GBuffer, ImpossibleViewsAreRefused) {
    const Arrays plane = square(1);
    World w = world_of({plane.mesh()}, {{0}});
    w.finish();
    EXPECT_THROW(w.view({{0, 0, 1}, {0, 0, 0}, {0, 0, 1}, 40}, 8, 8), std::invalid_argument);
    EXPECT_THROW(w.view({{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 180}, 8, 8), std::invalid_argument);
    EXPECT_THROW(w.view({{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 40}, 0, 8), std::invalid_argument);
}

TEST(Surface, TheShadingNormalFacesTheViewerAndStaysOnTheGeometricSide) {
    Rng rng(5, 6);
    for (int i = 0; i < 1000; ++i) {
        const vec3 geometric = uniform_sphere({rng.uniform(), rng.uniform()});
        vec3 viewer = uniform_sphere({rng.uniform(), rng.uniform()});
        if (glm::dot(viewer, geometric) < 0) viewer = -viewer;
        const vec3 normal = uniform_sphere({rng.uniform(), rng.uniform()});
        const vec3 seen = visible_normal(normal, geometric, viewer);
        EXPECT_NEAR(glm::length(seen), 1, 1e-5f);
        EXPECT_GE(glm::dot(seen, viewer), -1e-6f);
        EXPECT_GE(glm::dot(seen, geometric), -1e-6f);
        const vec3 turned = glm::dot(normal, geometric) < 0 ? -normal : normal;
        if (glm::dot(turned, viewer) > 0) {
            EXPECT_EQ(seen, turned);
        }
    }
}

TEST(Environment, DirectionsAndImageCoordinatesAreInverse) {
    Environment e;
    e.world_from_light = mat3(vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0));
    Rng rng(9, 9);
    for (int i = 0; i < 500; ++i) {
        const vec3 d = uniform_sphere({rng.uniform(), rng.uniform()});
        EXPECT_LT(glm::length(environment_direction(e, environment_coordinates(e, d)) - d), 1e-5f);
    }
    EXPECT_LT(glm::length(environment_direction(Environment{}, {0.5f, 0.5f}) - vec3(0, 0, -1)), 1e-6f);
    EXPECT_LT(glm::length(environment_direction(Environment{}, {0.75f, 0.5f}) - vec3(1, 0, 0)), 1e-6f);
}

TEST(Environment, TheCameraAndTheLightsSeeTheSameImage) {
    World w = world_of({}, {});
    Environment e;
    e.radiance = vec3(1, 2, 0.5f);
    e.width = 8, e.height = 4;
    Rng rng(10, 1);
    for (int i = 0; i < 32; ++i) e.image.push_back({rng.uniform(), rng.uniform(), rng.uniform()});
    w.scene.environment = e;
    finish_scene(w.scene);
    const LightSampler lights(w.scene);
    for (int i = 0; i < 500; ++i) {
        const vec3 d = uniform_sphere({rng.uniform(), rng.uniform()});
        EXPECT_LT(glm::length(environment_radiance(w.scene, d) - lights.environment(d)), 1e-4f);
    }
}

TEST(DepthMap, AFlatReceiverIsLitHoweverSteeplyWithoutBias) {
    const Arrays plane = square(5);
    World w = world_of({plane.mesh()}, {{0}});
    w.finish();
    for (const float degrees : {0.0f, 45.0f, 80.0f, 87.0f}) {
        const float a = degrees * degrees_to_radians;
        const DepthMap map(view_of(DirectionalLight{{std::sin(a), 0, -std::cos(a)}, {1, 1, 1}}, w.scene.geometry->bounds(), 64),
                           *w.intersector);
        Rng rng(2, 2);
        for (int i = 0; i < 200; ++i) {
            const vec3 p(8 * rng.uniform() - 4, 8 * rng.uniform() - 4, 0);
            EXPECT_EQ(map.lit(p, {0, 0, 1}, 0, 2e-5f), 1.0f) << degrees;
        }
    }
}

}  // namespace
}  // namespace interreflect
