#include "caches/distribute/reuse_caches.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "caches/distribute/find_again.h"
#include "caches/distribute/place.h"
#include "math/parallel.h"
#include "visibility/sphere_hierarchy.h"

namespace interreflect {
namespace {

std::vector<mat4x3> poses_of(const Scene& scene) {
    std::vector<mat4x3> poses;
    for (const Instance& instance : scene.geometry->instances) poses.push_back(instance.world_from_local);
    return poses;
}

/// By the last frame's tiles, while they yield about as many clusters as are wanted.
template <class Technique>
CachePlaces distribute_steadily(const Technique& technique, double tolerance, const GBuffer& gbuffer, const Scene& scene,
                                const CachePlaces& last) {
    if (technique.caches > 0 && last.width == gbuffer.width && last.height == gbuffer.height) {
        Technique same = technique;
        same.caches = 0, same.tile = last.tile;
        CachePlaces places = distribute(same, gbuffer, scene, nullptr);
        const double ratio = static_cast<double>(places.size()) / technique.caches;
        if (ratio <= 1.0 + tolerance && ratio * (1.0 + tolerance) >= 1.0) return places;
    }
    return distribute(technique, gbuffer, scene, nullptr);
}

/// Caches of this frame as numbers: of the last frame's that stay, or of the new ones.
struct Choice {
    std::vector<const SeenAgain*> stays;  // null: new
    std::vector<std::uint32_t> fresh;     // its cluster
    std::vector<std::uint32_t> begins;    // of cluster c: begins[c] up to begins[c + 1]
};

/// Which clusters' new caches would stand where one that stays serves their pixels: found through a hierarchy of those that stay
/// [Rehfeld et al. 2014, 6].
std::vector<std::uint8_t> served(const ReuseCaches& technique, const std::vector<SeenAgain>& stay, const CachePlaces& last,
                                 const CachePlaces& fresh, const GBuffer& gbuffer) {
    std::vector<std::uint8_t> is_served(fresh.size(), 0);
    if (technique.spacing <= 0.0) return is_served;
    const float angle = tile_angle(gbuffer, fresh.tile);
    const float least_cosine = std::cos(static_cast<float>(technique.max_angle) * degrees_to_radians);
    std::vector<vec3> centres;
    std::vector<float> radii;
    for (const SeenAgain& cache : stay) {
        centres.push_back(cache.position);
        radii.push_back(static_cast<float>(technique.spacing) *
                        tile_footprint(gbuffer.camera.position, cache.position, cache.geometric_normal, angle));
    }
    const SphereHierarchy hierarchy(centres, radii);
    parallel_blocks(fresh.size(), 256, [&](std::size_t begin, std::size_t end) {
        thread_local std::vector<std::uint32_t> near;
        for (std::size_t i = begin; i < end; ++i) {
            hierarchy.reach(fresh.position[i], 0.0f, near);
            for (const std::uint32_t k : near)
                if (last.body[stay[k].last] == fresh.body[i] && glm::dot(stay[k].normal, fresh.normal[i]) >= least_cosine)
                    is_served[i] = 1;
        }
    });
    return is_served;
}

/// Of those in one cluster the ones that lasted longest, and of equals the first: in the order of their clusters.
void thin_out(std::vector<SeenAgain>& seen, const CachePlaces& fresh, const Buffer<std::uint32_t>& age, int most) {
    const auto cluster_of = [&](const SeenAgain& cache) { return fresh.cluster[cache.pixel]; };
    std::erase_if(seen, [&](const SeenAgain& cache) { return cluster_of(cache) == no_cache; });
    std::stable_sort(seen.begin(), seen.end(), [&](const SeenAgain& a, const SeenAgain& b) {
        return cluster_of(a) != cluster_of(b) ? cluster_of(a) < cluster_of(b) : age[a.last] > age[b.last];
    });
    std::uint32_t cluster = no_cache;
    int kept = 0;
    std::erase_if(seen, [&](const SeenAgain& cache) {
        kept = cluster_of(cache) == cluster ? kept + 1 : 1;
        cluster = cluster_of(cache);
        return kept > most;
    });
}

/// Those that stay, and a new one for every cluster that is neither theirs nor served by them.
Choice choose(const std::vector<SeenAgain>& stay, const std::vector<std::uint8_t>& is_served, const CachePlaces& fresh) {
    Choice choice;
    auto next = stay.cbegin();
    for (std::uint32_t cluster = 0; cluster < fresh.size(); ++cluster) {
        choice.begins.push_back(static_cast<std::uint32_t>(choice.stays.size()));
        const auto begin = next;
        for (; next != stay.cend() && fresh.cluster[next->pixel] == cluster; ++next)
            choice.stays.push_back(&*next), choice.fresh.push_back(cluster);
        if (next == begin && is_served[cluster] == 0) choice.stays.push_back(nullptr), choice.fresh.push_back(cluster);
    }
    choice.begins.push_back(static_cast<std::uint32_t>(choice.stays.size()));
    return choice;
}

/// The caches of a choice, tile by tile. New ones are as they were placed.
CachePlaces places_of(const Choice& choice, CachePlaces fresh, const GBuffer& gbuffer) {
    std::vector<std::uint32_t> pixels, members;
    for (std::size_t i = 0; i < choice.stays.size(); ++i) {
        const std::uint32_t cluster = choice.fresh[i];
        pixels.push_back(choice.stays[i] != nullptr ? choice.stays[i]->pixel : fresh.pixel[cluster]);
        members.push_back(fresh.members[cluster]);
    }
    CachePlaces places = tiles_of(gbuffer, fresh.tile);
    place_caches(gbuffer, pixels, members, places);
    for (const std::uint32_t first : fresh.first) places.first.push_back(choice.begins[first]);
    places.cluster = std::move(fresh.cluster);
    parallel_blocks(gbuffer.pixels(), 65536, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t cluster = places.cluster[i];
            if (cluster == no_cache) continue;
            const bool empty = choice.begins[cluster] == choice.begins[cluster + 1];
            places.cluster[i] = empty ? no_cache : choice.begins[cluster];
        }
    });
    places.counts.clusters = fresh.counts.clusters;
    return places;
}

