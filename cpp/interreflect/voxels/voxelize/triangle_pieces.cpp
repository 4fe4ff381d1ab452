#include "voxels/voxelize/triangle_pieces.h"

#include <algorithm>
#include <array>
#include <bit>

namespace interreflect {
namespace {

constexpr std::uint32_t triangles_of_range = 2048;
// How far a piece may bend away from a flat one, voxels: where samples are put as if it were flat; and where only their spacing
// is chosen so.
constexpr float most_bend = 1.0f / 32.0f, most_bend_sampled = 0.5f;
constexpr int most_halvings = 24;

/// A corner of a piece: linear voxels, and where it lies in the whole triangle.
struct Corner {
    vec3 p;
    vec2 weight;  // of the triangle's second and third corner
};
Corner mix(const Corner& a, const Corner& b, float t) { return {a.p + (b.p - a.p) * t, a.weight + (b.weight - a.weight) * t}; }

/// A triangle cut by the six faces of each of nested grids, at most: every cut adds one corner.
struct Polygon {
    std::array<Corner, 3 + 6 * Domain::most_cascades> corner;
    int count = 0;
};

/// The points with dot(normal, p) + offset >= 0.
struct HalfSpace {
    vec3 normal;
    float offset;
    float of(const vec3& p) const { return glm::dot(normal, p) + offset; }
    HalfSpace opposite() const { return {-normal, -offset}; }
};

Polygon cut(const Polygon& polygon, const HalfSpace& side) {
    Polygon inside;
    for (int i = 0; i < polygon.count; ++i) {
        const Corner &a = polygon.corner[i], &b = polygon.corner[(i + 1) % polygon.count];
        const float da = side.of(a.p), db = side.of(b.p);
        if (da >= 0.0f) inside.corner[inside.count++] = a;
        if ((da > 0.0f && db < 0.0f) || (da < 0.0f && db > 0.0f)) inside.corner[inside.count++] = mix(a, b, da / (da - db));
    }
    return inside;
}

std::array<HalfSpace, 6> faces(const vec3& lower, const vec3& upper) {
    return {{{{1, 0, 0}, -lower.x},
             {{-1, 0, 0}, upper.x},
             {{0, 1, 0}, -lower.y},
             {{0, -1, 0}, upper.y},
             {{0, 0, 1}, -lower.z},
             {{0, 0, -1}, upper.z}}};
}

/// Planes that hold a view volume: what lies beyond them is outside of it, and before the nearest the warp has no value. Of a
/// spherical one, whose other faces are curved, planes that hold them.
std::array<HalfSpace, 6> faces(const Warp& w) {
    if (w.kind == Warp::Kind::perspective)
        return {{{w.forward, -w.near},
                 {-w.forward, w.far},
                 {w.forward * w.half_x + w.right, 0},
                 {w.forward * w.half_x - w.right, 0},
                 {w.forward * w.half_y + w.up, 0},
                 {w.forward * w.half_y - w.up, 0}}};
    const float highest = std::fabs(w.elevation) + w.half_y, narrowest = std::cos(std::min(highest, 1.55f)) * std::cos(w.half_x);
    const float sine = std::sin(w.half_x), cosine = std::cos(w.half_x);
    return {{{w.forward, -w.near * narrowest},
             {-w.forward, w.far},
             {w.forward * sine + w.right * cosine, 0},
             {w.forward * sine - w.right * cosine, 0},
             {w.up, w.far},
             {-w.up, w.far}}};
}

class Pieces {
  public:
    Pieces(const Domain& domain, float bend, const VoxelTriangle& whole, const VisitTriangle& visit)
        : domain_(domain), whole_(whole), visit_(visit), most_bend_(bend), piece_(whole) {}

    /// Cuts up the whole triangle, which is in linear voxels.
    void cut_up() {
        const std::array<Corner, 3> whole{Corner{whole_.corner[0], {0, 0}}, Corner{whole_.corner[1], {1, 0}},
                                          Corner{whole_.corner[2], {0, 1}}};
        if (domain_.cascades > 1) return nested(whole);
        const Warp& warp = domain_.warp;
        const auto bounds = warp.view_volume() ? faces(warp) : faces(vec3(0), vec3(domain_.cells));
        bool inside = true;
        for (const HalfSpace& face : bounds) {
            const float a = face.of(whole[0].p), b = face.of(whole[1].p), c = face.of(whole[2].p);
            if (std::max({a, b, c}) < 0.0f) return;
            inside &= std::min({a, b, c}) >= 0.0f;
        }
        if (inside) return flatten(whole, 0, most_halvings);
        Polygon polygon = polygon_of(whole);
        for (const HalfSpace& face : bounds) polygon = cut(polygon, face);
        fan(polygon, 0);
    }

