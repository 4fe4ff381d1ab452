/// Moments of the glossy lobes: how much they reflect, where to, and how widely, by width and view.
#pragma once
#include <vector>

#include "data/scene.h"

namespace interreflect {

/// A lobe (f cos, seen at one angle) as one cone.
struct LobeCone {
    float scale = 0, bias = 0;  // directional albedo = specular * scale + (1 - specular) * bias
    vec2 direction{0, 1};       // unit mean direction: along the mirrored view's tangent, and along the normal
    float half_angle = 0;       // radians: a uniform cone with the lobe's mean resultant length R has cos(half angle) = 2 R - 1
};

/// Integrals of the lobe over the hemisphere by importance sampling: `samples` Owen-scrambled Sobol points an entry.
class LobeTable {
  public:
    explicit LobeTable(Lobe lobe);
    /// Bilinear in sqrt(alpha) and the cosine between normal and view.
    LobeCone at(float alpha, float cosine) const;

  private:
    std::vector<LobeCone> entries_;
};

/// The table of a lobe; built when first asked for.
const LobeTable& lobe_table(Lobe lobe);

}  // namespace interreflect
