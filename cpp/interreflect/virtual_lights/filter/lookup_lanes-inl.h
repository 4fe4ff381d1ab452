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

/// Estimates with one step of Newton's: a few units in the last place.
HWY_INLINE Vector reciprocal(Vector a) {
    const Tag d;
    const Vector estimate = hn::ApproximateReciprocal(a);
    return hn::Mul(estimate, hn::NegMulAdd(a, estimate, hn::Set(d, 2.0f)));
}
HWY_INLINE Vector inverse_root(Vector a) {
    const Tag d;
    const Vector estimate = hn::ApproximateReciprocalSqrt(a), half = hn::Mul(hn::Set(d, 0.5f), hn::Mul(a, estimate));
    return hn::Mul(estimate, hn::NegMulAdd(half, estimate, hn::Set(d, 1.5f)));
}

/// Directions in the light's frame, and where they lie in its map.
struct Towards {
    Vec3 direction;  // unit
    Vector x, y;     // of the paraboloid's square

    /// From coordinates in the plane at distance 1 along the light's normal.
    static HWY_INLINE Towards plane(Vector px, Vector py) {
        const Tag d;
        const Vector one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
        // Beyond the largest, directions lie on the horizon whatever the length.
        const Vector length2 = hn::Min(hn::MulAdd(px, px, hn::MulAdd(py, py, one)), hn::Set(d, 1e30f));
        const Vector inverse = inverse_root(length2);
        const Vector scale = hn::Mul(half, reciprocal(hn::MulAdd(length2, inverse, one)));
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
    Vec3 local, plane;        // position; geometric normal
    Vector distance, height;  // height: of the plane over the light, negative where it faces the light
    LaneMask lit;  // that the light reaches at all: its middle is not below the pixel's horizon, as one is behind a thin wall

    HWY_INLINE Receiving(const Vec3& facing, Vector far, Vector above, LaneMask some)
        : local{}, plane(facing), distance(far), height(above), lit(some) {}
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
        lit = hn::And(lit, hn::Lt(height, hn::Zero(d)));
    }
    /// Where height / slope, how far along a direction the pixel's plane lies, is about the pixel's own distance. Both are
    /// negative where the plane faces the light. Elsewhere the pixel's surface is taken to lie at its distance.
    HWY_INLINE LaneMask plane_is_near(Vector along, Vector slope) const {
        const Tag d;
        const Vector least = hn::Mul(hn::Mul(distance, slope), hn::Set(d, 0.25f));
        return hn::And(hn::Le(along, least), hn::Ge(along, hn::Mul(least, hn::Set(d, 16.0f))));
    }
};

/// What is seen, and the lanes where it stands between the light and the pixel's surface.
struct Seen {
    Vector planar;  // depth along the light's normal
    LaneMask blocks;
};

/// A light's shadow map.
class MapLookup {
  public:
    explicit HWY_INLINE MapLookup(const ShadowedLight& light)
        : map_(light.map()),
          size_(hn::Set(Tag(), static_cast<float>(light.shadows.size))),
          bias_(hn::Set(Tag(), light.shadows.bias)) {}

    /// Directions are those of the texels' middles, so that a flat surface agrees with its own map however it is lit. A middle's
    /// is (2 px, 2 py, 1 - r^2) / (1 + r^2): its length is multiplied out of all comparisons.
    HWY_INLINE Seen operator()(const Receiving& pixels, const Towards& to, LaneMask) const {
        const Tag d;
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
        const Vector last = hn::Sub(size_, one), width = hn::Div(two, size_), first = hn::NegMulAdd(width, hn::Set(d, 0.5f), one);
        const auto texel = [&](Vector v) HWY_ATTR { return hn::Floor(hn::Min(hn::Max(hn::Mul(v, size_), zero), last)); };
        const Vector column = texel(to.x), row = texel(to.y);
        // Whole numbers below 2^24.
        const Vector depth = hn::GatherIndex(d, map_, hn::ConvertTo(hn::RebindToSigned<Tag>(), hn::MulAdd(row, size_, column)));
        const Vector px = hn::MulSub(column, width, first), py = hn::MulSub(row, width, first);
        const Vector r2 = hn::MulAdd(px, px, hn::Mul(py, py)), along_normal = hn::Sub(one, r2);
        const Vec3 direction{hn::Add(px, px), hn::Add(py, py), along_normal};
        const Vector length = hn::Add(one, r2);
        const Vector slope = dot(pixels.plane, direction), height = hn::Mul(pixels.height, length);
        const Vector nearer = hn::Add(depth, bias_);
        const LaneMask flat = pixels.plane_is_near(height, slope);
        const LaneMask blocks =
            hn::Lt(hn::IfThenElse(flat, height, nearer), hn::IfThenElse(flat, hn::Mul(nearer, slope), pixels.distance));
        return {hn::Div(hn::Mul(depth, along_normal), length), blocks};
    }
    /// Half a texel's width where a pixel is seen, in the plane at distance 1.
    HWY_INLINE Vector half_texel(const Vec3& direction) const {
        const Tag d;
        const Vector turn = hn::Div(hn::Add(hn::Set(d, 1.0f), direction.z), size_);
        return hn::Div(turn, hn::Max(hn::Mul(direction.z, direction.z), hn::Set(d, 1e-4f)));
    }

  private:
    const float* map_;
    Vector size_, bias_;
};

/// The scene itself, by rays from the light's middle.
class RayLookup {
  public:
    explicit HWY_INLINE RayLookup(const ShadowedLight& light)
        : light_(light), origin_(light.disk.position + light.disk.normal * light.disk.offset) {}

    HWY_INLINE Seen operator()(const Receiving& pixels, const Towards& to, LaneMask active) const {
        const Tag d;
        const Vector depth = trace(to, active), slope = dot(pixels.plane, to.direction);
        const Vector surface =
            hn::IfThenElse(pixels.plane_is_near(pixels.height, slope), hn::Div(pixels.height, slope), pixels.distance);
        // Rounding, and the light's own offset.
        const Vector bias = hn::MulAdd(surface, hn::Set(d, 1e-3f), hn::Set(d, 4.0f * light_.disk.offset));
        return {hn::Mul(depth, to.direction.z), hn::Lt(depth, hn::Sub(surface, bias))};
    }
    HWY_INLINE Vector half_texel(const Vec3&) const { return hn::Zero(Tag()); }

  private:
    /// Radial distances.
    HWY_INLINE Vector trace(const Towards& to, LaneMask active) const {
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

    const ShadowedLight& light_;
    vec3 origin_;
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
