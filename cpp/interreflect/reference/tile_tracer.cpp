#include "reference/tile_tracer.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "visibility/trace_gbuffer.h"

namespace interreflect {
namespace {

constexpr int first_roulette = 1;  // vertex
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t none = ~0U;

float power_heuristic(float a, float b) { return a > 0.0f ? 1.0f / (1.0f + (b / a) * (b / a)) : 0.0f; }

/// The bits of x and y in turn.
std::uint32_t morton(std::uint32_t x, std::uint32_t y) {
    std::uint32_t code = 0;
    for (std::uint32_t bit = 0; bit < 16; ++bit) code |= ((x >> bit & 1U) << (2 * bit)) | ((y >> bit & 1U) << (2 * bit + 1));
    return code;
}

/// Rays [first, first + 16) of columns; returns the lanes that there are.
template <class Rays>
std::uint32_t fill_packet(const Rays& rays, std::uint32_t first, RayPacket& packet) {
    constexpr std::size_t bytes = sizeof(RayPacket::Lanes);
    std::memcpy(packet.origin_x, rays.origin.x + first, bytes);
    std::memcpy(packet.origin_y, rays.origin.y + first, bytes);
    std::memcpy(packet.origin_z, rays.origin.z + first, bytes);
    std::memcpy(packet.direction_x, rays.direction.x + first, bytes);
    std::memcpy(packet.direction_y, rays.direction.y + first, bytes);
    std::memcpy(packet.direction_z, rays.direction.z + first, bytes);
    std::fill_n(packet.near, RayPacket::width, 0.0f);
    const std::uint32_t left = rays.count - first;
    return left >= RayPacket::width ? 0xffffU : (1U << left) - 1U;
}

}  // namespace

TileTracer::TileTracer(const Integrand& integrand)
    : in_(integrand), at_(std::make_unique<Workspace>()), paths_(&at_->vertices[0]), next_(&at_->vertices[1]) {
    make_patterns(static_cast<std::uint32_t>(in_.pattern));
    for (std::uint32_t i = 0; i < tracing_tile_pixels; ++i) whole_by_block_.push_back(i);
    whole_by_pattern_ = whole_by_block_;
    const auto place = [](std::uint32_t i) { return morton(i % tracing_tile, i / tracing_tile); };
    const auto by_place = [&](auto i, auto j) { return place(i) < place(j); };
    std::sort(whole_by_block_.begin(), whole_by_block_.end(), by_place);
    std::sort(whole_by_pattern_.begin(), whole_by_pattern_.end(), by_place);
    std::stable_sort(whole_by_pattern_.begin(), whole_by_pattern_.end(),
                     [&](auto i, auto j) { return pattern_of_pixel_[i] < pattern_of_pixel_[j]; });
}

/// Pixels share their pattern with those at equal places of an n x n grid, within blocks of 4 n pixels: one packet of rays.
void TileTracer::make_patterns(std::uint32_t n) {
    std::vector<std::uint32_t> keys;
    for (std::uint32_t i = 0; i < tracing_tile_pixels; ++i) {
        const std::uint32_t x = i % tracing_tile, y = i / tracing_tile;
        keys.push_back(morton(x / (4 * n), y / (4 * n)) << 16 | morton(x % n, y % n));
    }
    std::vector<std::uint32_t> all = keys;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    patterns_ = static_cast<std::uint32_t>(all.size());
    for (const auto key : keys)
        pattern_of_pixel_.push_back(static_cast<std::uint32_t>(std::lower_bound(all.begin(), all.end(), key) - all.begin()));
}

/// The pixels of a whole tile in their orders, without what lies beyond the picture's border.
void TileTracer::make_orders(const Tile& tile) {
    const auto inside = [&](std::uint32_t i) {
        return tile.x0 + static_cast<int>(i % tracing_tile) < tile.x1 && tile.y0 + static_cast<int>(i / tracing_tile) < tile.y1;
    };
    by_pattern_.clear();
    std::copy_if(whole_by_pattern_.begin(), whole_by_pattern_.end(), std::back_inserter(by_pattern_), inside);
    StepLanes& primary = at_->primary;
    primary.count = 0;
    for (const auto pixel : whole_by_block_) {
        if (!inside(pixel)) continue;
        const std::uint32_t i = primary.count++;
        primary.pixel[i] = pixel;
        primary.pattern[i] = pattern_of_pixel_[pixel];
        primary.origin.set(i, in_.camera.origin);
        primary.throughput.set(i, vec3(1));
    }
}

void TileTracer::load_pairs(int vertex, int sample) {
    for (const Pair which : {emitter_point, environment_point, reflection, choices, roulette}) {
        if (which == roulette && !roulette_at(vertex)) continue;
        if (which == emitter_point && !in_.lights.has_emitters()) continue;
        if (which == environment_point && !in_.lights.has_environment()) continue;
        const std::uint32_t dimension = 1 + static_cast<std::uint32_t>(vertex) * pairs_a_vertex + which;
        sequence_->pairs(dimension, static_cast<std::uint32_t>(sample), patterns_, at_->pairs[which].x, at_->pairs[which].y);
    }
}

/// Places in the pixel.
void TileTracer::load_places(int sample) {
    PairTable& places = at_->places;
    if (!repeats()) return sequence_->pairs(0, static_cast<std::uint32_t>(sample), patterns_, places.x, places.y);
    std::fill_n(places.x, patterns_, 0.5f);
    std::fill_n(places.y, patterns_, 0.5f);
}

void TileTracer::trace(const Tile& tile, int first, int end) {
    const SampleSequence sequence(in_.seed, static_cast<std::uint32_t>(tile.index));
    sequence_ = &sequence;
    counts_ = Counts{};
    for (auto* image : {&direct_, &indirect_, &certain_}) image->assign(tracing_tile_pixels, vec3(0));
    make_orders(tile);
    if (repeats()) {
        load_places(first);
        trace_primary(tile, certain_);
        if (first == 0)
            add_delta_lights(at_->first, certain_);
        else
            certain_.assign(tracing_tile_pixels, vec3(0));
    }
    for (int sample = first; sample < end; ++sample) {
        if (!repeats()) {
            load_places(sample);
            trace_primary(tile, direct_);
            add_delta_lights(at_->first, direct_);
        }
        trace_sample(sample);
    }
    counts_.paths += by_pattern_.size() * static_cast<std::size_t>(end - first);
}

/// Traces rays and puts the surfaces that they met, and that reflect, into `paths` unless it is null. `alone`: every hit is
/// shaded by itself. meeting.surface(step, hit): that surface, its emission accounted for; meeting.missed(step).
template <class Meeting>
void TileTracer::trace_steps(const StepLanes& steps, bool alone, const Meeting& meeting, PathLanes* paths) {
    counts_.rays += steps.count;
    for (std::uint32_t begin = 0; begin < steps.count; begin += together * RayPacket::width) {
        const int packets = static_cast<int>(std::min<std::uint32_t>(together, (steps.count - begin + 15) / RayPacket::width));
        std::uint32_t active[together], plain[together];
        for (int k = 0; k < packets; ++k) {
            active[k] = fill_packet(steps, begin + k * RayPacket::width, at_->rays[k]);
            std::fill_n(at_->rays[k].far, RayPacket::width, infinity);
            in_.rays.nearest(at_->rays[k], active[k]);
            prefetch_hits(in_.surfaces, at_->rays[k]);
        }
        for (int k = 0; k < packets; ++k) plain[k] = alone ? 0 : plain_surfaces(in_.surfaces, at_->rays[k], active[k]);
        if (paths != nullptr)
            for (int k = 0; k < packets; ++k)
                if (plain[k] != 0) place_surfaces(in_.surfaces, at_->rays[k], plain[k], at_->surfaces[k]);
        for (int k = 0; k < packets; ++k) {
            const RayPacket& rays = at_->rays[k];
            SurfacePacket& surfaces = at_->surfaces[k];
            const std::uint32_t first = begin + k * RayPacket::width;
            std::uint32_t met = plain[k];
            if (paths != nullptr && plain[k] != 0) texture_surfaces(in_.surfaces, plain[k], surfaces);
            for (std::uint32_t left = active[k] & ~plain[k]; left != 0; left &= left - 1) {
                const int lane = __builtin_ctz(left);
                if (!rays.met(lane)) {
                    meeting.missed(first + lane);
                    continue;
                }
                met |= 1U << lane;
                surfaces.set(lane, meeting.surface(first + lane, rays.hit(lane)));
            }
            if (paths != nullptr) append_paths(surfaces, met, steps, first, *paths);
        }
    }
}

void TileTracer::trace_primary(const Tile& tile, std::vector<vec3>& to) {
    choose_primary_rays(in_.camera, tile.x0, tile.y0, at_->places, at_->primary);
    struct Meeting {
        const TileTracer& tracer;
        const Tile& tile;
        std::vector<vec3>& to;
        void missed(std::uint32_t i) const {
            const StepLanes& rays = tracer.at_->primary;
            if (tracer.in_.lights.has_environment()) to[rays.pixel[i]] += tracer.in_.lights.environment(rays.direction.at(i));
        }
        SurfacePoint surface(std::uint32_t i, const Hit& hit) const {
            const Integrand& in = tracer.in_;
            const StepLanes& rays = tracer.at_->primary;
            const std::uint32_t pixel = rays.pixel[i];
            const vec2 corner(static_cast<float>(tile.x0 + static_cast<int>(pixel % tracing_tile)),
                              static_cast<float>(tile.y0 + static_cast<int>(pixel / tracing_tile)));
            const Footprint footprint =
                tracer.repeats() ? pixel_footprint(in.scene, hit, in.camera, corner.x + 0.5f, corner.y + 0.5f) : Footprint{};
            const SurfacePoint point = surface_at(in.scene, hit, rays.direction.at(i), footprint);
            to[pixel] += point.emission;
            return point;
        }
    };
    at_->first.clear();
    trace_steps(at_->primary, repeats(), Meeting{*this, tile, to}, &at_->first);
}

void TileTracer::trace_sample(int sample) {
    std::array<std::uint32_t, tracing_tile_pixels> path_of_pixel;
    path_of_pixel.fill(none);
    for (std::uint32_t i = 0; i < at_->first.count; ++i) path_of_pixel[at_->first.pixel[i]] = i;
    std::uint32_t count = 0;
    for (const auto pixel : by_pattern_)
        if (path_of_pixel[pixel] != none) at_->order[count++] = path_of_pixel[pixel];
    reorder_paths(at_->first, at_->order, count, *paths_);
    for (int vertex = 0; paths_->count != 0; ++vertex) {
        load_pairs(vertex, sample);
        if (vertex > 0) add_delta_lights(*paths_, image(vertex));
        if (in_.lights.has_emitters()) add_emitters(vertex);
        if (in_.lights.has_environment()) add_environment(vertex);
        take_steps(vertex);
    }
}

/// Whether the reflection's own ray is traced from diffuse vertices too: the last one finds its light by light samples alone.
bool TileTracer::continue_all(int vertex) const { return vertex < in_.last_vertex || in_.lights.emitters_are_many(); }

bool TileTracer::roulette_at(int vertex) const { return in_.last_vertex == Integrand::every_vertex && vertex >= first_roulette; }

Connecting TileTracer::connecting(const PathLanes& paths, int vertex, bool weighed) {
    return {paths, in_.scene.materials, weighed, continue_all(vertex), at_->shadows};
}

void TileTracer::trace_shadows(std::vector<vec3>& to) {
    ShadowLanes& shadows = at_->shadows;
    counts_.shadow_rays += shadows.count;
    RayPacket& packet = at_->rays[0];
    for (std::uint32_t first = 0; first < shadows.count; first += RayPacket::width) {
        const std::uint32_t active = fill_packet(shadows, first, packet);
        std::memcpy(packet.far, shadows.far + first, sizeof(packet.far));
        for (std::uint32_t open = active & ~in_.rays.occluded(packet, active); open != 0; open &= open - 1) {
            const std::uint32_t i = first + static_cast<std::uint32_t>(__builtin_ctz(open));
            to[shadows.pixel[i]] += shadows.light.at(i);
        }
    }
    shadows.count = 0;
}

void TileTracer::add_delta_lights(const PathLanes& paths, std::vector<vec3>& to) {
    const Connecting c = connecting(paths, 0, false);
    for (int number = 0; number < in_.lights.delta_count(); ++number) {
        if (in_.lights.delta_is_directional(number)) {
            const auto light = in_.lights.delta(number, vec3(0));
            connect_directional(c, light.direction, light.irradiance);
        } else {
            for (std::uint32_t i = 0; i < paths.count; ++i) {
                const auto light = in_.lights.delta(number, paths.position.at(i));
                at_->lights.direction.set(i, light.direction);
                at_->lights.radiance.set(i, light.irradiance);
                at_->lights.distance[i] = light.distance, at_->lights.pdf[i] = 1.0f;
            }
            connect_given(c, at_->lights);
        }
        trace_shadows(to);
    }
}

void TileTracer::add_emitters(int vertex) {
    const PathLanes& paths = *paths_;
    const Connecting c = connecting(paths, vertex, true);
    if (const auto shapes = in_.lights.emitter_shapes(); !shapes.empty()) {
        connect_shapes(c, shapes, at_->pairs[choices], at_->pairs[emitter_point]);
    } else {
        const PairTable &which = at_->pairs[choices], &points = at_->pairs[emitter_point];
        for (std::uint32_t i = 0; i < paths.count; ++i) {
            const std::uint32_t k = paths.pattern[i];
            at_->lights.set(i, in_.lights.sample_emitter(paths.position.at(i), which.x[k], {points.x[k], points.y[k]}));
        }
        connect_given(c, at_->lights);
    }
    trace_shadows(image(vertex));
}

void TileTracer::add_environment(int vertex) {
    const PathLanes& paths = *paths_;
    const Connecting c = connecting(paths, vertex, true);
    const PairTable& points = at_->pairs[environment_point];
    if (in_.lights.environment_is_constant()) {
        connect_constant_sky(c, in_.lights.environment(vec3(0, 1, 0)), points);
    } else {
        for (std::uint32_t i = 0; i < paths.count; ++i) {
            const std::uint32_t k = paths.pattern[i];
            at_->lights.set(i, in_.lights.sample_environment({points.x[k], points.y[k]}));
        }
        connect_given(c, at_->lights);
    }
    trace_shadows(image(vertex));
}

float TileTracer::environment_pdf(const vec3& normal, const vec3& direction) const {
    if (!in_.lights.environment_is_constant()) return in_.lights.environment_pdf(direction);
    return glm::max(0.0f, glm::dot(normal, direction)) / pi;
}

/// Light that a step's ray met, weighed against the light samples of the vertex it left.
vec3 TileTracer::emission_met(std::uint32_t step, const Hit& hit, const SurfacePoint* seen) const {
    const StepLanes& steps = at_->steps;
    const std::uint32_t left = steps.path[step];
    const vec3 direction = steps.direction.at(step), throughput = steps.throughput.at(step);
    if (seen == nullptr) {
        const float other = environment_pdf(paths_->normal.at(left), direction);
        return throughput * in_.lights.environment(direction) * power_heuristic(steps.pdf[step], other);
    }
    const float other = in_.lights.emitter_pdf(hit, paths_->position.at(left), direction);
    return throughput * seen->emission * power_heuristic(steps.pdf[step], other);
}

/// Paths go on to their next vertex.
void TileTracer::take_steps(int vertex) {
    at_->steps.count = 0;
    choose_rays({*paths_, in_.scene.materials, continue_all(vertex), roulette_at(vertex), at_->pairs[reflection],
                 at_->pairs[choices], at_->pairs[roulette]},
                at_->steps);
    struct Meeting {
        const TileTracer& tracer;
        std::vector<vec3>& to;
        void missed(std::uint32_t i) const {
            if (tracer.in_.lights.has_environment()) to[tracer.at_->steps.pixel[i]] += tracer.emission_met(i, Hit{}, nullptr);
        }
        SurfacePoint surface(std::uint32_t i, const Hit& hit) const {
            const SurfacePoint seen = surface_at(tracer.in_.scene, hit, tracer.at_->steps.direction.at(i));
            if (max_component(seen.emission) > 0.0f) to[tracer.at_->steps.pixel[i]] += tracer.emission_met(i, hit, &seen);
            return seen;
        }
    };
    next_->clear();
    trace_steps(at_->steps, false, Meeting{*this, image(vertex)}, vertex < in_.last_vertex ? next_ : nullptr);
    std::swap(paths_, next_);
}

}  // namespace interreflect
