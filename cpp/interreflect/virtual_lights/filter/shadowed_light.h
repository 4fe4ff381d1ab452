#pragma once
#include "data/virtual_lights.h"
#include "virtual_lights/receivers.h"
#include "visibility/intersector.h"

namespace interreflect {

/// A light with what its shadow holds.
struct ShadowedLight {
    DiskLight disk;
    const LightShadows& shadows;
    const Intersector& intersector;
    Frame frame{disk.normal};

    const float* map() const {
        return shadows.depth.data() +
               disk.index * static_cast<std::size_t>(shadows.size) * static_cast<std::size_t>(shadows.size);
    }
};

}  // namespace interreflect
