#include "surfels/bodies/body_cones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "math/parallel.h"
#include "surfels/bodies/link_cone.h"
#include "surfels/light_caches.h"
#include "surfels/light_kernel.h"
#include "surfels/sites/backs.h"
#include "voxels/march/hierarchies.h"
#include "voxels/march/hit_order.h"

namespace interreflect {
namespace {

constexpr std::size_t caches_a_block = 32, capacity = ConeBatch::capacity;
constexpr int classes = 12;           // of half angles, half an octave each
constexpr float narrowest = 0.0175f;  // radians, of the first class
constexpr float most_backs = 0.3f;    // as CacheGrid's

int class_of(float half_angle) {
    const float octaves = std::log2(std::max(half_angle, narrowest) / narrowest);
    return std::min(static_cast<int>(std::lround(2.0f * octaves)), classes - 1);
}
float half_angle_of(int number) { return narrowest * std::exp2(0.5f * static_cast<float>(number)); }

struct Ball {
    vec3 centre{0};
    float radius = 0;
};
Ball ball_about(const Pyramid& body) {
    const vec3 lower = body.domain.lower, upper = body.domain.upper();
    return {body.pose.to_world(0.5f * (lower + upper)), 0.5f * glm::length(upper - lower)};
}

/// Mean place of every node's surfels.
std::vector<vec3> centres_of(const ClusteredSurfels& surfels) {
    const SurfelTree& tree = surfels.tree;
    std::vector<vec3> centre(tree.nodes());
    for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
        const std::uint32_t left = tree.leaves[i] > 1 ? tree.left(i) : 0;
        centre[i] = tree.leaves[i] == 1 ? surfels.surfels.position[tree.leaf_end[i] - 1]
                                        : glm::mix(centre[left], centre[i - 1],
                                                   static_cast<float>(tree.leaves[i - 1]) / static_cast<float>(tree.leaves[i]));
    }
    return centre;
}

/// A link that may meet a body.
struct Met {
    std::size_t link;
    LinkCone cone;
    HitOrder seen;
};

class BodyShadows {
  public:
    BodyShadows(const BodyCones& technique, Pyramids pyramids, const ClusteredSurfels& surfels, const CacheSites& sites)
        : technique_(technique), bodies_(pyramids), centre_(centres_of(surfels)) {
        vec3 lower(std::numeric_limits<float>::infinity()), upper = -lower;
        for (const vec3& p : sites.position) lower = glm::min(lower, p), upper = glm::max(upper, p);
        for (int i = 0; i < bodies_.count(); ++i) {
            const Ball ball = ball_about(bodies_.pyramid(i));
            ball_.push_back(ball);
            const vec3 far = glm::max(glm::abs(upper - ball.centre), glm::abs(lower - ball.centre));
            const float way = (glm::length(far) + ball.radius) / bodies_.pyramid(i).domain.voxel_size + 2.0f;
            for (int k = 0; k < classes; ++k)
                schedules_.push_back(make_schedule(technique.shape(half_angle_of(k)), bodies_.pyramid(i), way));
        }
    }

    /// Whether a place lies in some body's box.
    bool in_box(const vec3& place) const {
        for (int i = 0; i < bodies_.count(); ++i) {
            const Pyramid& body = bodies_.pyramid(i);
            if (body.domain.inside(body.domain.to_linear(body.pose.to_body(place)))) return true;
        }
        return false;
    }
    /// Links of one cache whose cones pass by a body's ball.
    void find(const CacheLinks& links, std::size_t cache, const vec3& from, const SurfelTree& tree, std::vector<Met>& met) const {
        thread_local std::vector<View> views;
        met.clear();
        views.clear();
        for (const Ball& ball : ball_) views.push_back(view_of(ball, from));
        const auto each = static_cast<std::size_t>(links.per_cache);
        for (std::size_t i = cache * each; i < (cache + 1) * each; ++i) {
            const LinkCone cone = cone_of(links, i, tree);
            if (cone.direction != vec3(0) && passes(cone, from, views)) met.push_back({i, cone, {}});
        }
    }
    Counts march(const vec3& from, std::vector<Met>& met) const {
        thread_local ConeBatch batch;
        const auto aperture = static_cast<float>(technique_.aperture);
        Counts counts;
        for (int body = 0; body < bodies_.count(); ++body)
            for (int k = 0; k < classes; ++k) {
                std::array<std::size_t, capacity> chosen;
                std::size_t count = 0;
                for (std::size_t i = 0; i < met.size(); ++i) {
                    if (class_of(aperture * half_angle(met[i].cone)) == k) chosen[count++] = i;
                    if (count == capacity || (count > 0 && i + 1 == met.size())) {
                        counts += march(from, body, k, {chosen.data(), count}, met, batch);
                        count = 0;
                    }
                }
            }
        return counts;
    }

