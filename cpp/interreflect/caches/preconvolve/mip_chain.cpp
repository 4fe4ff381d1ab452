#include "caches/preconvolve/mip_chain.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "caches/preconvolve/convolve.h"
#include "math/hemisphere_map.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

/// Texels of an m x m map from those of an n x n one, by how much of each lies within, which is its solid angle, times `weights`
/// of theirs.
SparseMeans coarser(int n, int m, const std::vector<float>& weights) {
    const float step = static_cast<float>(n) / static_cast<float>(m);
    const auto overlap = [&](int texel, int fine) {
        const float begin = std::max(static_cast<float>(texel) * step, static_cast<float>(fine));
        const float end = std::min(static_cast<float>(texel + 1) * step, static_cast<float>(fine + 1));
        return std::max(end - begin, 0.0f) / step;
    };
    SparseMeans means{{0}, {}};
    for (int y = 0; y < m; ++y)
        for (int x = 0; x < m; ++x) {
            const std::size_t first = means.shares.size();
            float sum = 0;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const int texel = j * n + i;
                    const float weight = overlap(x, i) * overlap(y, j) * weights[static_cast<std::size_t>(texel)];
                    if (weight > 0.0f) means.shares.push_back({texel, weight}), sum += weight;
                }
            for (std::size_t k = first; k < means.shares.size(); ++k) means.shares[k].weight /= sum;
            means.first.push_back(static_cast<int>(means.shares.size()));
        }
    return means;
}

SparseMeans coarser(int n, int m) {
    return coarser(n, m, std::vector<float>(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 1.0f));
}

/// Directions all over the texels of an n x n map, texel by texel.
constexpr int directions_each = 16;
std::vector<vec3> directions_in(int n) {
    constexpr int side = 4;
    static_assert(side * side == directions_each);
    std::vector<vec3> directions;
    for (int texel = 0; texel < n * n; ++texel)
        for (int i = 0; i < directions_each; ++i) {
            const int x = side * (texel % n) + i % side, y = side * (texel / n) + i / side;
            directions.push_back(hemisphere_direction(map_texel_centre(x, y, side * n)));
        }
    return directions;
}

/// The mean cosine to `normal` over each texel, as the one at its centre is far off on the map's diagonals.
std::vector<float> mean_cosines(const std::vector<vec3>& directions, const vec3& normal) {
    std::vector<float> cosines(directions.size() / directions_each, 0.0f);
    for (std::size_t i = 0; i < directions.size(); ++i)
        cosines[i / directions_each] += std::max(glm::dot(normal, directions[i]), 0.0f) / static_cast<float>(directions_each);
    return cosines;
}

/// The cosine lobe about the directions of an m x m map, from the texels of an n x n one. What lies below the cache's horizon is
/// not known; it counts as what is.
DenseMeans cosine_lobes(int n, int m) {
    DenseMeans means(n * n, m * m);
    const std::vector<vec3> directions = directions_in(n);
    for (int y = 0; y < m; ++y)
        for (int x = 0; x < m; ++x) {
            const std::vector<float> cosines = mean_cosines(directions, hemisphere_direction(map_texel_centre(x, y, m)));
            const float sum = std::accumulate(cosines.begin(), cosines.end(), 0.0f);
            for (int i = 0; i < n * n; ++i) means.set(i, y * m + x, cosines[static_cast<std::size_t>(i)] / sum);
        }
    return means;
}

/// The cosine lobe is so wide that a coarse level will do.
constexpr int cosine_source = 16;

int table_source(const std::vector<int>& sizes) {
    int level = 0;
    while (sizes[level] > cosine_source) ++level;
    return level;
}

struct Convolution {
    std::vector<SparseMeans> levels;  // 1 and on, from the one before
    /// Of a map finer than the table reads: its texels by their cosines, so that the lobe about the cache's own normal is exact.
    std::optional<SparseMeans> source;
    int inputs;  // texels that the table reads
    DenseMeans table;