void keep(const SeenAgain& cache, const GBuffer& gbuffer, float angle, std::size_t i, CachePlaces& places) {
    places.position[i] = cache.position, places.normal[i] = cache.normal;
    places.geometric_normal[i] = cache.geometric_normal, places.screen[i] = cache.screen;
    places.footprint[i] = tile_footprint(gbuffer.camera.position, cache.position, cache.geometric_normal, angle);
}

CachePlaces::Track new_track(const CachePlaces& places, const GBuffer& gbuffer, const Scene& scene) {
    CachePlaces::Track track{gbuffer.camera, poses_of(scene), Buffer<std::uint32_t>(places.size()),
                             Buffer<std::uint32_t>(places.size())};
    for (std::size_t i = 0; i < places.size(); ++i) track.instance[i] = gbuffer.instance[places.pixel[i]], track.age[i] = 0;
    return track;
}

}  // namespace

CachePlaces distribute(const ReuseCaches& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces* last) {
    if (last != nullptr && !last->track) throw std::invalid_argument("ReuseCaches: the history is not of ReuseCaches");
    CachePlaces fresh = std::visit(
        [&](const auto& own) {
            return last == nullptr ? distribute(own, gbuffer, scene, nullptr)
                                   : distribute_steadily(own, technique.tolerance, gbuffer, scene, *last);
        },
        technique.distribute);
    if (last == nullptr) {
        fresh.track = new_track(fresh, gbuffer, scene);
        return fresh;
    }
    const float angle = tile_angle(gbuffer, fresh.tile);
    std::vector<SeenAgain> seen = find_again(technique, *last, gbuffer, scene, angle);
    thin_out(seen, fresh, last->track->age, technique.most);
    const Choice choice = choose(seen, served(technique, seen, *last, fresh, gbuffer), fresh);
    CachePlaces places = places_of(choice, std::move(fresh), gbuffer);
    places.track = new_track(places, gbuffer, scene);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (choice.stays[i] == nullptr) continue;
        const SeenAgain& cache = *choice.stays[i];
        keep(cache, gbuffer, angle, i, places);
        places.track->instance[i] = last->track->instance[cache.last];
        places.track->age[i] = last->track->age[cache.last] + 1;
        ++places.counts.reused_caches;
    }
    return places;
}

}  // namespace interreflect
