#include "virtual_lights/sample/importance_pyramid.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {
namespace {

/// Chooses between two parts; `u` becomes where it lies in the chosen one.
bool second_of(double first, double second, double& u) {
    const double share = first / (first + second);
    if (u < share || !(second > 0)) {
        u = std::min(u / share, 1.0 - 0x1p-53);
        return false;
    }
    u = std::min((u - share) / (1.0 - share), 1.0 - 0x1p-53);
    return true;
}

}  // namespace

ImportancePyramid::ImportancePyramid(const LightMaps& maps,
                                     const std::function<float(const ReflectiveShadowMap&, std::size_t)>& importance) {
    for (const auto& map : maps.maps) {
        Map made;
        made.levels.push_back({map.size, map.size, std::vector<double>(map.texels())});
        parallel_blocks(map.texels(), 16384, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) made.levels[0].sums[i] = importance(map, i);
        });
        while (made.levels.back().width > 1) {
            const Level& fine = made.levels.back();
            Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
            coarse.sums.assign(static_cast<std::size_t>(coarse.width) * coarse.height, 0.0);
            for (int y = 0; y < fine.height; ++y)
                for (int x = 0; x < fine.width; ++x)
                    coarse.sums[static_cast<std::size_t>(y / 2) * coarse.width + x / 2] +=
                        fine.sums[static_cast<std::size_t>(y) * fine.width + x];
            made.levels.push_back(std::move(coarse));
        }
        total_ += made.levels.back().sums[0];
        maps_.push_back(std::move(made));
    }
}

ImportancePyramid::Choice ImportancePyramid::choose(double x, double y) const {
    const double at = x * total_;
    std::size_t chosen = 0;
    double below = 0, begin = 0;
    for (std::size_t i = 0; i < maps_.size() && below <= at; ++i) {
        const double share = maps_[i].levels.back().sums[0];
        if (share > 0) chosen = i, begin = below;
        below += share;
    }
    const Map& map = maps_[chosen];
    const double whole = map.levels.back().sums[0];
    x = std::clamp((at - begin) / whole, 0.0, 1.0 - 0x1p-53);
    int column = 0, row = 0;
    for (std::size_t level = map.levels.size() - 1; level-- > 0;) {
        const Level& fine = map.levels[level];
        const auto sum = [&](int i, int j) {
            return i < fine.width && j < fine.height ? fine.sums[static_cast<std::size_t>(j) * fine.width + i] : 0.0;
        };
        column *= 2, row *= 2;
        if (second_of(sum(column, row) + sum(column, row + 1), sum(column + 1, row) + sum(column + 1, row + 1), x)) ++column;
        if (second_of(sum(column, row), sum(column, row + 1), y)) ++row;
    }
    const auto texel = static_cast<std::size_t>(row) * map.levels[0].width + column;
    return {chosen, texel, map.levels[0].sums[texel] / total_};
}

}  // namespace interreflect
