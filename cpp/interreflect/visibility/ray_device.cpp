#include "visibility/ray_device.h"

#include <atomic>
#include <stdexcept>
#include <string>

namespace interreflect {
namespace {

std::atomic<std::ptrdiff_t>& held_bytes() {
    static std::atomic<std::ptrdiff_t> bytes{0};
    return bytes;
}

}  // namespace

RTCDevice ray_device() {
    static const RTCDevice shared = [] {
        const RTCDevice made = rtcNewDevice(nullptr);
        if (made == nullptr) throw std::runtime_error("the ray library has no device on this machine");
        const auto count = [](void*, ssize_t bytes, bool) {
            held_bytes() += bytes;
            return true;
        };
        rtcSetDeviceMemoryMonitorFunction(made, count, nullptr);
        return made;
    }();
    return shared;
}

void check_ray_device() {
    const RTCError error = rtcGetDeviceError(ray_device());
    if (error != RTC_ERROR_NONE) throw std::runtime_error("the ray library failed with error " + std::to_string(error));
}

std::ptrdiff_t ray_device_bytes() { return held_bytes(); }

}  // namespace interreflect
