#include <gtest/gtest.h>

#include "visibility/light_view.h"

namespace interreflect {
namespace {

TEST(LightView, PointsOnATexelsRayProjectOntoThatTexel) {
    const PointLight point{{1, 2, 3}, {1, 1, 1}};
    const SpotLight spot{{1, 2, 3}, {0.3f, -1, 0.2f}, {1, 1, 1}, 20, 30};
    const DirectionalLight sun{{0.3f, -1, 0.2f}, {1, 1, 1}};
    std::vector<LightView> views = views_of(point, 32);
    EXPECT_EQ(views.size(), 6U);
    for (const LightView& view : views_of(spot, 32)) views.push_back(view);
    EXPECT_EQ(views.size(), 7U);
    views.push_back(view_of(sun, {vec3(-1), vec3(2, 1, 4)}, 32));
    for (const LightView& view : views)
        for (const vec2 at : {vec2(0.5f, 0.5f), vec2(16.25f, 3.5f), vec2(31, 30)}) {
            const Ray ray = view.ray(at.x, at.y);
            const auto back = view.project(ray.origin + ray.direction * 3.0f);
            EXPECT_TRUE(back.inside);
            EXPECT_NEAR(back.x, at.x, 1e-3f);
            EXPECT_NEAR(back.y, at.y, 1e-3f);
        }
}

TEST(LightView, TexelsOfACubeSpanTheSphereButForTheirMargin) {
    constexpr int size = 64;
    double sum = 0;
    for (const LightView& view : views_of(PointLight{}, size))
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const vec3 d = view.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).direction;
                const bool margin = max_component(glm::abs(d)) > glm::dot(d, view.forward);
                sum += margin ? 0 : view.texel_measure(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            }
    EXPECT_NEAR(sum, 4 * pi, 4 * pi * 2e-2);  // texels on the border count by their centre: half a texel of 64
}

}  // namespace
}  // namespace interreflect
