/// Points of the unit square, warped to texels of several maps in proportion to an importance: halves are chosen level by level,
/// so points that lie apart stay apart [Clarberg et al. 2005].
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "data/buffer.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

class ImportancePyramid {
  public:
    /// `importance`: of a map's texel, at least 0.
    ImportancePyramid(const LightMaps& maps, const std::function<float(const ReflectiveShadowMap&, std::size_t)>& importance);

    struct Choice {
        std::size_t map, texel;  // of the map
        double probability;      // of this texel among all
    };
    /// total() must be above 0; x and y lie in [0, 1).
    Choice choose(double x, double y) const;
    double total() const { return total_; }

  private:
    struct Level {
        int width, height;
        std::vector<double> sums;
    };
    struct Map {
        std::vector<Level> levels;  // from the texels up to one sum
    };
    std::vector<Map> maps_;
    double total_ = 0;
};

}  // namespace interreflect
