#include "light_volumes/propagate/face_blockers.h"

#include "light_volumes/propagate/planes.h"
#include "math/parallel.h"

namespace interreflect {

FaceBlockers::FaceBlockers(const GeometryVolume& volume) : corners_(volume.corners()) {
    const std::size_t count = volume.coefficients.size() / LightVolume::harmonics;
    for (auto& axis : mean_)
        for (auto& plane : axis) plane = Buffer<float>(count + row_slack, 0.0f);
    // Faces beyond the last corners are no cell's.
    parallel_pieces(static_cast<std::size_t>(volume.domain.cells.z) + 1, [&](std::size_t layer) {
        const int z = static_cast<int>(layer);
        for (int axis = 0; axis < 3; ++axis) {
            ivec3 second(0), third(0);
            second[(axis + 1) % 3] = third[(axis + 2) % 3] = 1;
            for (int y = 0; y < corners_.y; ++y)
                for (int x = 0; x < corners_.x; ++x) {
                    const ivec3 at(x, y, z), last = corners_ - 1;
                    const std::size_t corner[4] = {number(at), number(glm::min(at + second, last)),
                                                   number(glm::min(at + third, last)),
                                                   number(glm::min(at + second + third, last))};
                    for (std::size_t k = 0; k < LightVolume::harmonics; ++k) {
                        float sum = 0;
                        for (const std::size_t i : corner) sum += volume.coefficients[i * LightVolume::harmonics + k];
                        mean_[axis][k][corner[0]] = 0.25f * sum;
                    }
                }
        }
    });
}

}  // namespace interreflect
