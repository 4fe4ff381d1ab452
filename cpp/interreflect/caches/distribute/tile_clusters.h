/// The pixels of one tile in clusters: those that share a key.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "caches/distribute/tile_pixels.h"
#include "data/caches.h"

namespace interreflect {

class TileClusters {
  public:
    struct Cluster {
        std::uint32_t key = 0, members = 0;
        vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};
        vec3 normal{0};           // sum of its pixels'
        std::uint32_t pixel = 0;  // of the tile, that stands for it; before one is chosen the first
    };

    /// Clusters in ascending order of their keys, and `slot` of each pixel of the tile, row by row, with room: its cluster's
    /// number, or `none` where nothing was hit.
    static constexpr std::uint32_t none = no_cache;
    std::vector<Cluster> clusters;
    std::vector<std::uint32_t> slot;

    /// Groups the tile's pixels by `key`, row by row: any numbers, `none` where nothing was hit; without choosing pixels.
    void group(const TilePixels& pixels, std::span<const std::uint32_t> key);
    /// How many different ones there are besides `none`.
    std::size_t count(std::span<const std::uint32_t> key);
    /// Of every cluster the pixel with the best score of Rehfeld et al. 2014, 3.2, "Placing Caches":
    ///   (n_p . n_c + (p - c) . n_c / e) / (1 + d / e)
    /// with n_c the mean normal, c the centre of the box about the cluster, and d the distance of p from the line through c along
    /// n_c. Lengths are relative to e, the diagonal of that box: as printed the sum of a cosine and a length depends on the
    /// scene's unit (ERRATA).
    void choose_pixels(const TilePixels& pixels);

  private:
    void start();
    std::uint32_t find(std::uint32_t key);
    void sort();

    std::vector<std::uint32_t> table_;  // open addressing: slots by a hash of their keys
    std::uint32_t last_ = none;         // slot that was found, most often the next one too
    ClusterLines lines_;
    std::vector<BestPixel> best_;
};

}  // namespace interreflect
