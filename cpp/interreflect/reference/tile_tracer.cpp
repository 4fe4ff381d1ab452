#include "reference/tile_tracer.h"

#include <algorithm>
#include <limits>

#include "math/sampling.h"
#include "shading/brdf.h"
#include "visibility/surface_prefetch.h"
#include "visibility/trace_gbuffer.h"

namespace interreflect {
namespace {

constexpr float most_survival = 0.95f;  // roulette ends even a path that loses nothing
constexpr int first_roulette = 2;       // vertex
constexpr float infinity = std::numeric_limits<float>::infinity();

float power_heuristic(float a, float b) { return a > 0.0f ? 1.0f / (1.0f + (b / a) * (b / a)) : 0.0f; }
bool glossy(const SurfacePoint& at) { return max_component(at.specular) > 0.0f; }
bool reflects(const SurfacePoint& at) { return max_component(at.albedo) > 0.0f || glossy(at); }

/// The bits of x and y in turn.
std::uint32_t morton(std::uint32_t x, std::uint32_t y) {
    std::uint32_t code = 0;
    for (std::uint32_t bit = 0; bit < 16; ++bit) code |= ((x >> bit & 1U) << (2 * bit)) | ((y >> bit & 1U) << (2 * bit + 1));
    return code;
}

}  // namespace

void ShadowBatch::add(const SurfacePoint& at, const vec3& direction, float distance, const vec3& radiance, std::uint32_t to) {
    // The ray ends short of an emitter by more than rounding moves either end.
    rays.push_back({at.position + at.geometric_normal * at.offset, 0.0f, direction, distance * 0.9999f - 2.0f * at.offset});
    light.push_back(radiance);
    pixel.push_back(to);
}

void ShadowBatch::trace(const Intersector& intersector, bool coherent, std::vector<vec3>& image, Counts& counts) {
    blocked.resize(rays.size());
    coherent ? intersector.occluded_coherent(rays, blocked) : intersector.occluded_incoherent(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (blocked[i] == 0) image[pixel[i]] += light[i];
    counts.shadow_rays += rays.size();
    rays.clear(), light.clear(), pixel.clear();
}

TileTracer::TileTracer(const Integrand& integrand) : in_(integrand) {
    pattern_of_pixel_.resize(tracing_tile_pixels);
    const auto n = static_cast<std::uint32_t>(in_.pattern);
    for (std::uint32_t i = 0; i < tracing_tile_pixels; ++i)
        pattern_of_pixel_[i] = morton(i % tracing_tile % n, i / tracing_tile % n);
    for (std::uint32_t i = 0; i < tracing_tile_pixels; ++i) whole_by_block_.push_back(i);
    whole_by_pattern_ = whole_by_block_;
    const auto block = [](std::uint32_t i) { return morton(i % tracing_tile, i / tracing_tile); };
    const auto place = [&](std::uint32_t i) {
        return static_cast<std::uint64_t>(pattern_of_pixel_[i]) << 32 | morton(i % tracing_tile / n, i / tracing_tile / n);
    };
    std::sort(whole_by_block_.begin(), whole_by_block_.end(), [&](auto i, auto j) { return block(i) < block(j); });
    std::sort(whole_by_pattern_.begin(), whole_by_pattern_.end(), [&](auto i, auto j) { return place(i) < place(j); });
    const std::uint32_t patterns = *std::max_element(pattern_of_pixel_.begin(), pattern_of_pixel_.end()) + 1;
    for (auto& table : of_pattern_) table.resize(patterns);
    place_of_pattern_.resize(patterns);
    first_.resize(tracing_tile_pixels), first_direction_.resize(tracing_tile_pixels), first_emission_.resize(tracing_tile_pixels);
    first_hit_.resize(tracing_tile_pixels);
    for (auto& surfaces : surfaces_) surfaces.resize(tracing_tile_pixels);
}

/// The orders of a whole tile, without what lies beyond the picture's border.
void TileTracer::make_orders(const Tile& tile) {
    const auto inside = [&](std::uint32_t i) {
        return tile.x0 + static_cast<int>(i % tracing_tile) < tile.x1 && tile.y0 + static_cast<int>(i / tracing_tile) < tile.y1;
    };
    by_block_.clear(), by_pattern_.clear();
    std::copy_if(whole_by_block_.begin(), whole_by_block_.end(), std::back_inserter(by_block_), inside);
    std::copy_if(whole_by_pattern_.begin(), whole_by_pattern_.end(), std::back_inserter(by_pattern_), inside);
}

void TileTracer::load_pair(Pair which, int vertex, int sample) {
    const std::uint32_t dimension = 1 + static_cast<std::uint32_t>(vertex) * pairs_a_vertex + which;
    of_sample_[which] = sequence_->of_sample(dimension, static_cast<std::uint32_t>(sample));
    for (std::uint32_t k = 0; k < of_pattern_[which].size(); ++k) of_pattern_[which][k] = sequence_->of_pattern(dimension, k);
}

void TileTracer::trace(const Tile& tile, int first, int end) {
    const SampleSequence sequence(in_.seed, static_cast<std::uint32_t>(tile.index));
    sequence_ = &sequence;
    counts_ = Counts{};
    for (auto* image : {&direct_, &indirect_, &certain_}) image->assign(tracing_tile_pixels, vec3(0));
    make_orders(tile);
    if (!repeats())
        for (std::uint32_t k = 0; k < place_of_pattern_.size(); ++k) place_of_pattern_[k] = sequence.of_pattern(0, k);
    if (repeats()) {
        trace_primary(tile, sequence, first);
        if (first == 0) add_first_lights(certain_);
    }
    for (int sample = first; sample < end; ++sample) {
        if (!repeats()) {
            trace_primary(tile, sequence, sample);
            add_first_lights(direct_);
        }
        trace_sample(sample);
    }
    counts_.paths += by_block_.size() * static_cast<std::size_t>(end - first);
}

/// Emission of the first hits and what delta lights do there.
void TileTracer::add_first_lights(std::vector<vec3>& to) {
    for (const auto pixel : by_block_) to[pixel] += first_emission_[pixel];
    for (int light = 0; light < in_.lights.delta_count(); ++light) {
        for (const auto pixel : by_block_)
            if (first_hit_[pixel] != 0) add_delta(light, first_[pixel], first_direction_[pixel], vec3(1), pixel);
        shadows_.trace(in_.rays, true, to, counts_);
    }
}

void TileTracer::trace_primary(const Tile& tile, const SampleSequence& sequence, int sample) {
    const std::size_t count = by_block_.size();
    rays_.resize(count), hits_.resize(count);
    const Bits2 of_sample = sequence.of_sample(0, static_cast<std::uint32_t>(sample));
    const auto place_of = [&](std::uint32_t pixel) {
        vec2 place(0.5f);
        if (in_.pixel == PixelFilter::box) place = SampleSequence::join(of_sample, place_of_pattern_[pattern_of_pixel_[pixel]]);
        return vec2(static_cast<float>(tile.x0 + static_cast<int>(pixel % tracing_tile)) + place.x,
                    static_cast<float>(tile.y0 + static_cast<int>(pixel / tracing_tile)) + place.y);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const vec2 place = place_of(by_block_[i]);
        rays_[i] = {in_.camera.origin, 0.0f, in_.camera.direction(place.x, place.y)};
    }
    in_.rays.nearest_coherent(rays_, hits_);
    counts_.rays += count;
    const SurfacePrefetch prefetch(in_.scene, hits_);
    for (std::size_t i = 0; i < count; ++i) {
        prefetch.at(i);
        const std::uint32_t pixel = by_block_[i];
        const vec3 direction = first_direction_[pixel] = rays_[i].direction;
        first_hit_[pixel] = hits_[i].valid();
        first_emission_[pixel] = vec3(0);
        if (!hits_[i].valid()) {
            if (in_.lights.has_environment()) first_emission_[pixel] = in_.lights.environment(direction);
            continue;
        }
        const vec2 place = place_of(pixel);
        const Footprint footprint =
            in_.pixel == PixelFilter::centre ? pixel_footprint(in_.scene, hits_[i], in_.camera, place.x, place.y) : Footprint{};
        first_[pixel] = surface_at(in_.scene, hits_[i], direction, footprint);
        first_emission_[pixel] = first_[pixel].emission;
    }
}

void TileTracer::trace_sample(int sample) {
    paths_.clear();
    for (const auto pixel : by_pattern_)
        if (first_hit_[pixel] != 0 && reflects(first_[pixel]))
            paths_.push_back({first_direction_[pixel], vec3(1), pixel, pattern_of_pixel_[pixel], &first_[pixel]});
    for (int vertex = 0; !paths_.empty(); ++vertex) {
        for (const Pair which : {emitter_point, environment_point, reflection, choices, roulette})
            load_pair(which, vertex, sample);
        if (vertex > 0) add_delta_lights(vertex);
        if (in_.lights.has_emitters()) add_emitters(vertex);
        if (in_.lights.has_environment()) add_environment(vertex);
        choose_steps(vertex);
        take_steps(vertex);
    }
}

/// Whether the reflection's own ray is traced too. A diffuse vertex that is the last finds its light by light samples alone.
bool TileTracer::continues(const SurfacePoint& at, int vertex) const {
    return vertex < in_.last_vertex || glossy(at) || in_.lights.emitters_are_many();
}

void TileTracer::add_delta(int number, const SurfacePoint& at, const vec3& direction, const vec3& throughput,
                           std::uint32_t pixel) {
    const auto light = in_.lights.delta(number, at.position);
    const float cosine = glm::dot(at.normal, light.direction);
    if (cosine <= 0.0f || max_component(light.irradiance) <= 0.0f) return;
    const vec3 reflected = throughput * evaluate_brdf(at, -direction, light.direction) * light.irradiance * cosine;
    if (max_component(reflected) > 0.0f) shadows_.add(at, light.direction, light.distance, reflected, pixel);
}

void TileTracer::add_delta_lights(int vertex) {
    for (int light = 0; light < in_.lights.delta_count(); ++light) {
        for (const Path& path : paths_) add_delta(light, *path.at, path.direction, path.throughput, path.pixel);
        shadows_.trace(in_.rays, false, image(vertex), counts_);
    }
}

void TileTracer::add_light_sample(const Path& path, const LightDirection& light, bool continues) {
    const SurfacePoint& at = *path.at;
    const float cosine = glm::dot(at.normal, light.direction);
    if (light.pdf <= 0.0f || cosine <= 0.0f) return;
    const BrdfValue f = evaluate_brdf_and_pdf(at, -path.direction, light.direction);
    const float weight = continues ? power_heuristic(light.pdf, f.pdf) : 1.0f;
    const vec3 reflected = path.throughput * f.value * light.radiance * (cosine * weight / light.pdf);
    if (max_component(reflected) > 0.0f) shadows_.add(at, light.direction, light.distance, reflected, path.pixel);
}

void TileTracer::add_emitters(int vertex) {
    for (const Path& path : paths_) {
        const float choose = pair(choices, path).x;
        const LightDirection light = in_.lights.sample_emitter(path.at->position, choose, pair(emitter_point, path));
        add_light_sample(path, light, continues(*path.at, vertex));
    }
    shadows_.trace(in_.rays, false, image(vertex), counts_);
}

LightDirection TileTracer::sample_environment(const SurfacePoint& at, const vec2& u) const {
    if (!in_.lights.environment_is_constant()) return in_.lights.sample_environment(u);
    const vec3 local = cosine_hemisphere(u);
    const vec3 direction = Frame(at.normal).to_world(local);
    return {direction, infinity, in_.lights.environment(direction), local.z / pi};
}

float TileTracer::environment_pdf(const SurfacePoint& at, const vec3& direction) const {
    if (!in_.lights.environment_is_constant()) return in_.lights.environment_pdf(direction);
    return glm::max(0.0f, glm::dot(at.normal, direction)) / pi;
}

void TileTracer::add_environment(int vertex) {
    for (const Path& path : paths_)
        add_light_sample(path, sample_environment(*path.at, pair(environment_point, path)), continues(*path.at, vertex));
    shadows_.trace(in_.rays, false, image(vertex), counts_);
}

/// The next rays, in the order of the paths.
void TileTracer::choose_steps(int vertex) {
    steps_.clear(), rays_.clear();
    for (std::uint32_t i = 0; i < paths_.size(); ++i) {
        const Path& path = paths_[i];
        const SurfacePoint& at = *path.at;
        if (!continues(at, vertex)) continue;
        const BrdfSample next = sample_brdf(at, -path.direction, pair(choices, path).y, pair(reflection, path));
        vec3 throughput = path.throughput * next.weight;
        if (max_component(throughput) <= 0.0f) continue;
        if (in_.last_vertex == Integrand::every_vertex && vertex >= first_roulette) {
            const float survival = glm::min(most_survival, max_component(throughput));
            if (pair(roulette, path).x >= survival) continue;
            throughput /= survival;
        }
        steps_.push_back({throughput, next.pdf, i});
        rays_.push_back({at.position + at.geometric_normal * at.offset, 0.0f, next.wi});
    }
}

/// Light that a step's ray met, weighed against the light samples of the vertex it left.
vec3 TileTracer::emission_met(const Step& step, const Hit& hit, const SurfacePoint* seen) const {
    const SurfacePoint& left = *paths_[step.path].at;
    const vec3 direction = rays_[&step - steps_.data()].direction;
    if (seen == nullptr)
        return step.throughput * in_.lights.environment(direction) * power_heuristic(step.pdf, environment_pdf(left, direction));
    return step.throughput * seen->emission * power_heuristic(step.pdf, in_.lights.emitter_pdf(hit, left.position, direction));
}

void TileTracer::take_steps(int vertex) {
    hits_.resize(rays_.size());
    in_.rays.nearest_coherent(rays_, hits_);
    counts_.rays += rays_.size();
    next_paths_.clear();
    auto& surfaces = surfaces_[vertex & 1];
    const SurfacePrefetch prefetch(in_.scene, hits_);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        prefetch.at(i);
        const Path& path = paths_[steps_[i].path];
        if (!hits_[i].valid()) {
            if (in_.lights.has_environment()) image(vertex)[path.pixel] += emission_met(steps_[i], hits_[i], nullptr);
            continue;
        }
        SurfacePoint& seen = surfaces[next_paths_.size()];
        seen = surface_at(in_.scene, hits_[i], rays_[i].direction);
        if (max_component(seen.emission) > 0.0f) image(vertex)[path.pixel] += emission_met(steps_[i], hits_[i], &seen);
        if (vertex < in_.last_vertex && reflects(seen))
            next_paths_.push_back({rays_[i].direction, steps_[i].throughput, path.pixel, path.pattern, &seen});
    }
    paths_.swap(next_paths_);
}

}  // namespace interreflect
