/// Pixels side by side that the same virtual lights light, and one of these lights.
#pragma once
#include <cmath>
#include <cstdint>

#include "data/gbuffer.h"
#include "data/virtual_lights.h"

namespace interreflect {

/// At most `capacity` pixels in parallel arrays, which are filled up with the last one to a multiple of 16.
struct alignas(64) Receivers {
    static constexpr int capacity = 256;

    float position[3][capacity];
    float normal[3][capacity];            // shading normal, unit
    float geometric_normal[3][capacity];  // unit
    float offset[capacity];               // how far off the surface rays start
    std::uint32_t pixel[capacity];
    int count = 0;

    vec3 position_at(int i) const { return {position[0][i], position[1][i], position[2][i]}; }
    vec3 normal_at(int i) const { return {normal[0][i], normal[1][i], normal[2][i]}; }
    vec3 geometric_normal_at(int i) const { return {geometric_normal[0][i], geometric_normal[1][i], geometric_normal[2][i]}; }
    int padded() const { return (count + 15) / 16 * 16; }

    void clear() { count = 0; }
    void add(const GBuffer& g, std::size_t p) {
        for (int k = 0; k < 3; ++k) {
            position[k][count] = g.position[p][k];
            normal[k][count] = g.normal[p][k];
            geometric_normal[k][count] = g.geometric_normal[p][k];
        }
        offset[count] = g.offset[p];
        pixel[count++] = static_cast<std::uint32_t>(p);
    }
    void fill_up() {
        for (int i = count; i < padded(); ++i) {
            for (int k = 0; k < 3; ++k) {
                position[k][i] = position[k][count - 1];
                normal[k][i] = normal[k][count - 1];
                geometric_normal[k][i] = geometric_normal[k][count - 1];
            }
            offset[i] = offset[count - 1], pixel[i] = pixel[count - 1];
        }
    }
};

/// One value a receiver.
struct alignas(64) PerReceiver {
    float value[Receivers::capacity];
    float operator[](int i) const { return value[i]; }
    float& operator[](int i) { return value[i]; }
};

/// A virtual light's disk.
struct DiskLight {
    std::size_t index;
    vec3 position, normal;
    float area, offset;
    const MemberPlaces* places;  // null: the light is the disk and nothing else

    DiskLight(const VirtualLights& lights, std::size_t i)
        : index(i),
          position(lights.position[i]),
          normal(lights.normal[i]),
          area(lights.area[i]),
          offset(lights.offset[i]),
          places(lights.places.empty() ? nullptr : &lights.places[i]) {}
    float radius() const { return std::sqrt(area / pi); }
    /// Receivers less high above the disk's plane may lie in it, as on the other side of a wall, but for rounding.
    float least_height() const { return 1e-4f * radius() + offset; }
};

}  // namespace interreflect
