#include <gtest/gtest.h>

#include <vector>

#include "math/rng.h"
#include "math/sampling.h"
#include "shading/lights.h"

namespace interreflect {
namespace {

constexpr int samples = 200000;

/// A square of side 1 at height 1 that faces down, cut into n x n x 2 triangles.
Scene ceiling(int n, std::shared_ptr<const Texture> map = nullptr) {
    std::vector<vec3> positions;
    std::vector<vec2> texcoords;
    std::vector<uvec3> triangles;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const vec2 uv(static_cast<float>(i) / n, static_cast<float>(j) / n);
            positions.push_back({uv.x - .5f, 1, uv.y - .5f});
            texcoords.push_back(uv);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            triangles.push_back({a, b, d});
            triangles.push_back({a, d, c});
        }
    Scene scene;
    const std::vector<MeshView> meshes{{positions, triangles, {}, texcoords, 0}};
    const std::vector<Placement> placements{{0}};
    scene.geometry = make_geometry(meshes, placements);
    Material material;
    material.emission = vec3(2);
    if (map != nullptr) {
        scene.textures.push_back(std::move(map));
        material.emission_map = 0;
    }
    scene.materials.push_back(material);
    finish_scene(scene);
    return scene;
}

struct Estimate {
    double mean, error;
};
template <class F>
Estimate average(const F& f, int n = samples) {
    Rng rng(11, 12);
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        const double x = f(rng);
        sum += x, squares += x * x;
    }
    return {sum / n, std::sqrt(std::fmax(0, squares / n - sum / n * sum / n) / n)};
}
/// Irradiance of an upward facing element at `position`, by light sampling.
Estimate irradiance(const LightSampler& lights, const vec3& position) {
    return average([&](Rng& rng) {
        const float choose = rng.uniform();
        const vec2 u(rng.uniform(), rng.uniform());
        const auto light = lights.sample_emitter(position, choose, u);
        return light.pdf > 0 ? light.radiance.x * std::fmax(0.0f, light.direction.y) / light.pdf : 0.0f;
    });
}

TEST(Lights, SquareLightGivesTheIrradianceOfItsFormFactor) {
    for (const int n : {1, 5}) {  // weighed by solid angle; chosen from the table
        const Scene scene = ceiling(n);
        const LightSampler lights(scene);
        const Estimate e = irradiance(lights, vec3(0));
        EXPECT_NEAR(e.mean, 2 * pi * .239456, 5 * e.error + 1e-5) << n;  // GROUND_TRUTH.md, row 12
    }
}

TEST(Lights, EmissionMapKeepsTheMeanAndIsSampledWhereItIsBright) {
    std::vector<float> pixels(3 * 64 * 64, 0.0f);
    for (const int texel : {64 * 20 + 7, 64 * 40 + 50, 64 * 41 + 50})
        for (int c = 0; c < 3; ++c) pixels[3 * texel + c] = 100;
    const Scene scene = ceiling(1, std::make_shared<Texture>(Texture::from_linear(pixels, 64, 64)));
    const LightSampler lights(scene);
    const vec3 below(.1f, 0, .2f);
    const Estimate e = irradiance(lights, below);
    // Quadrature over the same square, ten points across a texel.
    double expected = 0;
    constexpr int n = 640;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const vec2 uv((i + .5f) / n, (j + .5f) / n);
            const vec3 to = vec3(uv.x - .5f, 1, uv.y - .5f) - below;
            expected += 2 * scene.textures[0]->bilinear(uv).x * std::pow(to.y, 2) / std::pow(glm::dot(to, to), 2) / n / n;
        }
    EXPECT_NEAR(e.mean, expected, 5 * e.error + 2e-3 * expected);
    EXPECT_LT(e.error * std::sqrt(samples) / e.mean, 1.5);  // uniform sampling of 3 bright texels in 4096 has 40
}

TEST(Lights, EmitterDensityIsThatOfTheSamples) {
    std::vector<float> pixels(3 * 16 * 16);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>((i / 3 * 7919) % 13);
    const auto map = std::make_shared<Texture>(Texture::from_linear(pixels, 16, 16));
    for (const Scene& scene : {ceiling(1), ceiling(4), ceiling(1, map)}) {
        const LightSampler lights(scene);
        const std::vector<std::shared_ptr<const Mask>> masks;
        const Intersector rays(scene.geometry, scene.materials, masks);
        Rng rng(1, 1);
        int different = 0;
        for (int i = 0; i < 2000; ++i) {
            const vec3 position(rng.uniform() * 4 - 2, rng.uniform() * .99f, rng.uniform() * 4 - 2);
            const float choose = rng.uniform();
            const vec2 u(rng.uniform(), rng.uniform());
            const auto light = lights.sample_emitter(position, choose, u);
            if (light.pdf <= 0) continue;
            const Hit hit = rays.nearest({position, 0, light.direction});
            if (!hit.valid()) continue;  // a sample on the rim
            EXPECT_NEAR(hit.distance, light.distance, 1e-3f * light.distance);
            const float pdf = lights.emitter_pdf(hit, position, light.direction);
            // Rounding may put a point on the border of two pieces of a map into the other one.
            if (std::fabs(pdf - light.pdf) > 2e-3f * light.pdf) ++different;
        }
        EXPECT_LE(different, scene.textures.empty() ? 0 : 2);
    }
}

