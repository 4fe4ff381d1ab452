#include "light_volumes/inject.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "light_volumes/between.h"
#include "math/spherical_harmonics.h"

namespace interreflect {
namespace {

constexpr std::size_t most_bytes = std::size_t{4} << 30;
constexpr float half_a_cell = 0.5f;

/// Coefficients of the lobe flux / pi max(0, cos) about a normal.
struct Lobe {
    float value[LightVolume::values];

    Lobe(const vec3& flux, const vec3& normal) {
        float y[LightVolume::harmonics];
        spherical_harmonics(normal, 2, [&](int k, float v) { y[k] = v * lobe_scale(k == 0 ? 0 : 1, 1.0f); });
        for (int colour = 0; colour < 3; ++colour)
            for (int k = 0; k < LightVolume::harmonics; ++k) value[colour * LightVolume::harmonics + k] = flux[colour] * y[k];
    }
};

void check(const Domain& domain) {
    if (!domain.plain()) throw std::invalid_argument("light volumes need evenly spread cells, one grid of them");
    const double bytes = static_cast<double>(domain.cell_count()) * LightVolume::values * sizeof(float);
    if (bytes > static_cast<double>(most_bytes))
        throw std::invalid_argument("a light volume of " + std::to_string(domain.cell_count()) +
                                    " cells would hold more than 4 GiB: lower grid.resolution");
}

bool inside(const vec3& at, const Domain& domain) {
    return min_component(at) >= 0.0f && min_component(vec3(domain.cells) - at) >= 0.0f;
}

}  // namespace

LightVolume inject(const VirtualLights& lights, const Domain& domain) {
    check(domain);
    LightVolume volume{domain, Buffer<float>(domain.cell_count() * LightVolume::values, 0.0f), {}};
    std::vector<Between> places;
    std::vector<std::size_t> light;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const vec3 at = domain.to_linear(lights.position[i]);
        if (!inside(at, domain)) continue;
        // Middles of cells lie half a cell from their faces.
        places.emplace_back(at + lights.normal[i] * half_a_cell - 0.5f, domain.cells);
        light.push_back(i);
    }
    std::vector<Lobe> lobes;
    lobes.reserve(light.size());
    for (const std::size_t i : light) lobes.emplace_back(lights.flux[i], lights.normal[i]);
    spread(
        light.size(), domain.cells, [&](std::size_t i) -> const Between& { return places[i]; },
        [&](std::size_t i, std::size_t cell, float share) {
            float* into = volume.coefficients.data() + cell * LightVolume::values;
            for (int k = 0; k < LightVolume::values; ++k) into[k] += share * lobes[i].value[k];
        });
    volume.counts.virtual_lights = light.size();
    return volume;
}

GeometryVolume geometry_volume(const Surfels& surfels, const Domain& domain) {
    check(domain);
    GeometryVolume volume{domain, {}, {}};
    const ivec3 corners = volume.corners();
    const std::size_t count = static_cast<std::size_t>(corners.x) * corners.y * corners.z;
    volume.coefficients = Buffer<float>(count * LightVolume::harmonics, 0.0f);
    std::vector<Between> places;
    std::vector<std::size_t> surfel;
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const vec3 at = domain.to_linear(surfels.position[i]);
        if (!inside(at, domain)) continue;
        places.emplace_back(at, corners);
        surfel.push_back(i);
    }
    const float face = domain.voxel_size * domain.voxel_size;
    spread(
        surfel.size(), corners, [&](std::size_t i) -> const Between& { return places[i]; },
        [&](std::size_t i, std::size_t corner, float share) {
            // Flux pi: a lobe without 1/pi.
            const float blocks = share * pi * surfels.area[surfel[i]] / face;
            float* into = volume.coefficients.data() + corner * LightVolume::harmonics;
            spherical_harmonics(surfels.normal[surfel[i]], 2,
                                [&](int k, float v) { into[k] += blocks * v * lobe_scale(k == 0 ? 0 : 1, 1.0f); });
        });
    volume.counts.surface_points = surfel.size();
    return volume;
}

}  // namespace interreflect
