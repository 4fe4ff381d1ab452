#include "virtual_lights/light_pixels.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "shading/brdf.h"
#include "shading/pixel_lobe.h"

namespace interreflect {
namespace {

/// The lights of a phase follow each other: any run of Halton's points is spread over all of the map, while of every 16th one
/// (the paper's light modulo phases) base 2 leaves a strip of a sixteenth of its width.
struct LightRun {
    std::size_t begin, end;
};
LightRun lights_of_phase(std::size_t lights, std::size_t phase, std::size_t phases) {
    return {lights * phase / phases, lights * (phase + 1) / phases};
}

/// What one phase's pixels of a tile get from its lights.
class PhaseLight {
  public:
    PhaseLight(const LightPixels& how, const VirtualLights& lights, const LightShadows& shadows, const GBuffer& gbuffer,
               const Scene& scene, const Intersector& intersector, float extent)
        : how_(how),
          lights_(lights),
          shadows_(shadows),
          gbuffer_(gbuffer),
          scene_(scene),
          intersector_(intersector),
          extent_(extent),
          disk_(is_disk(how.shade)) {}

    void begin() {
        receivers_.clear();
        for (auto& channel : irradiance_) std::fill(channel.value, channel.value + Receivers::capacity, 0.0f);
        std::fill(radiance_, radiance_ + Receivers::capacity, vec3(0));
        glossy_ = 0;
    }
    void add(std::size_t pixel) {
        const auto i = receivers_.count;
        receivers_.add(gbuffer_, pixel);
        if (max_component(gbuffer_.specular[pixel]) > 0.0f) glossy_receivers_[glossy_++] = i;
    }
    bool empty() const { return receivers_.count == 0; }
    void gather(std::size_t phase, std::size_t phases) {
        receivers_.fill_up();
        for (int k = 0; k < glossy_; ++k) surfaces_[k] = glossy_surface(gbuffer_, scene_, receivers_.pixel[glossy_receivers_[k]]);
        const LightRun run = lights_of_phase(lights_.size(), phase, phases);
        for (std::size_t i = run.begin; i < run.end; ++i)
            if (max_component(lights_.flux[i]) > 0.0f) one(i);
    }
    void write(Buffer<vec4>& irradiance, Buffer<vec4>& radiance) const {
        for (int i = 0; i < receivers_.count; ++i) {
            irradiance[receivers_.pixel[i]] = {irradiance_[0][i], irradiance_[1][i], irradiance_[2][i], 0.0f};
            if (!radiance.empty()) radiance[receivers_.pixel[i]] = vec4(radiance_[i], 0.0f);
        }
    }
    const Counts& counts() const { return counts_; }

  private:
    void one(std::size_t index) {
        const DiskLight disk(lights_, index);
        std::visit([&](const auto& shade) { interreflect::irradiance(shade, disk, receivers_, extent_, unit_); }, how_.shade);
        int reached = 0;
        for (int i = 0; i < receivers_.padded(); ++i) {
            reached += unit_[i] > 0.0f ? 1 : 0;
            visible_[i] = 1.0f;
        }
        if (reached == 0) return;
        counts_.light_evaluations += static_cast<std::uint64_t>(reached);
        if (shadows_.kind != LightShadows::Kind::unshadowed) {
            const ShadowedLight light{disk, shadows_, intersector_};
            std::visit([&](const auto& filter) { visibility(filter, light, receivers_, unit_, how_.seed, visible_, counts_); },
                       how_.filter);
        }
        const vec3 flux = lights_.flux[index];
        for (int i = 0; i < receivers_.padded(); ++i) {
            unit_[i] *= visible_[i];
            for (int k = 0; k < 3; ++k) irradiance_[k][i] += unit_[i] * flux[k];
        }
        for (int k = 0; k < glossy_; ++k) reflect(k, disk, flux);
    }
    void reflect(int k, const DiskLight& disk, const vec3& flux) {
        const int i = glossy_receivers_[k];
        if (!(unit_[i] > 0.0f)) return;
        const vec3 position = receivers_.position_at(i);
        const vec3 to_viewer = glm::normalize(gbuffer_.camera.position - position);
        const vec3 to_light = glm::normalize(disk.position - position);
        const float solid_angle =
            disk_ ? unit_[i] / visible_[i] * disk.area * pi / glm::dot(to_light, receivers_.normal_at(i)) : 0.0f;
        radiance_[i] += mean_brdf(surfaces_[k], to_viewer, to_light, glm::min(solid_angle, 2.0f * pi)) * (flux * unit_[i]);
    }

