#include "shading/emitters.h"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include "math/sampling.h"
#include "shading/lights.h"
#include "shading/table.h"
#include "visibility/surface.h"

namespace interreflect {
namespace {

// From further away than so many times its radius a shape is weighed and sampled by area.
constexpr float far_radii = 8.0f;
constexpr int most_cuts = 64;

/// The corner of a piece and its shape, in units of 1 / cuts of barycentric coordinates.
struct Piece {
    vec2 corner;
    float sign;  // 1: along both edges; -1: the mirrored pieces between them
};
/// Pieces go row by row along the first edge; row i has cuts - i upright pieces with mirrored ones between them.
Piece piece_at(std::uint32_t index, int cuts) {
    int i = 0;
    auto left = static_cast<int>(index);
    while (left >= 2 * (cuts - i) - 1) left -= 2 * (cuts - i) - 1, ++i;
    const int j = left / 2;
    if (left % 2 == 0) return {{static_cast<float>(i), static_cast<float>(j)}, 1.0f};
    return {{static_cast<float>(i + 1), static_cast<float>(j + 1)}, -1.0f};
}
std::uint32_t piece_of(const vec2& barycentric, int cuts) {
    if (cuts == 1) return 0;
    const float n = static_cast<float>(cuts);
    const int i = std::clamp(static_cast<int>(barycentric.x * n), 0, cuts - 1);
    const int j = std::clamp(static_cast<int>(barycentric.y * n), 0, cuts - 1 - i);
    const float u = barycentric.x * n - static_cast<float>(i), v = barycentric.y * n - static_cast<float>(j);
    const int mirrored = u + v > 1.0f && j < cuts - 1 - i ? 1 : 0;
    return static_cast<std::uint32_t>(i * (2 * cuts - i) + 2 * j + mirrored);
}
vec2 point_in(const Piece& piece, int cuts, const vec2& in_piece) {
    return (piece.corner + in_piece * piece.sign) / static_cast<float>(cuts);
}

vec2 texcoord_at(const GeometryArrays& arrays, const uvec3& t, const vec2& b) {
    return arrays.texcoords[t.x] * (1.0f - b.x - b.y) + arrays.texcoords[t.y] * b.x + arrays.texcoords[t.z] * b.y;
}

/// So many cuts that a piece spans about two texels.
int cuts_for(const Texture& map, const GeometryArrays& arrays, const uvec3& t) {
    const vec2 size(static_cast<float>(map.width()), static_cast<float>(map.height()));
    const vec2 a = arrays.texcoords[t.x] * size, b = arrays.texcoords[t.y] * size, c = arrays.texcoords[t.z] * size;
    const float texels = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    return std::clamp(static_cast<int>(texels / 2.0f), 1, most_cuts);
}

using ThreeCorners = std::array<vec3, 3>;

EmitterShape triangle_of(const ThreeCorners& at, const vec3& normal) {
    EmitterShape shape{at[0], at[1] - at[0], at[2] - at[0], normal, {}};
    shape.to_middle = (shape.edge1 + shape.edge2) / 3.0f;
    shape.area = 0.5f * glm::length(glm::cross(shape.edge1, shape.edge2));
    float radius2 = 0;
    for (const vec3& corner : at) {
        const vec3 spoke = corner - at[0] - shape.to_middle;
        radius2 = glm::max(radius2, glm::dot(spoke, spoke));
    }
    shape.near2 = far_radii * far_radii * radius2;
    return shape;
}

/// The rectangle of two triangles in one plane that share their longest edge, if that is what they are up to rounding.
std::optional<EmitterShape> rectangle_of(const ThreeCorners& p, const ThreeCorners& q, const vec3& normal, const vec3& other) {
    if (!(glm::dot(normal, other) > 0.99999f)) return std::nullopt;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const vec3 corner = p[i], e1 = p[(i + 1) % 3] - corner, e2 = p[(i + 2) % 3] - corner;
            const float rounding = 1e-5f * (glm::length(e1) + glm::length(e2));
            if (std::fabs(glm::dot(e1, e2)) > 1e-5f * glm::length(e1) * glm::length(e2)) continue;
            const auto meet = [&](const vec3& a, const vec3& b) { return glm::length(a - b) <= rounding; };
            const vec3 q1 = q[(j + 1) % 3] - corner, q2 = q[(j + 2) % 3] - corner;
            if (!meet(q[j] - corner, e1 + e2) || !((meet(q1, e1) && meet(q2, e2)) || (meet(q1, e2) && meet(q2, e1)))) continue;
            EmitterShape shape{corner, e1, e2, normal, 0.5f * (e1 + e2)};
            shape.area = glm::length(e1) * glm::length(e2);
            shape.near2 = far_radii * far_radii * glm::dot(shape.to_middle, shape.to_middle);
            shape.rectangle = true;
            return shape;
        }
    return std::nullopt;
}

}  // namespace

