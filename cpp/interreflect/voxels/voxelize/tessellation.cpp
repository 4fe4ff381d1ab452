#include "voxels/voxelize/tessellation.h"

#include <algorithm>
#include <array>

#include "voxels/voxelize/appearance.h"
#include "voxels/voxelize/inner_vertices.h"
#include "voxels/voxelize/linear_box.h"
#include "voxels/voxelize/small_triangles.h"
#include "voxels/voxelize/tessellation_pattern.h"

namespace interreflect {
namespace {

// A triangle's longest edge over its narrowest altitude: 2 in half a square, which halving its longest edge keeps.
constexpr float most_stretched = 2.5f;

// Of the way to the triangle's centre, where a vertex looks up its texels.
constexpr float inwards = 1e-3f;

/// A triangle, or what splitting left of it.
struct Patch {
    std::array<vec3, 3> corner;
    std::array<vec2, 3> texcoord;
    float area;
};

class Tessellator {
  public:
    Tessellator(const Tessellation& technique, const VoxelTriangle& t, const LinearBox& box, const ivec3& cells,
                ContributionSink& sink)
        : triangle_(t),
          box_(box),
          spacing_(static_cast<float>(technique.spacing)),
          most_(technique.max_level),
          split_(technique.split),
          look_(t, std::min(t.area, spacing_ * spacing_)),
          sink_(sink),
          plain_look_(sink.takes_sums() && t.mask == nullptr && (t.albedo_map == nullptr || look_.albedo_map.srgb() != nullptr)) {
        surface_.albedo = t.material->albedo;
        surface_.srgb = look_.albedo_map.srgb();
        surface_.width = look_.albedo_map.width(), surface_.height = look_.albedo_map.height();
        surface_.cells = cells;
    }

    void tessellate(const Patch& patch) {
        if (triangle_.crosses && outside(patch)) return;
        if (in_one_cell(patch)) {
            add_one(patch, vec3(1.0f / 3.0f), patch.area);
            return;
        }
        std::array<float, 3> length;
        for (int i = 0; i < 3; ++i) length[i] = glm::distance(patch.corner[i], patch.corner[(i + 1) % 3]);
        const auto longest = static_cast<int>(std::max_element(length.begin(), length.end()) - length.begin());
        const float altitude = 2.0f * patch.area / *std::min_element(length.begin(), length.end());
        refuse_longer_than_most_voxels(length[longest]);
        const bool thin = split_ && 2.0f * patch.area <= spacing_ * length[longest] && length[longest] > spacing_;
        if (split_ && must_split(patch, length[longest], thin)) {
            halve(patch, longest);
            return;
        }
        if (thin) {
            emit_edges(patch, longest, length);
            flush(patch);
            return;
        }
        TessellationLevels levels;
        for (int i = 0; i < 3; ++i) levels.outer[i] = level(length[i]);
        levels.inner = level(altitude);
        emit(patch, levels);
    }

