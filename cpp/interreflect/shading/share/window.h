/// The window of an interleaved block: which neighbours did which part of the work.
#pragma once
#include <vector>

namespace interreflect {

inline constexpr int largest_block = 8;                 // pixels on a side
inline constexpr int largest_halo = largest_block / 2;  // pixels that a window reaches past its centre

/// A neighbour, and its weight among those of its phase.
struct Tap {
    int dx, dy;
    float weight;
};

/// Taps grouped by phase relative to the centre: phase i's are taps[first[i]] up to taps[first[i + 1]]. One block wide and high;
/// in a direction with an even number of pixels both ends take half, so the window stays centred.
struct Window {
    std::vector<Tap> taps;
    std::vector<int> first;

    Window(int width, int height);
};

}  // namespace interreflect
