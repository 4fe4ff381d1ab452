/// Embree's ways to trace a list of rays: one by one, in packets, in streams.
#pragma once
#include <embree3/rtcore.h>

#include <cstddef>

namespace interreflect::bench {

constexpr int stream_rays = 256;

/// Origins and directions, three floats a ray; neighbours in the list share a packet.
struct RayList {
    const float* origins;
    const float* directions;
    std::size_t count;
};

/// Milliseconds to trace all rays on all cores; packets are filled and distances stored inside the clock.
/// width: 1, 8, 16, or 256 for a stream. coherent: what Embree is told about the rays. Throws std::invalid_argument.
double trace(RTCScene scene, const RayList& rays, int width, bool any_hit, bool coherent);

}  // namespace interreflect::bench