TEST(Lights, NoLightComesFromTheBackOfAnEmitter) {
    for (const int n : {1, 5}) {
        const Scene scene = ceiling(n);
        EXPECT_EQ(LightSampler(scene).sample_emitter(vec3(0, 2, 0), .5f, vec2(.5f)).pdf, 0);
    }
}

/// One emitter shape around the origin, which is near it.
EmitterShape shape_of(const vec3& a, const vec3& b, const vec3& c, bool rectangle) {
    EmitterShape shape{a, b - a, c - a, glm::normalize(glm::cross(b - a, c - a)), {}};
    if (glm::dot(shape.normal, a) > 0) shape.normal = -shape.normal;
    shape.area = glm::length(glm::cross(b - a, c - a)) * (rectangle ? 1.0f : 0.5f);
    shape.near2 = 1e6f, shape.luminance = 1, shape.rectangle = rectangle;
    return shape;
}

TEST(Lights, NearShapesAreSampledUniformlyInTheirSolidAngle) {
    const vec3 a(1, .1f, 0), b(0, 1, .2f), c(.1f, 0, 1);
    const vec3 p(-.4f, 1.2f, .3f), q = p + vec3(1.5f, .5f, 0), r = p + vec3(-.2f, .6f, .5f);  // dot(q - p, r - p) = 0
    for (const auto& [shape, corners] : {std::pair{shape_of(a, b, c, false), std::vector{a, b, c}},
                                         {shape_of(p, q, r, true), std::vector{p, q, q + r - p, r}}}) {
        const std::span<const EmitterShape> shapes(&shape, 1);
        Rng rng(2, 2);
        vec3 mean(0), expected(0);
        float pdf = 0;
        for (int i = 0; i < samples; ++i) {
            const auto light = sample_shapes(shapes, vec3(0), .5f, {rng.uniform(), rng.uniform()});
            mean += light.direction / float(samples);
            pdf = light.pdf;
            if (i < 100) {
                EXPECT_NEAR(glm::dot(light.direction * light.distance - shape.corner, shape.normal), 0, 1e-5);
                EXPECT_NEAR(shapes_pdf(shapes, vec3(0), light.direction, 0), light.pdf, 1e-5f * light.pdf);
            }
        }
        // The vector area of a spherical polygon: half the sum over its edges of the arc times the edge plane's normal. Its
        // solid angle: the sum of its corners' angles.
        double angle = -(double(corners.size()) - 2) * std::numbers::pi;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto at = [&](std::size_t k) { return glm::normalize(glm::dvec3(corners[(i + k) % corners.size()])); };
            const glm::dvec3 across = glm::cross(at(0), at(1)), next = glm::cross(at(1), at(2));
            expected += vec3(.5 * std::asin(glm::length(across)) * glm::normalize(across));
            angle += std::numbers::pi - std::acos(glm::dot(glm::normalize(across), glm::normalize(next)));
        }
        EXPECT_NEAR(pdf, 1 / angle, 1e-5 / angle);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(mean[axis], (glm::dot(expected, mean) > 0 ? 1 : -1) * expected[axis] / angle,
                        5 / std::sqrt(samples) * .5);
    }
}

TEST(Lights, FarAndNearSamplingGiveTheSameIrradiance) {
    const vec3 p(-.4f, 1.2f, .3f), q = p + vec3(.75f, .25f, 0), r = p + vec3(-.2f, .6f, .5f);
    for (const bool rectangle : {false, true}) {
        EmitterShape shape = shape_of(p, q, r, rectangle);
        shape.to_middle = (shape.edge1 + shape.edge2) / (rectangle ? 2.0f : 3.0f);
        Estimate e[2];
        for (const bool near : {false, true}) {
            shape.near2 = near ? 1e6f : 0.0f;
            e[near] = average([&](Rng& rng) {
                const auto light = sample_shapes({&shape, 1}, vec3(0), .5f, {rng.uniform(), rng.uniform()});
                return light.pdf > 0 ? std::fmax(0.0f, light.direction.y) / light.pdf : 0.0f;
            });
        }
        EXPECT_NEAR(e[0].mean, e[1].mean, 5 * std::hypot(e[0].error, e[1].error));
    }
}

Environment gradient(int width, int height) {
    Environment e;
    e.radiance = vec3(1), e.width = width, e.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) e.image.push_back(vec3(std::fmax(0.0f, std::cos(pi * (y + .5f) / height))));
    return e;
}

