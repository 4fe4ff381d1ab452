/// The ray library's device. Only this room's sources include it.
#pragma once
#include <embree3/rtcore.h>

#include <cstddef>

namespace interreflect {

/// One for the process: it holds threads and settings, no scene.
RTCDevice ray_device();
/// Throws std::runtime_error where the last call of the library failed.
void check_ray_device();
/// Bytes that the library holds for all scenes.
std::ptrdiff_t ray_device_bytes();

}  // namespace interreflect