  private:
    bool outside(const Patch& patch) const {
        const vec3 lower = glm::min(glm::min(patch.corner[0], patch.corner[1]), patch.corner[2]);
        const vec3 upper = glm::max(glm::max(patch.corner[0], patch.corner[1]), patch.corner[2]);
        return glm::any(glm::lessThan(upper, box_.lower)) || glm::any(glm::greaterThan(lower, box_.upper));
    }
    int level(float length) const {
        return static_cast<int>(std::clamp(std::ceil(length / spacing_), 1.0f, static_cast<float>(most_)));
    }
    bool must_split(const Patch& patch, float longest, bool thin) const {
        if (std::ceil(longest / spacing_) > static_cast<float>(most_)) return true;
        if (thin) return false;
        // The vertices inside, (3/4) (altitude / spacing)^2 of them, lie in rows as long as the longest edge: too many where a
        // triangle is narrow, and too far apart where it is obtuse.
        const float narrowest = 2.0f * patch.area / longest;
        return longest > most_stretched * std::max(narrowest, spacing_);
    }
    void halve(const Patch& patch, int edge) {
        const int next = (edge + 1) % 3, opposite = (edge + 2) % 3;
        const vec3 corner = 0.5f * (patch.corner[edge] + patch.corner[next]);
        const vec2 texcoord = 0.5f * (patch.texcoord[edge] + patch.texcoord[next]);
        const auto half = [&](int kept) {
            return Patch{{patch.corner[opposite], patch.corner[kept], corner},
                         {patch.texcoord[opposite], patch.texcoord[kept], texcoord},
                         0.5f * patch.area};
        };
        tessellate(half(edge));
        tessellate(half(next));
    }
    static bool in_one_cell(const Patch& patch) {
        const vec3 cell = glm::floor(patch.corner[0]);
        return cell == glm::floor(patch.corner[1]) && cell == glm::floor(patch.corner[2]);
    }
    /// A triangle no wider than the spacing: the vertices of its edges alone. Along the longest edge, and along the other two,
    /// each stands for half of the area between the middles to its neighbours.
    void emit_edges(const Patch& patch, int longest, const std::array<float, 3>& length) {
        const int a = longest, b = (longest + 1) % 3, c = (longest + 2) % 3;
        const vec3 base = patch.corner[b] - patch.corner[a];
        const float foot = std::clamp(glm::dot(patch.corner[c] - patch.corner[a], base) / glm::dot(base, base), 1e-3f, 0.999f);
        const auto area_before = [foot](float x) {
            return x < foot ? x * x / foot : 1.0f - (1.0f - x) * (1.0f - x) / (1.0f - foot);
        };
        vec3 pending(0);
        float place = 0.0f, before = 0.0f;
        const auto next = [&](const vec3& weights, float x) {
            const float to = std::max(before, area_before(std::min(0.5f * (place + x), 1.0f)));
            add(patch, pending, 0.5f * (to - before) * patch.area);
            pending = weights, place = x, before = to;
        };
        const auto walk = [&](int from, int to, float begin, float end, int parts) {
            for (int j = 1; j <= parts; ++j) {
                const float t = static_cast<float>(j) / static_cast<float>(parts);
                vec3 weights(0);
                weights[from] = 1.0f - t, weights[to] = t;
                next(weights, begin + (end - begin) * t);
            }
        };
        const auto chain = [&](const auto& edges) {
            pending = vec3(0), pending[a] = 1.0f, place = before = 0.0f;
            edges();
            add(patch, pending, 0.5f * (1.0f - before) * patch.area);
        };
        chain([&] { walk(a, b, 0.0f, 1.0f, level(length[a])); });
        chain([&] {
            walk(a, c, 0.0f, foot, level(length[c]));
            walk(c, b, foot, 1.0f, level(length[b]));
        });
    }
    void emit(const Patch& patch, const TessellationLevels& levels) {
        const auto row = [&](const vec3& start, const vec3& along, int count, float share) {
            for (int j = 0; j < count; ++j) add(patch, start + along * static_cast<float>(j), share * patch.area);
        };
        tessellation_outer_rows(levels, row);
        const int inner = TessellationRings(levels).inner;
        if (!plain_look_ || inner > InnerVertices::most_level) {
            tessellation_inner_rows(inner, row);
            return flush(patch);
        }
        flush(patch);
        const int count = inner_vertices().count(inner);
        for (int i = 0; i < count; i += SampleSums::most)
            sum(inner_vertices().weights(inner, i, patch.area), std::min(SampleSums::most, count - i));
    }
    static const InnerVertices& inner_vertices() {
        static const InnerVertices vertices;
        return vertices;
    }
    void add(const Patch& patch, const vec3& weights, float area) {
        if (!plain_look_) return add_one(patch, weights, area);
        if (pending_ == SampleSums::most) flush(patch);
        second_[pending_] = weights.y, third_[pending_] = weights.z, area_[pending_] = area;
        ++pending_;
    }
    /// Brings the vertices of a patch that were added so far into their cells.
    void flush(const Patch& patch) {
        if (!plain_look_) return;
        see(patch);
        sum({second_.data(), third_.data(), area_.data(), 1.0f}, pending_);
        pending_ = 0;
    }
    void sum(const SampleWeights& weights, int count) {
        sum_samples(surface_, weights, count, sums_);
        sink_.add(sums_, count);
    }
    void see(const Patch& patch) {
        surface_.corner = sink_.seen(patch.corner[0]);
        surface_.texcoord = inside_texcoord(patch, vec3(1, 0, 0));
        for (int i = 0; i < 2; ++i) {
            surface_.edge[i] = sink_.seen(patch.corner[i + 1]) - surface_.corner;
            surface_.texcoord_edge[i] = (patch.texcoord[i + 1] - patch.texcoord[0]) * (1.0f - inwards);
        }
    }
    /// Inside the triangle: on its border, a picture that repeats may show its other end.
    static vec2 inside_texcoord(const Patch& patch, const vec3& weights) {
        const vec3 inside = weights * (1.0f - inwards) + inwards / 3.0f;
        return patch.texcoord[0] * inside.x + patch.texcoord[1] * inside.y + patch.texcoord[2] * inside.z;
    }
    void add_one(const Patch& patch, const vec3& weights, float area) {
        const vec3 position = patch.corner[0] * weights.x + patch.corner[1] * weights.y + patch.corner[2] * weights.z;
        if (triangle_.uniform()) {
            sink_.add(position, area, true, triangle_.material->albedo, triangle_.material->emission);
            return;
        }
        const vec2 uv = inside_texcoord(patch, weights);
        sink_.add(position, area, look_.solid(uv), look_.albedo(uv), look_.emission(uv));
    }

    const VoxelTriangle& triangle_;
    const LinearBox& box_;
    float spacing_;
    int most_;
    bool split_;
    Appearance look_;
    ContributionSink& sink_;
    // Vertices are looked at many at a time where their triangle has no mask and its texels are sRGB.
    bool plain_look_;
    int pending_ = 0;
    std::array<float, SampleSums::most + SampleSums::spare> second_, third_, area_;
    SampledSurface surface_;
    SampleSums sums_;
};

}  // namespace

VoxelGrid voxelize(const Tessellation& technique, const Scene& scene, const Domain& domain) {
    // What lies flat in warped voxels has edges that are as long there as they look; whole triangles keep their uniform lengths.
    const Handing handing = technique.levels == "warped" ? Handing::pieces : Handing::at_once;
    const Domain one_grid{.cells = domain.cells};
    const LinearBox box(handing == Handing::pieces ? one_grid : domain, handing);
    const SmallTriangleEmitter small(scene, domain, static_cast<float>(technique.spacing));
    const EmitPacket emit_small = [&](const TrianglePacket& packet, std::uint32_t lanes, ContributionSink& sink) {
        return small(packet, lanes, sink);
    };
    return voxelize_triangles(
        scene, domain, handing,
        [&](const VoxelTriangle& t, ContributionSink& sink) {
            Tessellator(technique, t, box, domain.cells, sink)
                .tessellate({{t.corner[0], t.corner[1], t.corner[2]}, {t.texcoord[0], t.texcoord[1], t.texcoord[2]}, t.area});
        },
        Blend::mean, domain.plain() ? emit_small : EmitPacket());
}

}  // namespace interreflect
