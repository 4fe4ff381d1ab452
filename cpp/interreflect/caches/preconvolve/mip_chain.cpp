#include "caches/preconvolve/mip_chain.h"

#include <algorithm>
#include <vector>

#include "caches/fill/texels.h"
#include "math/hemisphere_map.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

/// A weighted mean of texels of a finer map.
struct Share {
    int texel;
    float weight;
};
using Mean = std::vector<Share>;

/// Texels of an m x m map from those of an n x n one, by how much of each lies within: equal areas are equal solid angles.
std::vector<Mean> coarser(int n, int m) {
    const float step = static_cast<float>(n) / static_cast<float>(m);
    const auto overlap = [&](int texel, int fine) {
        const float begin = std::max(static_cast<float>(texel) * step, static_cast<float>(fine));
        const float end = std::min(static_cast<float>(texel + 1) * step, static_cast<float>(fine + 1));
        return std::max(end - begin, 0.0f) / step;
    };
    std::vector<Mean> means;
    for (int y = 0; y < m; ++y)
        for (int x = 0; x < m; ++x) {
            Mean& mean = means.emplace_back();
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i)
                    if (const float weight = overlap(x, i) * overlap(y, j); weight > 0.0f) mean.push_back({j * n + i, weight});
        }
    return means;
}

/// The cosine lobe about the directions of an m x m map, from the texels of an n x n one. What lies below the cache's horizon is
/// not known; it counts as what is.
std::vector<Mean> cosine_lobes(int n, int m) {
    std::vector<Mean> means;
    for (int y = 0; y < m; ++y)
        for (int x = 0; x < m; ++x) {
            const vec3 normal = hemisphere_direction(map_texel_centre(x, y, m));
            Mean& mean = means.emplace_back();
            float sum = 0;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const float cosine = glm::dot(normal, hemisphere_direction(map_texel_centre(i, j, n)));
                    if (cosine <= 0.0f) continue;
                    mean.push_back({j * n + i, cosine});
                    sum += cosine;
                }
            // One texel's centre may lie on the horizon of a direction that points along it.
            if (sum <= 0.0f) mean.assign(1, {0, sum = 1.0f});
            for (auto& share : mean) share.weight /= sum;
        }
    return means;
}

void add_up(const std::vector<Mean>& means, const vec4* from, vec4* to) {
    for (std::size_t i = 0; i < means.size(); ++i) {
        vec4 sum(0);
        for (const auto& share : means[i]) sum += from[share.texel] * share.weight;
        to[i] = sum;
    }
}

/// The cosine lobe is so wide that a coarse level will do.
constexpr int cosine_source = 8;

struct Convolution {
    std::vector<std::vector<Mean>> levels;  // 1 and on, from the one before
    std::vector<Mean> table;
    int table_source = 0;  // level

    Convolution(const std::vector<int>& sizes, int table_size) {
        for (std::size_t i = 1; i < sizes.size(); ++i) levels.push_back(coarser(sizes[i - 1], sizes[i]));
        while (sizes[table_source] > cosine_source) ++table_source;
        table = cosine_lobes(sizes[table_source], table_size);
    }
};

void store(const std::vector<vec4>& texels, std::uint16_t* to) {
    for (const auto& texel : texels) write_texel(to, vec3(texel), texel.w), to += 4;
}

void convolve_layer(const Convolution& by, const Buffer<std::uint16_t>& filled, std::size_t caches, ConvolvedCaches& shape,
                    ConvolvedCaches::Layer& layer) {
    const auto base = static_cast<std::size_t>(shape.level_sizes[0]) * shape.level_sizes[0];
    const auto chain = static_cast<std::size_t>(shape.chain_texels), table = by.table.size();
    layer.chain = Buffer<std::uint16_t>(4 * caches * chain);
    layer.table = Buffer<std::uint16_t>(4 * caches * table);
    parallel_blocks(caches, 16, [&](std::size_t begin, std::size_t end) {
        std::vector<vec4> finer(base), coarse, cosine(table);
        for (std::size_t cache = begin; cache < end; ++cache) {
            finer.resize(base);
            for (std::size_t i = 0; i < base; ++i) finer[i] = read_texel(filled.data() + 4 * (cache * base + i));
            for (std::size_t level = 0; level < shape.level_sizes.size(); ++level) {
                if (level > 0) {
                    coarse.resize(by.levels[level - 1].size());
                    add_up(by.levels[level - 1], finer.data(), coarse.data());
                    store(coarse, layer.chain.data() + 4 * (cache * chain + shape.level_begins[level]));
                    finer.swap(coarse);
                }
                if (static_cast<int>(level) == by.table_source) {
                    add_up(by.table, finer.data(), cosine.data());
                    store(cosine, layer.table.data() + 4 * cache * table);
                }
            }
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