    const LightPixels& how_;
    const VirtualLights& lights_;
    const LightShadows& shadows_;
    const GBuffer& gbuffer_;
    const Scene& scene_;
    const Intersector& intersector_;
    float extent_;
    bool disk_;
    Receivers receivers_;
    PerReceiver unit_, visible_, irradiance_[3];
    vec3 radiance_[Receivers::capacity];
    int glossy_receivers_[Receivers::capacity];
    SurfacePoint surfaces_[Receivers::capacity];
    int glossy_ = 0;
    Counts counts_;
};

/// The share of all flux that each phase's lights have; equal shares where there is none.
std::vector<float> shares_of(const VirtualLights& lights, int phases) {
    std::vector<double> flux(static_cast<std::size_t>(phases), 0.0);
    double sum = 0;
    for (std::size_t phase = 0; phase < flux.size(); ++phase) {
        const LightRun run = lights_of_phase(lights.size(), phase, flux.size());
        for (std::size_t i = run.begin; i < run.end; ++i) flux[phase] += luminance(lights.flux[i]);
        sum += flux[phase];
    }
    std::vector<float> shares(flux.size());
    for (std::size_t i = 0; i < flux.size(); ++i)
        shares[i] = static_cast<float>(sum > 0 ? flux[i] / sum : 1.0 / static_cast<double>(phases));
    return shares;
}

/// The first number from `begin` on that leaves `rest` when divided by `period`.
int first_of(int begin, int rest, int period) { return begin + ((rest - begin) % period + period) % period; }

bool any_glossy(const Scene& scene) {
    return std::ranges::any_of(scene.materials, [](const Material& material) { return material.glossy(); });
}

}  // namespace

VirtualLight light_pixels(const LightPixels& how, const VirtualLights& lights, const LightShadows& shadows,
                          const GBuffer& gbuffer, const Scene& scene, const Intersector& intersector) {
    const std::size_t texels = lights.size() * static_cast<std::size_t>(shadows.size) * static_cast<std::size_t>(shadows.size);
    if (shadows.kind == LightShadows::Kind::maps && shadows.depth.size() != texels)
        throw std::invalid_argument("shade_lights: the shadows are those of another number of lights");
    const std::size_t pixels = gbuffer.pixels();
    const bool glossy = any_glossy(scene);
    VirtualLight result;
    result.gathered.width = result.glossy.width = gbuffer.width;
    result.gathered.height = result.glossy.height = gbuffer.height;
    result.gathered.irradiance = Buffer<vec3>(pixels);
    result.glossy.radiance = Buffer<vec3>(pixels);
    Buffer<vec4> irradiance(pixels), radiance(glossy ? pixels : 0);
    const Bounds bounds = scene.geometry->bounds();
    const float extent = glm::length(bounds.upper - bounds.lower);
    const Block block = block_of(how.share);
    const int side = 16 * std::min(block.width, block.height);
    std::vector<Counts> counts(tile_count(gbuffer.width, gbuffer.height, side));
    parallel_tiles(gbuffer.width, gbuffer.height, side, [&](const Tile& tile) {
        const auto phase_light = std::make_unique<PhaseLight>(how, lights, shadows, gbuffer, scene, intersector, extent);
        for (int phase = 0; phase < block.phases(); ++phase) {
            phase_light->begin();
            const int x0 = first_of(tile.x0, phase % block.width, block.width);
            const int y0 = first_of(tile.y0, phase / block.width, block.height);
            const auto visit = [&](int x, int y) {
                if (x >= tile.x1 || y >= tile.y1) return;
                const std::size_t pixel = static_cast<std::size_t>(y) * gbuffer.width + x;
                irradiance[pixel] = vec4(0);
                if (glossy) radiance[pixel] = vec4(0);
                if (gbuffer.hit(pixel)) phase_light->add(pixel);
            };
            // Squares of 4 x 4: a vector of neighbours looks into the same lines of a map, and fewer vectors are lit in part.
            constexpr int square = 4;
            for (int y = y0; y < tile.y1; y += square * block.height)
                for (int x = x0; x < tile.x1; x += square * block.width)
                    for (int i = 0; i < square * square; ++i) visit(x + i % square * block.width, y + i / square * block.height);
            if (phase_light->empty()) continue;
            phase_light->gather(static_cast<std::size_t>(phase), static_cast<std::size_t>(block.phases()));
            phase_light->write(irradiance, radiance);
        }
        counts[tile.index] = phase_light->counts();
    });
    for (const Counts& one : counts) result.counts += one;
    const auto shares = shares_of(lights, block.phases());
    const auto take = [](Buffer<vec3>& to) {
        return [&to](std::size_t first, std::span<const vec4> values) {
            for (std::size_t i = 0; i < values.size(); ++i) to[first + i] = vec3(values[i]);
        };
    };
    merge(how.share, gbuffer, shares, irradiance, take(result.gathered.irradiance));
    if (glossy)
        merge(how.share, gbuffer, shares, radiance, take(result.glossy.radiance));
    else
        std::ranges::fill(result.glossy.radiance, vec3(0));
    return result;
}

}  // namespace interreflect