  private:
    /// A body's ball as a cache sees it.
    struct View {
        vec3 towards;        // unit
        float cosine, sine;  // of the angle that the ball fills about its centre
        float nearest;       // how far away the ball begins, scene units
        bool inside;         // the cache lies in the ball
    };
    View view_of(const Ball& ball, const vec3& from) const {
        const vec3 to = ball.centre - from;
        const float distance = glm::length(to), sine = ball.radius / distance;
        if (!(sine < 1.0f)) return {vec3(0), -1.0f, 0.0f, 0.0f, true};
        return {to / distance, std::sqrt(1.0f - sine * sine), sine, distance - ball.radius, false};
    }
    static float half_angle(const LinkCone& cone) {
        return std::acos(std::clamp(1.0f - cone.solid_angle / (2.0f * pi), -1.0f, 1.0f));
    }
    bool passes(const LinkCone& cone, const vec3& from, std::span<const View> views) const {
        const float cosine = std::max(1.0f - cone.solid_angle / (2.0f * pi), -1.0f), sine = std::sqrt(1.0f - cosine * cosine);
        return std::ranges::any_of(views, [&](const View& body) {
            if (body.inside) return true;
            if (glm::dot(body.towards, cone.direction) < cosine * body.cosine - sine * body.sine) return false;
            return glm::length(centre_[cone.node] - from) > body.nearest;
        });
    }
    Counts march(const vec3& from, int body, int k, std::span<const std::size_t> chosen, std::vector<Met>& met,
                 ConeBatch& batch) const {
        const Pyramid& pyramid = bodies_.pyramid(body);
        const Domain& domain = pyramid.domain;
        const vec3 start = domain.to_linear(pyramid.pose.to_body(from));
        batch.count = static_cast<int>(chosen.size());
        batch.limited = batch.merged = true;
        for (int i = 0; i < batch.count; ++i) {
            const LinkCone& cone = met[chosen[static_cast<std::size_t>(i)]].cone;
            set_start(batch, i, domain, start, vec3(0, 0, 1), 0.0f, true);
            set_direction(batch, i, pyramid.pose.direction_to_body(cone.direction));
            batch.limit[i] = glm::length(centre_[cone.node] - from) / domain.voxel_size;
        }
        const ConeCounts done = march_cones(pyramid, bodies_.air(body),
                                            schedules_[static_cast<std::size_t>(body) * classes + static_cast<std::size_t>(k)],
                                            static_cast<float>(technique_.cut_off), batch);
        for (int i = 0; i < batch.count; ++i)
            met[chosen[static_cast<std::size_t>(i)]].seen.add(vec3(batch.r[i], batch.g[i], batch.b[i]) * pyramid.scale,
                                                              batch.open[i],
                                                              std::min(batch.depth[i] * domain.voxel_size, nothing_there));
        Counts counts;
        counts.cones = chosen.size(), counts.cone_steps = done.steps, counts.voxel_fetches = done.fetches;
        return counts;
    }

    const BodyCones& technique_;
    Hierarchies bodies_;
    std::vector<vec3> centre_;
    std::vector<Ball> ball_;
    std::vector<ConeSchedule> schedules_;  // of every body, of every class
};

/// A cache's coefficients as red, green and blue.
void load_cache(const LightCaches& caches, std::size_t cache, float* colours) {
    const std::uint16_t* c = caches.coefficients.data() + cache * static_cast<std::size_t>(caches.stride());
    const int luma = caches.luma(), chrominance = caches.chrominance();
    for (int k = 0; k < luma; ++k) {
        const auto value = [&](int first) { return from_half(c[first + k]) * caches.unit[cache]; };
        const float y = value(0), second = k < chrominance ? value(luma) : 0.0f,
                    third = k < chrominance ? value(luma + chrominance) : 0.0f;
        const float t = y - third;  // (Y, Co, Cg) to (R, G, B)
        colours[k] = caches.ycocg ? t + second : y;
        colours[64 + k] = caches.ycocg ? y + third : second;
        colours[128 + k] = caches.ycocg ? t - second : third;
    }
}

}  // namespace

Counts shadow_links(const BodyCones& technique, LightCaches& caches, const CacheLinks& links, const NodeLight& light,
                    const CacheSites& sites, const ClusteredSurfels& surfels, Pyramids pyramids, const Scene& scene,
                    const Intersector& intersector, bool reflect) {
    check_links(links, light);
    if (links.caches != sites.size() || caches.caches != sites.size() || surfels.tree.nodes() != light.size())
        throw std::invalid_argument("shadow_links: links, caches and surfels do not belong together");
    if (links.kind == CacheLinks::Kind::projected && links.bands < 2)
        throw std::invalid_argument("shadow_links: links of one band do not tell their direction");
    const BodyShadows shadows(technique, pyramids, surfels, sites);
    std::vector<Counts> counts((sites.size() + caches_a_block - 1) / caches_a_block);
    parallel_blocks(sites.size(), caches_a_block, [&](std::size_t begin, std::size_t end) {
        std::vector<Met> met;
        alignas(64) float colours[3 * 64];
        for (std::size_t cache = begin; cache < end; ++cache) {
            const vec3 normal = sites.normal[cache], from = sites.position[cache] + normal * sites.offset[cache];
            if (normal == vec3(0) && shadows.in_box(from) &&
                look_about(from, normal, scene, intersector).share_of_backs() > most_backs)
                continue;
            shadows.find(links, cache, from, surfels.tree, met);
            if (met.empty()) continue;
            counts[begin / caches_a_block] += shadows.march(from, met);
            load_cache(caches, cache, colours);
            for (const Met& one : met) {
                const float open = one.seen.open();
                if (open >= 1.0f) continue;
                const float per_radiance = pi * (links.radiosity ? 1.0f : surfels.tree.area[one.cone.node]);
                const vec3 instead = reflect ? one.seen.radiance() * per_radiance : vec3(0);
                add_link(links, one.link, one.cone, instead - (1.0f - open) * light.at(one.cone.node), caches.bands, colours);
            }
            store_cache(caches, cache, colours, colours + 64, colours + 128);
        }
    });
    Counts sum;
    for (const Counts& one : counts) sum += one;
    return sum;
}

}  // namespace interreflect
