/// Ray intersection: the one value that knows the ray library. Built from a geometry and its masks; queries are const and thread
/// safe.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "data/scene.h"

namespace interreflect {

struct Ray {
    vec3 origin;
    float near = 0.0f;
    vec3 direction;  // need not be unit; distances are multiples of its length
    float far = std::numeric_limits<float>::infinity();
};

struct Hit {
    float distance = std::numeric_limits<float>::infinity();
    std::uint32_t instance = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();  // global number in the geometry's arrays
    float u = 0, v = 0;                                                  // barycentric weights of the second and third corner

    bool valid() const { return triangle != std::numeric_limits<std::uint32_t>::max(); }
};

enum class BuildQuality { low, medium, high };

/// Sixteen rays side by side, and what they met: for callers that fill and read them lane by lane with vectors.
/// The layout is the ray library's own, so nothing is copied where the machine's vectors are that wide.
struct alignas(64) RayPacket {
    static constexpr int width = 16;
    using Lanes = float[width];
    using Numbers = std::uint32_t[width];

    Lanes origin_x, origin_y, origin_z, near;
    Lanes direction_x, direction_y, direction_z, time;
    Lanes far;  // after `nearest`: distance of the hit; unchanged where nothing was met
    Numbers reserved[3];
    Lanes normal_x, normal_y, normal_z, u, v;  // after `nearest`, where a triangle was met
    Numbers triangle, geometry, instance;      // triangle: global number, or that of an invalid Hit

    bool met(int lane) const { return triangle[lane] != Hit{}.triangle; }
    Hit hit(int lane) const { return met(lane) ? Hit{far[lane], instance[lane], triangle[lane], u[lane], v[lane]} : Hit{}; }
    void set(int lane, const Ray& ray) {
        origin_x[lane] = ray.origin.x, origin_y[lane] = ray.origin.y, origin_z[lane] = ray.origin.z, near[lane] = ray.near;
        direction_x[lane] = ray.direction.x, direction_y[lane] = ray.direction.y, direction_z[lane] = ray.direction.z;
        far[lane] = ray.far;
    }
};

class Intersector {
  public:
    Intersector(std::shared_ptr<const Geometry> geometry, std::span<const Material> materials,
                std::span<const std::shared_ptr<const Mask>> masks, BuildQuality quality = BuildQuality::medium);
    /// The same hierarchies with the instances where `geometry` (made by move_geometry) has them.
    Intersector(const Intersector& still, std::shared_ptr<const Geometry> geometry);
    ~Intersector();
    Intersector(const Intersector&) = delete;
    Intersector& operator=(const Intersector&) = delete;

    Hit nearest(const Ray& ray) const;
    bool occluded(const Ray& ray) const;
    /// Coherent rays in a packet; bit i of `active`: lane i takes part. The same hits, bit for bit, as ray by ray.
    void nearest(RayPacket& packet, std::uint32_t active) const;
    /// Bit i of the result: lane i is active and blocked. Overwrites `far`.
    std::uint32_t occluded(RayPacket& packet, std::uint32_t active) const;
    /// Coherent rays (neighbouring pixels): packets as wide as the machine's vectors.
    void nearest_coherent(std::span<const Ray> rays, std::span<Hit> hits) const;
    /// Incoherent rays: whatever call is fastest for them.
    void nearest_incoherent(std::span<const Ray> rays, std::span<Hit> hits) const;
    void occluded_incoherent(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

    const std::shared_ptr<const Geometry>& geometry() const;
    /// Bytes that the hierarchies hold, as the ray library counts them (exact unless several are built at the same time).
    std::size_t bytes() const;

    struct Implementation;

  private:
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace interreflect
