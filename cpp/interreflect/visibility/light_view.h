/// What a light sees: square pictures of texels, each with a ray through its centre.
#pragma once
#include <vector>

#include "data/scene.h"
#include "math/parallel.h"
#include "visibility/intersector.h"

namespace interreflect {

/// One picture: perspective from a point, or orthographic along a direction. Texel (0, 0) spans [0, 1) x [0, 1).
struct LightView {
    bool perspective = true;
    int size = 0;
    vec3 origin{0};                      // the eye, or the centre of the plane where the rays start
    vec3 forward{0}, right{0}, down{0};  // orthonormal
    float half_x = 1, half_y = 1;        // at distance 1 for a perspective; scene units for an orthographic view

    /// The ray through continuous texel coordinates; its direction is unit.
    Ray ray(float x, float y) const {
        const vec3 sideways = right * (half_x * (2.0f * x / static_cast<float>(size) - 1.0f)) +
                              down * (half_y * (2.0f * y / static_cast<float>(size) - 1.0f));
        if (perspective) return {origin, 0.0f, glm::normalize(forward + sideways)};
        return {origin + sideways, 0.0f, forward};
    }
    /// Those through the centres of the 4 x 4 texels from (x0, y0) on, row by row: the same bits as one by one.
    void rays(int x0, int y0, RayPacket& packet) const;
    struct Projection {
        float x, y;
        bool inside;  // of the picture, and in front of the eye
    };
    Projection project(const vec3& position) const {
        const vec3 to = position - origin;
        const float scale = perspective ? 1.0f / glm::dot(to, forward) : 1.0f;
        const float limit = static_cast<float>(size);
        const float x = 0.5f * limit * (1.0f + glm::dot(to, right) * scale / half_x);
        const float y = 0.5f * limit * (1.0f + glm::dot(to, down) * scale / half_y);
        return {x, y, scale > 0.0f && x >= 0.0f && y >= 0.0f && x < limit && y < limit};
    }
    /// Width of a texel's longer side at a distance from the eye, scene units.
    float texel_width(float distance) const {
        const float unit = 2.0f * std::fmax(half_x, half_y) / static_cast<float>(size);
        return perspective ? unit * distance : unit;
    }
    /// A perspective texel's solid angle, sr; an orthographic texel's area.
    float texel_measure(float x, float y) const;
};

/// Orthographic over the scene's bounds.
LightView view_of(const DirectionalLight& light, const Bounds& bounds, int size);
/// One perspective picture of a spot narrower than 75 degrees (half angle); the six sides of a cube for a wider one.
std::vector<LightView> views_of(const SpotLight& light, int size);
/// The six sides of a cube; each a texel wider than 90 degrees on every side, so that neighbours of border texels exist.
std::vector<LightView> views_of(const PointLight& light, int size);

/// The views of light `i`: point, then spot, then directional lights, as LightSampler counts them.
std::vector<LightView> views_of_light(const Scene& scene, int i, int size);

inline constexpr int view_tile_side = 32;

/// Calls store(x, y, hit) for the nearest hit through the centre of every texel of a tile, always in the same order.
template <class Store>
void trace_tile(const LightView& view, const Intersector& intersector, const Tile& tile, const Store& store) {
    constexpr int side = 4;
    RayPacket packet;
    for (int y0 = tile.y0; y0 < tile.y1; y0 += side)
        for (int x0 = tile.x0; x0 < tile.x1; x0 += side) {
            std::uint32_t active = 0;
            view.rays(x0, y0, packet);
            for (int lane = 0; lane < RayPacket::width; ++lane)
                active |= static_cast<std::uint32_t>(x0 + lane % side < tile.x1 && y0 + lane / side < tile.y1) << lane;
            intersector.nearest(packet, active);
            for (int lane = 0; lane < RayPacket::width; ++lane)
                if (((active >> lane) & 1U) != 0) store(x0 + lane % side, y0 + lane / side, packet.hit(lane));
        }
}
/// The same for all texels, from all threads.
template <class Store>
void trace_view(const LightView& view, const Intersector& intersector, const Store& store) {
    parallel_tiles(view.size, view.size, view_tile_side, [&](const Tile& tile) { trace_tile(view, intersector, tile, store); });
}

}  // namespace interreflect