  private:
    static Polygon polygon_of(const std::array<Corner, 3>& triangle) {
        Polygon polygon;
        polygon.count = 3;
        std::copy(triangle.begin(), triangle.end(), polygon.corner.begin());
        return polygon;
    }
    /// Most triangles lie in one grid, apart from the finer ones.
    void nested(const std::array<Corner, 3>& whole) {
        const vec3 lower = glm::min(glm::min(whole[0].p, whole[1].p), whole[2].p);
        const vec3 upper = glm::max(glm::max(whole[0].p, whole[1].p), whole[2].p);
        for (int k = 0; k < domain_.cascades; ++k) {
            const vec3 first = domain_.linear_in(k, vec3(0)), last = domain_.linear_in(k, vec3(domain_.cells));
            if (glm::all(glm::greaterThanEqual(lower, first)) && glm::all(glm::lessThan(upper, last)))
                return flatten(whole, k, most_halvings);
            const bool apart = glm::any(glm::lessThan(upper, first)) || glm::any(glm::greaterThan(lower, last));
            if (!apart) return nested(polygon_of(whole), k);
        }
    }
    /// What lies in grid `k` belongs to it; what lies outside to the next.
    void nested(Polygon polygon, int k) {
        const vec3 lower = domain_.linear_in(k, vec3(0)), upper = domain_.linear_in(k, vec3(domain_.cells));
        for (const HalfSpace& face : faces(lower, upper)) {
            if (k + 1 < domain_.cascades) {
                const Polygon outside = cut(polygon, face.opposite());
                if (outside.count > 0) nested(outside, k + 1);
            }
            polygon = cut(polygon, face);
        }
        fan(polygon, k);
    }
    void fan(const Polygon& polygon, int cascade) {
        for (int i = 1; i + 1 < polygon.count; ++i)
            flatten({polygon.corner[0], polygon.corner[i], polygon.corner[i + 1]}, cascade, most_halvings);
    }
    vec3 voxels(const vec3& p, int cascade) const {
        return domain_.cascades > 1 ? domain_.in_cascade(cascade, p) : domain_.warp.to_voxels(p, domain_.cells);
    }
    /// How far the middle of an edge lies from where the warp has it, squared.
    float bend(const Corner& a, const Corner& b, const vec3& qa, const vec3& qb) const {
        const vec3 off = domain_.warp.to_voxels(0.5f * (a.p + b.p), domain_.cells) - 0.5f * (qa + qb);
        return glm::dot(off, off);
    }
    /// Halves the edge that the warp bends most until none is bent much. A curved edge's middle may lie on the chord (about a
    /// separable warp's centre), so long edges are halved in any case.
    void flatten(const std::array<Corner, 3>& c, int cascade, int halvings) {
        const vec3 q[3] = {voxels(c[0].p, cascade), voxels(c[1].p, cascade), voxels(c[2].p, cascade)};
        int worst = -1;
        float most = most_bend_ * most_bend_;
        for (int i = 0; i < 3 && domain_.warp.kind != Warp::Kind::linear && halvings > 0; ++i) {
            const int j = (i + 1) % 3;
            const vec3 edge = q[j] - q[i];
            const float length = glm::dot(edge, edge) * (1.0f / (16.0f * 16.0f)) * most_bend_ * most_bend_;
            const float bent = std::max(bend(c[i], c[j], q[i], q[j]), length);
            if (bent > most) most = bent, worst = i;
        }
        if (worst < 0) return emit(c, q, cascade);
        const int a = worst, b = (worst + 1) % 3;
        const Corner middle = mix(c[a], c[b], 0.5f);
        std::array<Corner, 3> half = c;
        half[b] = middle;
        flatten(half, cascade, halvings - 1);
        half = c;
        half[a] = middle;
        flatten(half, cascade, halvings - 1);
    }
    void emit(const std::array<Corner, 3>& c, const vec3* q, int cascade) {
        const vec3 cross = glm::cross(q[1] - q[0], q[2] - q[0]);
        const float length = glm::length(cross);
        const vec3 lower = glm::min(glm::min(q[0], q[1]), q[2]), upper = glm::max(glm::max(q[0], q[1]), q[2]);
        const vec3 cells(domain_.cells);
        if (!(length > 0.0f) || glm::any(glm::lessThan(upper, vec3(0))) || glm::any(glm::greaterThan(lower, cells))) return;
        piece_.crosses = glm::any(glm::lessThan(lower, vec3(0))) || glm::any(glm::greaterThan(upper, cells));
        piece_.normal = cross / length;
        piece_.area = 0.5f * length;
        piece_.cascade = cascade;
        for (int i = 0; i < 3; ++i) {
            piece_.corner[i] = q[i];
            piece_.linear[i] = c[i].p;
            piece_.texcoord[i] = whole_.texcoord[0] * (1.0f - c[i].weight.x - c[i].weight.y) +
                                 whole_.texcoord[1] * c[i].weight.x + whole_.texcoord[2] * c[i].weight.y;
        }
        visit_(piece_);
    }

