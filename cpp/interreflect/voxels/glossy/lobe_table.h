/// Moments of the glossy lobes: how much they reflect, where to, and how widely, by width and view.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "data/gbuffer.h"
#include "data/scene.h"

namespace interreflect {

/// A lobe (f cos, seen at one angle) as one cone.
struct LobeCone {
    float scale = 0, bias = 0;  // directional albedo = specular * scale + (1 - specular) * bias
    vec2 direction{0, 1};       // unit mean direction: along the mirrored view's tangent, and along the normal
    float half_angle = 0;       // radians: a uniform cone with the lobe's mean resultant length R has cos(half angle) = 2 R - 1
};

/// Integrals of the lobe over the hemisphere by importance sampling: `samples` Owen-scrambled Sobol points an entry. Entries are
/// even in sqrt(alpha), row by row, and in the cosine between normal and view; between them they are blended.
class LobeTable {
  public:
    static constexpr int widths = 32, views = 32;
    explicit LobeTable(Lobe lobe);
    std::span<const LobeCone> entries() const { return entries_; }

  private:
    std::vector<LobeCone> entries_;
};

/// The table of a lobe; built when first asked for.
const LobeTable& lobe_table(Lobe lobe);

/// The tables of all lobes that a picture's surfaces have, one after another.
class LobeTables {
  public:
    LobeTables(const GBuffer& gbuffer, const Scene& scene);
    /// The entry with which a glossy pixel's table begins.
    int first(std::size_t pixel) const {
        if (only_ >= 0) return only_;
        return first_[static_cast<std::size_t>(scene_->materials[scene_->material_of(gbuffer_->triangle[pixel])].lobe)];
    }
    const LobeCone* entries() const { return entries_.data(); }
    /// No surface is glossy.
    bool empty() const { return entries_.empty(); }

  private:
    const GBuffer* gbuffer_;
    const Scene* scene_;
    std::vector<LobeCone> entries_;
    std::array<int, lobe_count> first_;  // by lobe; -1 where no surface has it
    int only_ = -1;                      // where all surfaces have the same lobe
};

}  // namespace interreflect