TEST(Lights, EnvironmentSamplingGivesTheIrradianceOfACosineSky) {
    Scene scene = ceiling(1);
    scene.environment = gradient(256, 128);
    const LightSampler lights(scene);
    const Estimate e = average([&](Rng& rng) {
        const auto light = lights.sample_environment({rng.uniform(), rng.uniform()});
        return light.pdf > 0 ? light.radiance.x * std::fmax(0.0f, light.direction.y) / light.pdf : 0.0f;
    });
    EXPECT_NEAR(e.mean, 2 * std::numbers::pi / 3, 5 * e.error + 1e-3);  // GROUND_TRUTH.md, row 15; 128 rows of pixels
}

TEST(Lights, EnvironmentDensityIntegratesToOneAndIsPositiveWhereThereIsLight) {
    Scene scene = ceiling(1);
    scene.environment = gradient(8, 6);
    scene.environment->image[19] = vec3(50, 1, 1);
    scene.environment->world_from_light = mat3(0, 0, 1, 1, 0, 0, 0, 1, 0);
    const LightSampler lights(scene);
    double sum = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const vec3 d = uniform_sphere({(i + .5f) / n, (j + .5f) / n});
            const float pdf = lights.environment_pdf(d);
            sum += pdf * 4 * std::numbers::pi / n / n;
            EXPECT_TRUE(pdf > 0 || lights.environment(d).x < 1e-5f);
        }
    EXPECT_NEAR(sum, 1, 5e-3);  // midpoint rule across the cells' borders
    Rng rng(4, 4);
    for (int i = 0; i < 1000; ++i) {
        const auto light = lights.sample_environment({rng.uniform(), rng.uniform()});
        EXPECT_GT(light.pdf, 0);
        EXPECT_EQ(light.radiance, lights.environment(light.direction));
    }
}

TEST(Lights, AnImageOfOneRadianceIsSampledUniformlyOverTheSphere) {
    Scene scene = ceiling(1);
    scene.environment = gradient(16, 8);
    for (auto& texel : scene.environment->image) texel = vec3(3);
    const LightSampler lights(scene);
    for (const vec3& d : {vec3(0, 1, 0), vec3(0, -0.99f, 0.14f), vec3(1, 0, 0), vec3(0.6f, 0.8f, 0), vec3(0.3f, -0.5f, -0.81f)})
        EXPECT_NEAR(lights.environment_pdf(glm::normalize(d)) * 4.0f * pi, 1.0f, 1e-3f);
}

TEST(Lights, EnvironmentImageLooksAlongMinusZWithRightToTheRight) {
    Scene scene = ceiling(1);
    Environment e;
    e.radiance = vec3(1), e.width = 4, e.height = 2;
    for (int i = 0; i < 8; ++i) e.image.push_back(vec3(static_cast<float>(i)));
    scene.environment = e;
    const LightSampler lights(scene);
    const float s = std::sqrt(.5f);  // texel centres lie 45 degrees from the horizon and from the planes between columns
    EXPECT_NEAR(lights.environment(glm::normalize(vec3(s, 1, -s))).x, 2, 1e-3);  // right of -z
    EXPECT_NEAR(lights.environment(glm::normalize(vec3(-s, 1, -s))).x, 1, 1e-3);
    EXPECT_NEAR(lights.environment(glm::normalize(vec3(s, -1, s))).x, 7, 1e-3);
}

TEST(Lights, DeltaLightsComeInOrderAndFallOff) {
    Scene scene = ceiling(1);
    scene.point_lights.push_back({{0, 2, 0}, vec3(8)});
    scene.spot_lights.push_back({{0, 2, 0}, {0, -1, 0}, vec3(4), 20, 40});
    scene.directional_lights.push_back({{0, -2, 0}, vec3(3)});
    finish_scene(scene);
    const LightSampler lights(scene);
    ASSERT_EQ(lights.delta_count(), 3);
    EXPECT_NEAR(lights.delta(0, vec3(0)).irradiance.x, 2, 1e-6);
    EXPECT_NEAR(lights.delta(1, vec3(0)).irradiance.x, 1, 1e-6);
    EXPECT_EQ(lights.delta(2, vec3(0)).direction, vec3(0, 1, 0));
    const auto at = [&](float degrees) {
        const float x = 2 * std::tan(degrees * degrees_to_radians);
        return lights.delta(1, {x, 0, 0}).irradiance.x * (4 + x * x) / 4;
    };
    const float inner = std::cos(20 * degrees_to_radians), outer = std::cos(40 * degrees_to_radians);
    const float half = std::acos((inner + outer) / 2) / degrees_to_radians;
    EXPECT_NEAR(at(half), .5, 1e-4);
    EXPECT_NEAR(at(19), 1, 1e-5);
    EXPECT_EQ(at(41), 0);
}

}  // namespace
}  // namespace interreflect