    const Domain& domain_;
    const VoxelTriangle& whole_;
    const VisitTriangle& visit_;
    const float most_bend_;
    VoxelTriangle piece_;
};

void make_whole(const TrianglePacket& packet, int lane, VoxelTriangle& made) {
    for (int i = 0; i < 3; ++i) made.corner[i] = packet.corner_of(lane, i);
    const vec3 cross = packet.cross_of(lane);
    const float length = glm::length(cross);
    made.normal = cross * (1.0f / (packet.flips ? -length : length));
    made.facing = made.normal;
    made.area = 0.5f * length;
    made.offset = packet.offset[lane];
    made.crosses = ((packet.crossing >> lane) & 1U) != 0;
    made.cascade = 0;
}

void add_surface(const Scene& scene, std::uint32_t triangle, VoxelTriangle& made) {
    const auto& arrays = *scene.geometry->arrays;
    const uvec3 t = arrays.triangles[triangle];
    const Material& material = scene.materials[arrays.materials[triangle]];
    made.material = &material;
    made.albedo_map = material.albedo_map >= 0 ? scene.textures[material.albedo_map].get() : nullptr;
    made.emission_map = material.emission_map >= 0 && material.emits() ? scene.textures[material.emission_map].get() : nullptr;
    made.mask = material.mask >= 0 ? scene.masks[material.mask].get() : nullptr;
    if (!made.uniform())
        for (int i = 0; i < 3; ++i) made.texcoord[i] = arrays.texcoords[t[i]];
}

/// Whether a triangle's box meets [0, cells]; and notes where it crosses it.
bool meets_box(const vec3& cells, VoxelTriangle& t) {
    const vec3 lower = glm::min(glm::min(t.corner[0], t.corner[1]), t.corner[2]);
    const vec3 upper = glm::max(glm::max(t.corner[0], t.corner[1]), t.corner[2]);
    if (glm::any(glm::lessThan(upper, vec3(0))) || glm::any(glm::greaterThan(lower, cells))) return false;
    t.crosses = glm::any(glm::lessThan(lower, vec3(0))) || glm::any(glm::greaterThan(upper, cells));
    return true;
}

/// The whole triangle in linear voxels of each of nested grids, or of the finest alone. View volumes take what may lie in them:
/// their linear voxels reach all around the eye.
void hand_whole(const Domain& domain, Handing handing, const VoxelTriangle& whole, const VisitTriangle& visit) {
    VoxelTriangle t = whole;
    for (int i = 0; i < 3; ++i) t.linear[i] = whole.corner[i];
    if (domain.warp.view_volume()) {
        t.crosses = true;
        return visit(t);
    }
    const bool at_once = handing == Handing::at_once;
    const vec3 cells = vec3(domain.cells) * static_cast<float>(at_once ? 1 << (domain.cascades - 1) : 1);
    for (int k = 0; k < (at_once ? 1 : domain.cascades); ++k) {
        if (!at_once && domain.cascades > 1) {
            t.cascade = k;
            t.area = whole.area / static_cast<float>(1 << (2 * k));
            for (int i = 0; i < 3; ++i) t.corner[i] = domain.in_cascade(k, whole.corner[i]);
        }
        if (meets_box(cells, t)) visit(t);
    }
}

}  // namespace

std::vector<TriangleRange> triangle_ranges(const Geometry& geometry) {
    std::vector<TriangleRange> ranges;
    for (std::uint32_t i = 0; i < geometry.instances.size(); ++i) {
        const Group& group = geometry.groups[geometry.instances[i].group];
        const std::uint32_t end = group.first_triangle + group.triangle_count;
        for (std::uint32_t t = group.first_triangle; t < end; t += triangles_of_range)
            ranges.push_back({i, t, std::min(t + triangles_of_range, end)});
    }
    return ranges;
}

int VoxelTriangle::level(const Texture& texture, float sample_area) const {
    const vec2 du = texcoord[1] - texcoord[0], dv = texcoord[2] - texcoord[0];
    const float share = 0.5f * std::fabs(du.x * dv.y - du.y * dv.x) * sample_area / area;
    const float texels = share * static_cast<float>(texture.width()) * static_cast<float>(texture.height());
    if (!(texels >= 2.0f)) return 0;
    // Nearest level: round(log2(texels) / 2).
    return std::min((std::ilogb(texels) + 1) / 2, texture.levels() - 1);
}

void for_each_triangle(const Scene& scene, const Domain& domain, Handing handing, const TriangleRange& range,
                       const VisitTriangle& visit, const PassOver& pass_over) {
    const bool plain = domain.plain();
    const PacketSource source(*scene.geometry, domain, range.instance);
    TrianglePacket packet;
    VoxelTriangle triangle;
    for (std::uint32_t first = range.begin; first < range.end; first += TrianglePacket::width) {
        load_packet(source, first, std::min<std::uint32_t>(TrianglePacket::width, range.end - first), packet);
        std::uint32_t lanes = packet.with_area;
        if (plain) lanes &= ~packet.outside;
        if (lanes != 0 && pass_over && domain.cascades == 1) lanes &= ~pass_over(packet, lanes);
        for (; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            make_whole(packet, lane, triangle);
            add_surface(scene, first + static_cast<std::uint32_t>(lane), triangle);
            if (plain)
                visit(triangle);
            else if (handing == Handing::pieces || handing == Handing::sampled)
                Pieces(domain, handing == Handing::pieces ? most_bend : most_bend_sampled, triangle, visit).cut_up();
            else
                hand_whole(domain, handing, triangle, visit);
        }
    }
}

}  // namespace interreflect
