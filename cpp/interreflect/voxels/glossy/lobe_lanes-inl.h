// Glossy lobes of a vector of pixels. Included once for every vector target.
#if defined(INTERREFLECT_LOBE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_LOBE_LANES
#undef INTERREFLECT_LOBE_LANES
#else
#define INTERREFLECT_LOBE_LANES
#endif

#include "math/lanes-inl.h"
#include "voxels/glossy/lobe_table.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Where a pixel is seen from.
struct SeenFrom {
    Vec3 view;        // unit, towards the camera
    Vector distance;  // from it
    Vector cosine;    // between normal and view; 0 from behind

    HWY_INLINE SeenFrom(const vec3& eye, const Vec3& position, const Vec3& normal) {
        const Tag d;
        const Vec3 to_eye{hn::Sub(hn::Set(d, eye.x), position.x), hn::Sub(hn::Set(d, eye.y), position.y),
                          hn::Sub(hn::Set(d, eye.z), position.z)};
        distance = hn::Sqrt(dot(to_eye, to_eye));
        view = scaled(to_eye, hn::Div(hn::Set(d, 1.0f), hn::Max(distance, hn::Set(d, 1e-20f))));
        cosine = hn::Max(dot(normal, view), hn::Zero(d));
    }
};

/// Blends a table's entries, bilinear in sqrt(alpha) and the cosine. `first`: the entry with which each pixel's table begins.
class LobeLookUp {
  public:
    using Indices = hn::Vec<hn::RebindToSigned<Tag>>;

    HWY_INLINE LobeLookUp(const LobeCone* entries, Indices first, Vector alpha, Vector cosine)
        : floats_(reinterpret_cast<const float*>(entries)) {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const auto place = [&](Vector part, int count, Vector& fraction) HWY_ATTR {
            const Vector at = hn::Mul(hn::Min(hn::Max(part, zero), one), hn::Set(d, static_cast<float>(count - 1)));
            const auto below = hn::Min(hn::ConvertTo(di, at), hn::Set(di, count - 2));
            fraction = hn::Sub(at, hn::ConvertTo(d, below));
            return below;
        };
        Vector fx, fy;
        const auto i = place(hn::Sqrt(hn::Max(alpha, zero)), LobeTable::widths, fx), j = place(cosine, LobeTable::views, fy);
        const auto entry = hn::Add(first, hn::Add(hn::Mul(i, hn::Set(di, LobeTable::views)), j));
        at_ = hn::Mul(entry, hn::Set(di, floats));
        corners_[3] = hn::Mul(fx, fy);
        corners_[2] = hn::Sub(fx, corners_[3]);
        corners_[1] = hn::Sub(fy, corners_[3]);
        corners_[0] = hn::Sub(hn::Sub(one, fx), corners_[1]);
    }
    HWY_INLINE Vector scale() const { return blend(0); }
    HWY_INLINE Vector bias() const { return blend(1); }
    HWY_INLINE Vector along() const { return blend(2); }
    HWY_INLINE Vector up() const { return blend(3); }
    HWY_INLINE Vector half_angle() const { return blend(4); }
    /// What part of a channel of specular reflectance is reflected.
    static HWY_INLINE Vector albedo(Vector specular, Vector scale, Vector bias) {
        return hn::MulAdd(specular, scale, hn::NegMulAdd(specular, bias, bias));
    }

  private:
    static constexpr int floats = 5;
    static_assert(sizeof(LobeCone) == floats * sizeof(float));
    HWY_INLINE Vector blend(int number) const {
        const Tag d;
        const float* const from = floats_ + number;
        Vector sum = hn::Mul(corners_[0], hn::GatherIndex(d, from, at_));
        sum = hn::MulAdd(corners_[1], hn::GatherIndex(d, from + floats, at_), sum);
        sum = hn::MulAdd(corners_[2], hn::GatherIndex(d, from + floats * LobeTable::views, at_), sum);
        return hn::MulAdd(corners_[3], hn::GatherIndex(d, from + floats * (LobeTable::views + 1), at_), sum);
    }

    const float* floats_;
    Indices at_;
    Vector corners_[4];
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
