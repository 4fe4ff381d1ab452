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
    /// Coherent rays (neighbouring pixels): packets as wide as the machine's vectors.
    void nearest_coherent(std::span<const Ray> rays, std::span<Hit> hits) const;
    void occluded_coherent(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;
    /// Incoherent rays: whatever call is fastest for them.
    void nearest_incoherent(std::span<const Ray> rays, std::span<Hit> hits) const;
    void occluded_incoherent(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

    const std::shared_ptr<const Geometry>& geometry() const;
    /// Bytes that the hierarchies hold.
    std::size_t bytes() const;

    struct Implementation;

  private:
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace interreflect
