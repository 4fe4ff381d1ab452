// Lookups of what a virtual light sees, for a vector of pixels. Included once for every vector target.
#if defined(INTERREFLECT_LOOKUP_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_LOOKUP_LANES
#undef INTERREFLECT_LOOKUP_LANES
#else
#define INTERREFLECT_LOOKUP_LANES
#endif

#include "math/lanes-inl.h"
#include "virtual_lights/filter/shadowed_light.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Directions in the light's frame, and where they lie in its map.
struct Towards {
    Vec3 direction;  // unit
    Vector x, y;     // of the paraboloid's square

    /// From coordinates in the plane at distance 1 along the light's normal.
    static HWY_INLINE Towards plane(Vector px, Vector py) {
        const Tag d;
        const Vector one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
        const Vector length = hn::Sqrt(hn::MulAdd(px, px, hn::MulAdd(py, py, one)));
        const Vector inverse = hn::Div(one, length), scale = hn::Div(half, hn::Add(length, one));
        return {{hn::Mul(px, inverse), hn::Mul(py, inverse), inverse}, hn::MulAdd(px, scale, half), hn::MulAdd(py, scale, half)};
    }
    /// From a place of the map; beyond the horizon's circle, the horizon.
    static HWY_INLINE Towards map(Vector x, Vector y) {
        const Tag d;
        const Vector one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), half = hn::Set(d, 0.5f);
        Vector px = hn::MulSub(x, two, one), py = hn::MulSub(y, two, one);
        const Vector r2 = hn::MulAdd(px, px, hn::Mul(py, py));
        const Vector inside = hn::Min(one, hn::Div(hn::Set(d, 0.999f), hn::Sqrt(hn::Max(r2, hn::Set(d, 1e-20f)))));
        px = hn::Mul(px, inside), py = hn::Mul(py, inside);
        const Vector s2 = hn::MulAdd(px, px, hn::Mul(py, py)), scale = hn::Div(one, hn::Add(one, s2));
        return {{hn::Mul(hn::Mul(two, px), scale), hn::Mul(hn::Mul(two, py), scale), hn::Mul(hn::Sub(one, s2), scale)},
                hn::MulAdd(px, half, half),
                hn::MulAdd(py, half, half)};
    }
};

/// Pixels in a light's frame, with the planes of their surfaces.
struct Receiving {
    Vec3 local, plane;  // position; geometric normal
    Vector distance, height;
    LaneMask lit;  // that the light reaches at all

    HWY_INLINE Receiving(const ShadowedLight& light, const Receivers& receivers, int first, LaneMask reached) : lit(reached) {
        const Tag d;
        const auto load = [&](const float(*from)[Receivers::capacity]) HWY_ATTR {
            return Vec3{hn::Load(d, from[0] + first), hn::Load(d, from[1] + first), hn::Load(d, from[2] + first)};
        };
        const auto everywhere = [&](const vec3& v) HWY_ATTR { return Vec3{hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)}; };
        const Vec3 tangent = everywhere(light.frame.tangent), bitangent = everywhere(light.frame.bitangent),
                   normal = everywhere(light.frame.normal), centre = everywhere(light.disk.position);
        const auto turned = [&](const Vec3& v) HWY_ATTR { return Vec3{dot(v, tangent), dot(v, bitangent), dot(v, normal)}; };
        const Vec3 at = load(receivers.position);
        local = turned({hn::Sub(at.x, centre.x), hn::Sub(at.y, centre.y), hn::Sub(at.z, centre.z)});
        local.z = hn::Max(local.z, hn::Set(d, 1e-20f));
        plane = turned(load(receivers.geometric_normal));
        distance = hn::Sqrt(dot(local, local));
        height = dot(plane, local);
    }
    /// How far along a direction the pixel's surface lies, were it flat: its plane, unless that is far from the pixel's own
    /// distance.
    HWY_INLINE Vector surface(const Vec3& direction) const {
        const Tag d;
        const Vector along = hn::Div(height, dot(plane, direction));
        const auto near =
            hn::And(hn::Ge(along, hn::Mul(distance, hn::Set(d, 0.25f))), hn::Le(along, hn::Mul(distance, hn::Set(d, 4.0f))));
        return hn::IfThenElse(near, along, distance);
    }
};

