/// The surfaces that a packet of rays met, as wide as the machine's vectors: surface_at without a footprint.
#pragma once
#include <vector>

#include "data/scene.h"
#include "visibility/intersector.h"
#include "visibility/kernel_material.h"
#include "visibility/surface.h"

namespace interreflect {

/// Sixteen surfaces side by side.
struct alignas(64) SurfacePacket {
    using Lanes = RayPacket::Lanes;
    using Numbers = RayPacket::Numbers;
    static constexpr std::uint32_t no_lobe = ~0U;

    Lanes position[3], geometric_normal[3], normal[3], albedo[3], offset;
    Numbers material;
    Numbers lobe;  // number of the material with a glossy lobe, or no_lobe: also where a one-sided surface is seen from behind
    // The texels of the albedo's look-up, lower ones first, and how far between them it lies.
    Numbers texel[4];
    Lanes across, up;

    /// Puts one surface that something else made into a lane.
    void set(int lane, const SurfacePoint& point);
};

/// What all packets of one scene share.
struct SurfaceKernel {
    const Geometry* geometry;
    std::vector<KernelMaterial> materials;

    explicit SurfaceKernel(const Scene& scene) : geometry(scene.geometry.get()), materials(kernel_materials(scene)) {}
};

/// The lanes of `active` that the next functions can do; the others take surface_at. Asks for their vertices.
std::uint32_t plain_surfaces(const SurfaceKernel& kernel, const RayPacket& hits, std::uint32_t active);
/// All but the texture; asks for the texels. `plain` is not 0.
void place_surfaces(const SurfaceKernel& kernel, const RayPacket& hits, std::uint32_t plain, SurfacePacket& surfaces);
/// Multiplies albedos by their textures. `plain` is not 0.
void texture_surfaces(const SurfaceKernel& kernel, std::uint32_t plain, SurfacePacket& surfaces);
/// Asks for what plain_surfaces reads.
void prefetch_hits(const SurfaceKernel& kernel, const RayPacket& hits);

}  // namespace interreflect
