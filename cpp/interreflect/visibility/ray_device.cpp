#include "visibility/ray_device.h"

#include <atomic>
#include <stdexcept>
#include <string>

#include "math/vector_target.h"

namespace interreflect {
namespace {

/// The ray library's settings: all that the machine has, or up to the forced target.
const char* settings() {
    const std::optional<std::string>& forced = forced_vector_target();
    if (forced == "sse4") return "max_isa=sse4.2";
    return forced == "avx2" ? "max_isa=avx2" : nullptr;
}

std::atomic<std::ptrdiff_t>& held_bytes() {
    static std::atomic<std::ptrdiff_t> bytes{0};
    return bytes;
}

}  // namespace

RTCDevice ray_device() {
    static const RTCDevice shared = [] {
        const RTCDevice made = rtcNewDevice(settings());
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
