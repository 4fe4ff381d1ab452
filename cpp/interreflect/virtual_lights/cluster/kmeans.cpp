#include "virtual_lights/cluster/kmeans.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "virtual_lights/cluster/cluster_texels.h"
#include "virtual_lights/cluster/member_places.h"
#include "virtual_lights/sample/texel_lights.h"

namespace interreflect {
namespace {

class Clustering {
  public:
    Clustering(const KMeans& technique, const LightMaps& maps, std::size_t clusters)
        : technique_(technique), maps_(maps), metric_(technique, maps), first_(first_texels(maps)), cluster_(first_.back()) {
        centres_.resize(clusters);
    }

    /// Centres where the last frame's lights stood, or at the seeds where the map shows no lit surface there now.
    void start(const VirtualLights& seeds, const VirtualLights* last) {
        const bool keep = last != nullptr && last->size() == seeds.size() && last->map_sizes == seeds.map_sizes;
        for (std::size_t c = 0; c < centres_.size(); ++c) {
            if (keep && last->members[c] > 0) centres_[c] = centre_of_texel(last->texel[c]);
            if (!keep || last->members[c] == 0 || !centres_[c].valid) centres_[c] = centre_of_texel(seeds.texel[c]);
        }
    }
    void assign() { strays_ = assign_texels(technique_, maps_, metric_, centres_, cluster_); }
    /// Centres move to the mean of their texels.
    void average() {
        std::vector<vec3> origins;
        for (const ClusterCentre& centre : centres_) origins.push_back(centre.position);
        sums_ = sum_texels(maps_, cluster_, std::move(origins));
        typical_.resize(centres_.size());
        for (std::size_t c = 0; c < centres_.size(); ++c) typical_[c] = sums_.members(c) > 0 ? sums_.typical(c) : TypicalPlace{};
        nearest_ = pick_members(maps_, cluster_, typical_, Pick::nearest);
        for (std::size_t c = 0; c < centres_.size(); ++c) {
            if (sums_.members(c) == 0) continue;
            centres_[c] = centre_of_texel(nearest_[c]);
            if (typical_[c].normal != vec3(0)) centres_[c].normal = typical_[c].normal;
            centres_[c].position = typical_[c].position;
        }
    }
    /// Centres without texels start anew at the furthest texels of the clusters that have most texels.
    std::uint64_t reseed() {
        std::vector<std::uint32_t> order(centres_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return sums_.members(a) > sums_.members(b); });
        std::vector<std::uint32_t> furthest;
        std::size_t next = 0;
        std::uint64_t reseeded = 0;
        for (std::size_t c = 0; c < centres_.size(); ++c) {
            if (sums_.members(c) > 0) continue;
            if (furthest.empty()) furthest = pick_members(maps_, cluster_, typical_, Pick::furthest);
            if (next == order.size() || sums_.members(order[next]) < 2) break;
            centres_[c] = centre_of_texel(furthest[order[next++]]);
            ++reseeded;
        }
        return reseeded;
    }
    VirtualLights lights() {
        const std::size_t n = centres_.size();
        VirtualLights made = make_virtual_lights(n);
        made.map_sizes = sizes_of(maps_);
        for (std::size_t c = 0; c < n; ++c) set_light(made, c);
        made.places = member_places(maps_, cluster_, made.texel.span());
        made.cluster = std::move(cluster_);
        made.counts.virtual_lights = n;
        made.counts.stray_texels = strays_;
        return made;
    }

  private:
    ClusterCentre centre_of_texel(std::uint32_t number) const {
        const auto map = static_cast<std::size_t>(std::ranges::upper_bound(first_, std::size_t{number}) - first_.begin()) - 1;
        return centre_at(maps_, metric_, map, number - first_[map]);
    }
    void set_light(VirtualLights& made, std::size_t c) const {
        const ClusterCentre& centre = centres_[c];
        const ReflectiveShadowMap& map = maps_.maps[static_cast<std::size_t>(centre.map)];
        const std::size_t texel = static_cast<std::size_t>(centre.y) * map.size + centre.x;
        const auto members = static_cast<float>(sums_.members(c));
        const bool mean = technique_.centre == "mean";
        made.position[c] = mean ? centre.position : map.position[texel];
        made.normal[c] = mean || map.normal[texel] == vec3(0) ? centre.normal : map.normal[texel];
        made.flux[c] = technique_.flux == "centre" ? map.flux[texel] * members : vec3(sums_.sums[c].flux);
        const double own = sums_.sums[c].area, spread = members < 2 ? own : sums_.spread_area(c);
        made.area[c] = static_cast<float>(technique_.area == "texels" ? own : std::min(own, spread));
        made.offset[c] = map.offset[texel];
        made.texel[c] = static_cast<std::uint32_t>(first_[static_cast<std::size_t>(centre.map)] + texel);
        made.members[c] = sums_.members(c);
    }

    const KMeans& technique_;
    const LightMaps& maps_;
    TexelMetric metric_;
    std::vector<std::size_t> first_;
    std::vector<ClusterCentre> centres_;
    Buffer<std::uint32_t> cluster_;
    ClusterSums sums_;
    std::vector<TypicalPlace> typical_;
    std::vector<std::uint32_t> nearest_;
    std::uint64_t strays_ = 0;
};

}  // namespace

VirtualLights cluster_lights(const KMeans& technique, const VirtualLights& seeds, const LightMaps& maps,
                             const VirtualLights* last, std::uint32_t) {
    if (seeds.map_sizes != sizes_of(maps)) throw std::invalid_argument("KMeans: the seeds are not texels of these maps");
    if (seeds.size() == 0) {
        VirtualLights none = make_virtual_lights(0);
        none.map_sizes = seeds.map_sizes;
        return none;
    }
    Clustering clustering(technique, maps, seeds.size());
    clustering.start(seeds, last);
    std::uint64_t reseeded = 0;
    for (int i = 0; i < technique.iterations; ++i) {
        if (i > 0) reseeded += clustering.reseed();
        clustering.assign();
        clustering.average();
    }
    VirtualLights lights = clustering.lights();
    lights.counts.reseeded_lights = reseeded;
    return lights;
}

}  // namespace interreflect
