/// Emitting triangles as lights.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "data/scene.h"
#include "shading/emitter_shape.h"
#include "visibility/intersector.h"

namespace interreflect {

struct LightDirection;

/// Triangles with an emission map are cut into pieces of about two texels, so that light is sampled where the map is bright.
class EmitterSampler {
  public:
    explicit EmitterSampler(const Scene& scene);

    bool empty() const { return triangles_.empty(); }
    bool many() const { return !triangles_.empty() && !few_; }
    LightDirection sample(const vec3& position, float choose, const vec2& u) const;
    float pdf(const Hit& hit, const vec3& position, const vec3& direction) const;
    /// A point on an emitter, in proportion to luminance times area, whoever looks at it.
    struct Point {
        vec3 position, normal, radiance;  // unit normal of the side that emits
        float pdf;                        // by area
        std::uint32_t instance, triangle;
    };
    Point sample_point(float choose, const vec2& u) const;
    /// For those who sample from many points at once; empty where emitters are many.
    std::span<const EmitterShape> shapes() const { return shapes_; }

  private:
    struct Triangle {
        vec3 corner, edge1, edge2, normal;  // world space; the normal of the side that emits
        float area = 0;
        vec3 emission{0};  // before the map
        int map = -1, mask = -1, material = 0;
        std::uint32_t instance = 0, triangle = 0;
        std::uint32_t first_piece = 0;
        int cuts = 1;   // pieces along an edge
        int shape = 0;  // of shapes_, where the emitters are few
    };
    Triangle make_triangle(const Emitter& emitter) const;
    void append_weights(const Triangle& t);
    vec3 radiance(const Triangle& t, const vec2& barycentric) const;
    void make_shapes();
    LightDirection sample_many(const vec3& position, float choose, const vec2& u) const;
    const Triangle* find(const Hit& hit) const;

    const Scene* scene_;
    std::vector<Triangle> triangles_;      // ascending by instance, then triangle
    std::vector<EmitterShape> shapes_;     // empty unless the emitters are few
    std::vector<std::uint32_t> of_piece_;  // piece -> triangle
    std::vector<float> cdf_;               // over all pieces, by luminance times area
    bool few_ = false;
};

}  // namespace interreflect
