/// The nearest of patches that come and go.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "surfels/cluster/patch.h"

namespace interreflect {

struct NearestPatch {
    float distance = std::numeric_limits<float>::infinity();
    std::uint32_t number = std::numeric_limits<std::uint32_t>::max();
};
inline std::uint32_t gap(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

/// A hierarchy of boxes about the patches' places, normals and areas. What is found is exact: of those at the same distance, the
/// one whose number is nearest, then the lower one: equal patches find each other in pairs, where a lowest number would be every
/// one's choice, and all would have to look again once it is gone.
class PatchSearch {
  public:
    /// `numbers`: of those patches to be found; numbers up to `capacity` may come.
    PatchSearch(const PatchMetric& metric, std::span<const Patch> patches, std::span<const std::uint32_t> numbers,
                std::size_t capacity);

    /// Besides patch `number` itself; that of a default NearestPatch where there is none.
    NearestPatch nearest(const Patch& patch, std::uint32_t number) const;
    bool contains(std::uint32_t number) const { return slot_[number] != none; }
    void remove(std::uint32_t number);
    /// `patch` takes the place of patch `old`; good where they lie near each other.
    void replace(std::uint32_t old, std::uint32_t number, const Patch& patch);

  private:
    static constexpr std::size_t axes = 7, width = 8;  // place, normal, area
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    using Lanes = std::array<float, width>;
    struct alignas(64) Box {
        std::array<float, axes> lower, upper;
        std::uint32_t first, last;  // lowest and highest number in it
        bool operator==(const Box&) const = default;
    };
    struct alignas(64) Leaf {
        std::array<Lanes, axes> value;
        std::array<std::uint32_t, width> number;
    };
    struct Item {
        std::array<float, axes> value;
        std::uint32_t number;
    };

    float bound(const Patch& patch, const Box& box) const;
    void search_leaf(const Patch& patch, std::uint32_t number, const Leaf& leaf, NearestPatch& best) const;
    void build(std::span<Item> items, std::size_t node);
    std::size_t widest(std::span<const Item> items) const;
    void put(std::size_t slot, const Item& item);
    static Item item_of(const Patch& patch, std::uint32_t number);
    void fit_leaf(std::size_t leaf);
    bool fit_inner(std::size_t node);  // whether that changed anything
    void fit(std::size_t slot);

    PatchMetric metric_;
    std::vector<Box> boxes_;  // 1 is the root, the children of i are 2i and 2i + 1, the last half are the leaves'
    std::vector<Leaf> leaves_;
    std::vector<std::uint32_t> slot_;  // of each number
};

}  // namespace interreflect
