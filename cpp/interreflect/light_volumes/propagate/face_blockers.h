/// What is blocked in the middle of every face between cells: the mean of its four corners.
#pragma once
#include <cstddef>

#include "data/light_volume.h"

namespace interreflect {

class FaceBlockers {
  public:
    explicit FaceBlockers(const GeometryVolume& volume);

    /// Coefficient k of the faces before a row of cells, across an axis; rows may be read as far beyond their end as those of
    /// Planes.
    const float* before(int axis, int k, int y, int z) const { return mean_[axis][k].data() + number({0, y, z}); }
    /// From there to the faces behind the cells.
    std::ptrdiff_t step(int axis) const {
        return axis == 0 ? 1 : axis == 1 ? corners_.x : static_cast<std::ptrdiff_t>(corners_.x) * corners_.y;
    }

  private:
    std::size_t number(const ivec3& at) const { return static_cast<std::size_t>(at.x + corners_.x * (at.y + corners_.y * at.z)); }
    ivec3 corners_;
    Buffer<float> mean_[3][LightVolume::harmonics];  // of the faces across each axis, each at its lowest corner
};

}  // namespace interreflect
