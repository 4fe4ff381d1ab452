/// How many rays a second this machine traces: the rates that limits of rays divide by.
#pragma once

namespace interreflect {

/// Million rays a second of all threads of the current arena.
struct RayRates {
    double coherent = 0;    // nearest hits of neighbouring pixels, in packets
    double incoherent = 0;  // nearest hits after a diffuse bounce
    double occlusion = 0;   // any hit after a diffuse bounce
};

/// Best of `repeats` over 2^18 rays each, inside a rough sphere of 131,072 triangles: every ray meets something.
RayRates measure_ray_rates(int repeats);

}  // namespace interreflect
