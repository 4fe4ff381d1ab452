#include <gtest/gtest.h>

#include <vector>

#include "math/owen_sobol.h"
#include "visibility/surface_kernel.h"

namespace interreflect {
namespace {

std::shared_ptr<const Texture> noise(int width, int height) {
    Rng rng(3, 4);
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * height * 3);
    for (auto& p : pixels) p = static_cast<std::uint8_t>(rng.next() >> 24);
    return std::make_shared<Texture>(Texture::from_srgb8(pixels, width, height, 3));
}

/// Triangles all about, of plain, textured, one-sided and glossy materials; every other one flat.
Scene soup(int meshes) {
    Rng rng(5, 6);
    const auto point = [&] { return vec3(rng.uniform(), rng.uniform(), rng.uniform()); };
    Scene scene;
    scene.textures = {noise(16, 16), noise(37, 5)};
    for (int k = 0; k < 4; ++k) {
        Material material;
        material.albedo = vec3(.3f, .5f, .7f) * (1.0f + .1f * k);
        material.albedo_map = k % 3 - 1;
        material.two_sided = k != 2;
        material.specular = vec3(k == 3 ? .2f : 0.0f);
        scene.materials.push_back(material);
    }
    std::vector<std::vector<vec3>> positions(meshes), normals(meshes);
    std::vector<std::vector<vec2>> texcoords(meshes);
    const std::vector<uvec3> triangles{{0, 1, 2}};
    std::vector<MeshView> views;
    std::vector<Placement> placements;
    for (int m = 0; m < meshes; ++m) {
        const vec3 centre = point();
        for (int corner = 0; corner < 3; ++corner) {
            positions[m].push_back(centre + .5f * (point() - .5f));
            texcoords[m].push_back({6 * rng.uniform() - 3, 6 * rng.uniform() - 3});
            if (m % 2 == 0) normals[m].push_back(glm::normalize(point() - .5f));
        }
        views.push_back({positions[m], triangles, normals[m], texcoords[m], static_cast<std::uint32_t>(m % 4)});
        placements.push_back({static_cast<std::uint32_t>(m)});
    }
    scene.geometry = make_geometry(views, placements);
    finish_scene(scene);
    return scene;
}

vec3 at(const SurfacePacket::Lanes* rows, int lane) { return {rows[0][lane], rows[1][lane], rows[2][lane]}; }

TEST(SurfacePackets, HoldWhatSurfaceAtFinds) {
    const Scene scene = soup(60);
    const Intersector rays(scene.geometry, scene.materials, scene.masks);
    const SurfaceKernel kernel(scene);
    Rng rng(7, 8);
    int met = 0, glossy = 0, dark = 0;
    for (int round = 0; round < 100; ++round) {
        RayPacket packet;
        for (int k = 0; k < RayPacket::width; ++k) {
            const vec3 aim = vec3(rng.uniform(), rng.uniform(), rng.uniform()) - .5f;
            packet.set(k, {vec3(.5f) - 2.0f * aim, 0, glm::normalize(aim)});
        }
        const std::uint32_t active = round % 2 == 0 ? 0xffffU : 0x0f71U;
        rays.nearest(packet, active);
        const std::uint32_t plain = plain_surfaces(kernel, packet, active);
        if (plain == 0) continue;
        SurfacePacket surfaces;
        place_surfaces(kernel, packet, plain, surfaces);
        texture_surfaces(kernel, plain, surfaces);
        for (int k = 0; k < RayPacket::width; ++k) {
            ASSERT_EQ((plain >> k) & 1U, (active >> k) & 1U & static_cast<std::uint32_t>(packet.met(k)));
            if (((plain >> k) & 1U) == 0) continue;
            const vec3 direction(packet.direction_x[k], packet.direction_y[k], packet.direction_z[k]);
            const SurfacePoint p = surface_at(scene, packet.hit(k), direction);
            // The vectors fuse multiplications and additions; steep triangles magnify that in their normals and texels.
            EXPECT_LT(glm::length(at(surfaces.position, k) - p.position), 1e-5f);
            EXPECT_LT(glm::length(at(surfaces.geometric_normal, k) - p.geometric_normal), 1e-5f);
            EXPECT_LT(glm::length(at(surfaces.normal, k) - p.normal), 1e-4f);
            EXPECT_LT(glm::length(at(surfaces.albedo, k) - p.albedo), 1e-4f);
            EXPECT_NEAR(surfaces.offset[k], p.offset, 1e-6f * p.offset);
            const bool lobe = max_component(p.specular) > 0.0f;
            EXPECT_EQ(surfaces.lobe[k], lobe ? p.material : SurfacePacket::no_lobe);
            ++met, glossy += lobe, dark += max_component(p.albedo) <= 0.0f;
        }
    }
    EXPECT_GT(met, 500);
    EXPECT_GT(glossy, 50);
    EXPECT_GT(dark, 20);
}

TEST(OwenSobol, TheSecondDimensionInFiveStepsIsThatOfTheDirectionNumbers) {
    Rng rng(1, 2);
    for (int i = 0; i < 1000; ++i) {
        const std::uint32_t index = i < 100 ? static_cast<std::uint32_t>(i) : rng.next();
        std::uint32_t expected = 0, v = 0x80000000U;
        for (int bit = 0; bit < 32; ++bit, v ^= v >> 1)
            if (((index >> bit) & 1U) != 0) expected ^= v;
        EXPECT_EQ(reverse_bits(reversed_sobol_second(index)), expected);
    }
}

}  // namespace
}  // namespace interreflect