/// A light's shadow map.
class MapLookup {
  public:
    explicit HWY_INLINE MapLookup(const ShadowedLight& light)
        : map_(light.map()), size_(light.shadows.size), bias_(hn::Set(Tag(), light.shadows.bias)) {}

    /// Radial distances of what is seen. Directions become those of the texels' middles, so that a flat surface agrees with its
    /// own map however it is lit.
    HWY_INLINE Vector depth(Towards& to, LaneMask) const {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const Vector size = hn::Set(d, static_cast<float>(size_));
        const auto last = hn::Set(di, size_ - 1), zero = hn::Zero(di);
        const auto column = hn::Min(hn::Max(hn::ConvertTo(di, hn::Mul(to.x, size)), zero), last);
        const auto row = hn::Min(hn::Max(hn::ConvertTo(di, hn::Mul(to.y, size)), zero), last);
        const Vector one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), width = hn::Div(two, size);
        const auto middle = [&](auto texel) HWY_ATTR {
            return hn::MulSub(hn::ConvertTo(d, texel), width, hn::Sub(one, hn::Mul(width, hn::Set(d, 0.5f))));
        };
        const Vector px = middle(column), py = middle(row);
        const Vector r2 = hn::MulAdd(px, px, hn::Mul(py, py)), scale = hn::Div(one, hn::Add(one, r2));
        to.direction = {hn::Mul(hn::Mul(two, px), scale), hn::Mul(hn::Mul(two, py), scale), hn::Mul(hn::Sub(one, r2), scale)};
        return hn::GatherIndex(d, map_, hn::Add(hn::Mul(row, hn::Set(di, size_)), column));
    }
    HWY_INLINE Vector bias(Vector) const { return bias_; }
    /// Half a texel's width where a pixel is seen, in the plane at distance 1.
    HWY_INLINE Vector half_texel(const Vec3& direction) const {
        const Tag d;
        const Vector turn = hn::Div(hn::Add(hn::Set(d, 1.0f), direction.z), hn::Set(d, static_cast<float>(size_)));
        return hn::Div(turn, hn::Max(hn::Mul(direction.z, direction.z), hn::Set(d, 1e-4f)));
    }

  private:
    const float* map_;
    int size_;
    Vector bias_;
};

/// The scene itself, by rays from the light's middle.
class RayLookup {
  public:
    explicit HWY_INLINE RayLookup(const ShadowedLight& light)
        : light_(light), origin_(light.disk.position + light.disk.normal * light.disk.offset) {}

    HWY_INLINE Vector depth(const Towards& to, LaneMask active) const {
        const Tag d;
        alignas(64) float x[16], y[16], z[16], found[16];
        hn::Store(to.direction.x, d, x), hn::Store(to.direction.y, d, y), hn::Store(to.direction.z, d, z);
        RayPacket packet;
        std::uint32_t lanes = 0;
        for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i)
            packet.set(i, {origin_, 0.0f, light_.frame.to_world({x[i], y[i], z[i]})});
        hn::StoreU(hn::IfThenElseZero(active, hn::Set(d, 1.0f)), d, found);
        for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) lanes |= found[i] > 0 ? 1U << i : 0U;
        light_.intersector.nearest(packet, lanes);
        for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) found[i] = packet.far[i];
        return hn::Load(d, found);
    }
    /// Rounding, and the light's own offset.
    HWY_INLINE Vector bias(Vector distance) const {
        const Tag d;
        return hn::MulAdd(distance, hn::Set(d, 1e-3f), hn::Set(d, 4.0f * light_.disk.offset));
    }
    HWY_INLINE Vector half_texel(const Vec3&) const { return hn::Zero(Tag()); }

  private:
    const ShadowedLight& light_;
    vec3 origin_;
};

/// What is seen, and the lanes where it stands between the light and the pixel's surface.
struct Seen {
    Vector depth;
    LaneMask blocks;
};
template <class Lookup>
HWY_INLINE Seen look_up(const Lookup& lookup, const Receiving& pixels, Towards& to, LaneMask active) {
    const Vector depth = lookup.depth(to, active);
    const Vector surface = pixels.surface(to.direction);
    return {depth, hn::Lt(depth, hn::Sub(surface, lookup.bias(surface)))};
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
