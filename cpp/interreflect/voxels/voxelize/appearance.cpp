#include "voxels/voxelize/appearance.h"

#include <stdexcept>

namespace interreflect {

void refuse_longer_than_most_voxels(float length) {
    if (!(length < most_voxels))
        throw std::invalid_argument("voxelize: a triangle is longer than 2^20 voxels: the domain's voxels are too small");
}

}  // namespace interreflect