    Convolution(const std::vector<int>& sizes, int table_size)
        : Convolution(sizes, table_size, sizes[static_cast<std::size_t>(table_source(sizes))]) {}

  private:
    Convolution(const std::vector<int>& sizes, int table_size, int read)
        : inputs(read * read), table(cosine_lobes(read, table_size)) {
        for (std::size_t i = 1; i < sizes.size(); ++i) levels.push_back(coarser(sizes[i - 1], sizes[i]));
        if (read < sizes[0]) source = coarser(sizes[0], read, mean_cosines(directions_in(sizes[0]), vec3(0, 0, 1)));
    }
};

void convolve_layer(const Convolution& by, const Buffer<std::uint16_t>& filled, std::size_t caches, ConvolvedCaches& shape,
                    ConvolvedCaches::Layer& layer) {
    const auto base = 4 * static_cast<std::size_t>(shape.level_sizes[0]) * shape.level_sizes[0];
    const auto chain = 4 * static_cast<std::size_t>(shape.chain_texels);
    const auto table = 4 * static_cast<std::size_t>(shape.table_size) * shape.table_size;
    layer.chain = Buffer<std::uint16_t>(caches * chain);
    layer.table = Buffer<std::uint16_t>(caches * table);
    constexpr std::size_t together = 4;
    parallel_blocks(caches, 16 * together, [&](std::size_t begin, std::size_t end) {
        const auto wide = static_cast<std::size_t>(by.table.stride());
        const std::size_t read = by.source ? 4 * static_cast<std::size_t>(by.inputs) : 0;
        std::vector<float> levels(together * (base + chain)), cosine(together * wide), sources(together * read);
        // Of one of the caches: level 0, and then the chain as it is stored.
        const auto level_at = [&](std::size_t one, std::size_t i) {
            return levels.data() + one * (base + chain) +
                   (i == 0 ? 0 : base + 4 * static_cast<std::size_t>(shape.level_begins[i]));
        };
        const float* from[together];
        float* to[together];
        for (std::size_t one = 0; one < together; ++one)
            from[one] = by.source ? sources.data() + one * read : level_at(one, 0), to[one] = cosine.data() + one * wide;
        for (std::size_t first = begin; first < end; first += together) {
            const std::size_t count = std::min(together, end - first);
            for (std::size_t one = 0; one < count; ++one) {
                halves_to_floats(filled.data() + (first + one) * base, base, level_at(one, 0));
                for (std::size_t i = 0; i < by.levels.size(); ++i) apply(by.levels[i], level_at(one, i), level_at(one, i + 1));
                if (by.source) apply(*by.source, level_at(one, 0), sources.data() + one * read);
                floats_to_halves(level_at(one, 0) + base, chain, layer.chain.data() + (first + one) * chain);
            }
            apply(by.table, from, to);
            for (std::size_t one = 0; one < count; ++one)
                floats_to_halves(to[one], table, layer.table.data() + (first + one) * table);
        }
    });
}

}  // namespace

ConvolvedCaches preconvolve(const MipChain& technique, std::shared_ptr<const FilledCaches> filled) {
    ConvolvedCaches convolved;
    convolved.table_size = technique.table;
    convolved.width = technique.width == "resultant" ? LobeWidth::resultant : LobeWidth::one_percent;
    convolved.level_bias = static_cast<float>(technique.level_bias);
    convolved.level_sizes = {filled->resolution};
    convolved.level_begins = {0};
    while (convolved.level_sizes.back() > 1) {
        const int next = (convolved.level_sizes.back() + 1) / 2;
        convolved.level_sizes.push_back(next);
        convolved.level_begins.push_back(convolved.chain_texels);
        convolved.chain_texels += next * next;
    }
    const Convolution by(convolved.level_sizes, technique.table);
    convolve_layer(by, filled->texels, filled->places->size(), convolved, convolved.light);
    if (!filled->sky.empty()) convolve_layer(by, filled->sky, filled->places->size(), convolved, convolved.sky);
    convolved.filled = std::move(filled);
    return convolved;
}

}  // namespace interreflect
