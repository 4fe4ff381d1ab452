/// Fetches what surface_at will read of coming hits while it works on earlier ones: scattered hits miss every cache.
#pragma once
#include <span>

#include "data/scene.h"
#include "visibility/intersector.h"

namespace interreflect {

class SurfacePrefetch {
  public:
    SurfacePrefetch(const Scene& scene, std::span<const Hit> hits) : scene_(scene), hits_(hits) {}

    /// Call before hit i is shaded, for i = 0, 1, ...
    void at(std::size_t i) const {
        if (i + far < hits_.size()) fetch_triangle(hits_[i + far]);
        if (i + middle < hits_.size()) fetch_vertices(hits_[i + middle]);
        if (i + near < hits_.size()) fetch_texels(hits_[i + near]);
    }

  private:
    // How many hits ahead: about the latency of memory over the time one hit takes.
    static constexpr std::size_t near = 6, middle = 12, far = 18;

    void fetch_triangle(const Hit& hit) const {
        if (!hit.valid()) return;
        __builtin_prefetch(&scene_.geometry->arrays->triangles[hit.triangle]);
        __builtin_prefetch(&scene_.geometry->arrays->materials[hit.triangle]);
    }
    void fetch_vertices(const Hit& hit) const {
        if (!hit.valid()) return;
        const uvec3 t = scene_.geometry->arrays->triangles[hit.triangle];
        const Vertex* vertices = scene_.geometry->arrays->vertices.data();
        __builtin_prefetch(vertices + t.x);
        __builtin_prefetch(vertices + t.y);
        __builtin_prefetch(vertices + t.z);
    }
    void fetch_texels(const Hit& hit) const {
        if (!hit.valid()) return;
        const GeometryArrays& arrays = *scene_.geometry->arrays;
        const int map = scene_.materials[arrays.materials[hit.triangle]].albedo_map;
        if (map < 0) return;
        const uvec3 t = arrays.triangles[hit.triangle];
        const Vertex* vertices = arrays.vertices.data();
        scene_.textures[map]->prefetch(vertices[t.x].texcoord * (1.0f - hit.u - hit.v) + vertices[t.y].texcoord * hit.u +
                                       vertices[t.z].texcoord * hit.v);
    }

    const Scene& scene_;
    std::span<const Hit> hits_;
};

}  // namespace interreflect
