/// The pixels of one tile in clusters: those that share a key.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "data/caches.h"
#include "data/gbuffer.h"
#include "math/parallel.h"

namespace interreflect {

class TileClusters {
  public:
    struct Cluster {
        std::uint32_t key = 0, members = 0;
        vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};
        vec3 normal{0};  // sum of its pixels'
        float score = -std::numeric_limits<float>::infinity();
        std::uint32_t pixel = 0;  // that stands for it
    };

    /// Clusters in ascending order of their keys, and `slot` of each pixel of the tile, row by row: its cluster's number, or
    /// `none` where nothing was hit.
    static constexpr std::uint32_t none = no_cache;
    std::vector<Cluster> clusters;
    std::vector<std::uint32_t> slot;

    /// Groups the tile's pixels by key(pixel) (which need not be less than any bound), without choosing pixels.
    template <class Key>
    void group(const GBuffer& gbuffer, const Tile& tile, const Key& key) {
        start(tile);
        std::size_t at = 0;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x, ++at) {
                const std::size_t pixel = static_cast<std::size_t>(y) * gbuffer.width + x;
                slot[at] = gbuffer.hit(pixel) ? add(key(pixel), gbuffer.position[pixel], gbuffer.normal[pixel]) : none;
            }
        sort();
    }
    /// Of every cluster the pixel with the best score of Rehfeld et al. 2014, 3.2, "Placing Caches":
    ///   (n_p . n_c + (p - c) . n_c / e) / (1 + d / e)
    /// with n_c the mean normal, c the centre of the box about the cluster, and d the distance of p from the line through c along
    /// n_c. Lengths are relative to e, the diagonal of that box: as printed the sum of a cosine and a length depends on the
    /// scene's unit (ERRATA).
    void choose_pixels(const GBuffer& gbuffer, const Tile& tile);

  private:
    void start(const Tile& tile);
    std::uint32_t add(std::uint32_t key, const vec3& position, const vec3& normal);
    std::uint32_t find(std::uint32_t key);
    void sort();

    // Open addressing: slots by a hash of their keys. Neighbours mostly share theirs, so the last one is tried first.
    std::vector<std::uint32_t> table_;
    std::uint32_t last_key_ = 0;
    std::uint32_t last_slot_ = none;
};

}  // namespace interreflect