EmitterSampler::EmitterSampler(const Scene& scene) : scene_(&scene) {
    for (const Emitter& emitter : scene.emitters) triangles_.push_back(make_triangle(emitter));
    cdf_.assign(1, 0.0f);
    for (auto& triangle : triangles_) append_weights(triangle), few_ = few_ || triangle.cuts > 1 || triangle.mask >= 0;
    const bool light = make_cdf(cdf_) > 0;
    few_ = !few_ && triangles_.size() <= most_weighed;
    if (!light) triangles_.clear();
    if (few_) make_shapes();
}

EmitterSampler::Triangle EmitterSampler::make_triangle(const Emitter& emitter) const {
    const Corners corners = world_corners(*scene_->geometry, emitter.instance, emitter.triangle);
    Triangle t;
    t.corner = corners.a, t.edge1 = corners.b - corners.a, t.edge2 = corners.c - corners.a;
    t.normal = hit_geometry(*scene_->geometry, emitter.instance, emitter.triangle, 0.0f, 0.0f).geometric_normal;
    t.area = emitter.area;
    t.instance = emitter.instance, t.triangle = emitter.triangle;
    t.material = static_cast<int>(scene_->material_of(emitter.triangle));
    const Material& material = scene_->materials[t.material];
    t.emission = material.emission, t.map = material.emission_map, t.mask = material.mask;
    const auto& arrays = *scene_->geometry->arrays;
    if (t.map >= 0) t.cuts = cuts_for(*scene_->textures[t.map], arrays, arrays.triangles[t.triangle]);
    return t;
}

void EmitterSampler::append_weights(const Triangle& triangle) {
    const auto index = static_cast<std::uint32_t>(&triangle - triangles_.data());
    triangles_[index].first_piece = static_cast<std::uint32_t>(of_piece_.size());
    const auto pieces = static_cast<std::uint32_t>(triangle.cuts * triangle.cuts);
    const float piece_area = triangle.area / static_cast<float>(pieces);
    constexpr int n = 4;  // points along a piece's edge: finer than the texels it spans
    constexpr int points = n * (n + 1) / 2;
    const auto along = [](int k) { return (static_cast<float>(k) + 1.0f / 3.0f) / n; };
    const float whole = luminance(scene_->emitters[index].radiance);
    for (std::uint32_t k = 0; k < pieces; ++k) {
        float mean = luminance(triangle.emission);
        if (triangle.map >= 0) {
            const Piece piece = piece_at(k, triangle.cuts);
            vec3 sum{0};
            for (int i = 0; i < n; ++i)
                for (int j = 0; i + j < n; ++j) sum += radiance(triangle, point_in(piece, triangle.cuts, {along(i), along(j)}));
            // A tenth by the triangle's mean: a bright point that the pattern missed keeps a density, and so the mean is right.
            mean = 0.9f * luminance(sum) / points + 0.1f * glm::max(whole, 1e-3f * luminance(triangle.emission));
        }
        cdf_.push_back(mean * piece_area);
        of_piece_.push_back(index);
    }
}

vec3 EmitterSampler::radiance(const Triangle& t, const vec2& barycentric) const {
    if (t.map < 0 && t.mask < 0) return t.emission;
    const auto& arrays = *scene_->geometry->arrays;
    const vec2 texcoord = texcoord_at(arrays, arrays.triangles[t.triangle], barycentric);
    if (t.mask >= 0 && !scene_->masks[t.mask]->solid(texcoord)) return vec3(0);
    return t.map < 0 ? t.emission : t.emission * scene_->textures[t.map]->bilinear(texcoord);
}

