/// Windows over the bands of caches' light: less ringing about small lights, for softer light.
#pragma once
#include <string_view>

#include "data/light_caches.h"

namespace interreflect {

/// Of band l out of `bands`, 1 at l = 0 and falling to 0 at l = bands [Sloan 2008, "Windowing"]: hanning, (1 + cos(pi
/// l/bands))/2; lanczos, sin(pi l/bands)/(pi l/bands); none, 1.
float window_scale(std::string_view window, int band, int bands);

/// Scales every cache's coefficients; what comes from all directions together stays as it is.
void window_caches(LightCaches& caches, std::string_view window);

}  // namespace interreflect