/// Two triangles that make a rectangle are one shape.
void EmitterSampler::make_shapes() {
    const auto corners_of = [](const Triangle& t) { return ThreeCorners{t.corner, t.corner + t.edge1, t.corner + t.edge2}; };
    std::vector<bool> done(triangles_.size(), false);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        if (done[i]) continue;
        const auto number = static_cast<int>(shapes_.size());
        triangles_[i].shape = number;
        std::optional<EmitterShape> shape;
        for (std::size_t j = i + 1; j < triangles_.size() && !shape; ++j) {
            if (done[j] || triangles_[j].emission != triangles_[i].emission) continue;
            shape =
                rectangle_of(corners_of(triangles_[i]), corners_of(triangles_[j]), triangles_[i].normal, triangles_[j].normal);
            if (shape) triangles_[j].shape = number, done[j] = true;
        }
        if (!shape) shape = triangle_of(corners_of(triangles_[i]), triangles_[i].normal);
        shape->emission = triangles_[i].emission;
        shape->luminance = luminance(shape->emission);
        shapes_.push_back(*shape);
    }
}

LightDirection EmitterSampler::sample(const vec3& position, float choose, const vec2& u) const {
    if (triangles_.empty()) return {};
    return few_ ? sample_shapes(shapes_, position, choose, u) : sample_many(position, choose, u);
}

EmitterSampler::Point EmitterSampler::sample_point(float choose, const vec2& u) const {
    const auto piece_index = static_cast<std::uint32_t>(choose_entry(cdf_, choose).index);
    const Triangle& t = triangles_[of_piece_[piece_index]];
    const vec2 b = point_in(piece_at(piece_index - t.first_piece, t.cuts), t.cuts, uniform_triangle(u));
    const float pieces = static_cast<float>(t.cuts) * static_cast<float>(t.cuts);
    const float density = (cdf_[piece_index + 1] - cdf_[piece_index]) * pieces / t.area;
    return {t.corner + t.edge1 * b.x + t.edge2 * b.y, t.normal, radiance(t, b), density, t.instance, t.triangle};
}

LightDirection EmitterSampler::sample_many(const vec3& position, float choose, const vec2& u) const {
    const Point point = sample_point(choose, u);
    const vec3 to = point.position - position;
    LightDirection light;
    light.distance = glm::length(to);
    light.direction = to / light.distance;
    const float cosine = -glm::dot(light.direction, point.normal);
    if (!(cosine > 0.0f) || !(light.distance > 0.0f)) return {};
    light.radiance = point.radiance;
    light.pdf = point.pdf * light.distance * light.distance / cosine;
    return light;
}

const EmitterSampler::Triangle* EmitterSampler::find(const Hit& hit) const {
    const auto key = std::make_tuple(hit.instance, hit.triangle);
    const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), key, [](const Triangle& t, const auto& k) {
        return std::make_tuple(t.instance, t.triangle) < k;
    });
    if (found == triangles_.end() || std::make_tuple(found->instance, found->triangle) != key) return nullptr;
    return &*found;
}

float EmitterSampler::pdf(const Hit& hit, const vec3& position, const vec3& direction) const {
    const Triangle* t = find(hit);
    if (t == nullptr) return 0.0f;
    if (few_) return shapes_pdf(shapes_, position, direction, t->shape);
    const float cosine = -glm::dot(direction, t->normal);
    if (!(cosine > 0.0f)) return 0.0f;
    const float distance = glm::dot(t->corner - position, t->normal) / -cosine;
    const float by_area = distance * distance / (t->area * cosine);
    const std::uint32_t piece = t->first_piece + piece_of({hit.u, hit.v}, t->cuts);
    return (cdf_[piece + 1] - cdf_[piece]) * static_cast<float>(t->cuts) * static_cast<float>(t->cuts) * by_area;
}

}  // namespace interreflect
