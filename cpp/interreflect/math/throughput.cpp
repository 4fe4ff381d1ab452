#include "math/throughput.h"

#include <hwy/cache_control.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/throughput.cpp"
#include <hwy/foreach_target.h>
// The kernels below are compiled once for each vector width.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace interreflect::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

float sum(const float* values, std::size_t count) {
    const hn::ScalableTag<float> d;
    const std::size_t n = hn::Lanes(d);
    auto a = hn::Zero(d), b = a, c = a, e = a;
    for (std::size_t i = 0; i + 4 * n <= count; i += 4 * n) {
        a = hn::Add(a, hn::Load(d, values + i));
        b = hn::Add(b, hn::Load(d, values + i + n));
        c = hn::Add(c, hn::Load(d, values + i + 2 * n));
        e = hn::Add(e, hn::Load(d, values + i + 3 * n));
    }
    return hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
}

void triad(float* a, const float* b, const float* c, std::size_t count) {
    const hn::ScalableTag<float> d;
    const auto s = hn::Set(d, 3.0f);
    // Stream: past the cache, as every array here is read or written once.
    for (std::size_t i = 0; i + hn::Lanes(d) <= count; i += hn::Lanes(d))
        hn::Stream(hn::MulAdd(s, hn::Load(d, c + i), hn::Load(d, b + i)), d, a + i);
    hwy::FlushStream();
}

/// Twelve independent chains: enough to fill two units of four cycles' latency, few enough for sixteen registers.
float multiply_add(std::size_t steps) {
    const hn::ScalableTag<float> d;
    const auto x = hn::Set(d, 0.9999f), y = hn::Set(d, 1e-4f);
    auto a = hn::Iota(d, 0.0f), b = a, c = a, e = a, f = a, g = a, h = a, i = a, j = a, k = a, l = a, m = a;
    for (std::size_t step = 0; step < steps; ++step) {
        a = hn::MulAdd(a, x, y), b = hn::MulAdd(b, x, y), c = hn::MulAdd(c, x, y), e = hn::MulAdd(e, x, y);
        f = hn::MulAdd(f, x, y), g = hn::MulAdd(g, x, y), h = hn::MulAdd(h, x, y), i = hn::MulAdd(i, x, y);
        j = hn::MulAdd(j, x, y), k = hn::MulAdd(k, x, y), l = hn::MulAdd(l, x, y), m = hn::MulAdd(m, x, y);
    }
    const auto all = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)),
                             hn::Add(hn::Add(hn::Add(f, g), hn::Add(h, i)), hn::Add(hn::Add(j, k), hn::Add(l, m))));
    return hn::GetLane(hn::SumOfLanes(d, all));
}

/// A cubic level of texels of four half floats, each row followed by a copy of its last texel; as the pyramid of voxels has them.
struct TexelLevel {
    const hwy::float16_t* texels;
    int size;
};

/// Trilinear look-up: four loads of two neighbouring texels.
HWY_INLINE auto look_up(const TexelLevel& level, float x, float y, float z) {
    const hn::FixedTag<float, 4> d4;
    const auto last = static_cast<float>(level.size - 1);
    const auto inside = [last](float v) HWY_ATTR { return v < 0.0f ? 0.0f : v < last ? v : last; };
    const float px = inside(x - 0.5f), py = inside(y - 0.5f), pz = inside(z - 0.5f);
    const int ix = static_cast<int>(px), iy = static_cast<int>(py), iz = static_cast<int>(pz);
    const auto fx = hn::Set(d4, px - static_cast<float>(ix));
    const float fy = py - static_cast<float>(iy), fz = pz - static_cast<float>(iz);
    const int row = 4 * (level.size + 1), slice = row * level.size;
    const auto* p = level.texels + 4 * ix + row * iy + slice * iz;
    const int dy = iy + 1 < level.size ? row : 0, dz = iz + 1 < level.size ? slice : 0;
#if HWY_MAX_BYTES >= 32
    const hn::FixedTag<float, 8> d8;
    const hn::FixedTag<hwy::float16_t, 8> h8;
    const auto pair = [&](int offset) HWY_ATTR { return hn::PromoteTo(d8, hn::LoadU(h8, p + offset)); };
    const auto mix = [&](auto a, auto b, float t) HWY_ATTR { return hn::MulAdd(hn::Sub(b, a), hn::Set(d8, t), a); };
    const auto texels = mix(mix(pair(0), pair(dy), fy), mix(pair(dz), pair(dy + dz), fy), fz);
    const auto low = hn::LowerHalf(d4, texels), high = hn::UpperHalf(d4, texels);
#else
    const hn::FixedTag<hwy::float16_t, 4> h4;
    const auto column = [&](int x4) HWY_ATTR {
        const auto at = [&](int offset) HWY_ATTR { return hn::PromoteTo(d4, hn::LoadU(h4, p + x4 + offset)); };
        const auto mix = [&](auto a, auto b, float t) HWY_ATTR { return hn::MulAdd(hn::Sub(b, a), hn::Set(d4, t), a); };
        return mix(mix(at(0), at(dy), fy), mix(at(dz), at(dy + dz), fy), fz);
    };
    const auto low = column(0), high = column(4);
#endif
    return hn::MulAdd(hn::Sub(high, low), fx, low);
}

/// Marches one cone of 30 degrees through the levels, one after the other in `texels`, front to back.
float march_cone(const hwy::float16_t* const* levels, int finest_size, const float* start, const float* direction, int steps) {
    const hn::FixedTag<float, 4> d4;
    auto seen = hn::Zero(d4);
    float distance = 1.0f, width = 1.0f, scale = 1.0f;
    int level = 0;
    for (int step = 0; step < steps; ++step) {
        const float x = start[0] + distance * direction[0], y = start[1] + distance * direction[1];
        const float z = start[2] + distance * direction[2];
        const auto fine = look_up({levels[level], finest_size >> level}, x * scale, y * scale, z * scale);
        const auto coarse =
            look_up({levels[level + 1], finest_size >> (level + 1)}, x * scale * 0.5f, y * scale * 0.5f, z * scale * 0.5f);
        const auto texel = hn::MulAdd(hn::Sub(coarse, fine), hn::Set(d4, width * scale - 1.0f), fine);
        seen = hn::MulAdd(texel, hn::Sub(hn::Set(d4, 1.0f), hn::Broadcast<3>(seen)), seen);
        distance += 0.5f * width;
        width = distance * 1.1547005f < 1.0f ? 1.0f : distance * 1.1547005f;
        while (width * scale >= 2.0f) scale *= 0.5f, ++level;
    }
    return hn::GetLane(seen);
}

int width() { return static_cast<int>(hn::Lanes(hn::ScalableTag<float>()) * sizeof(float)); }

}  // namespace interreflect::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <hwy/aligned_allocator.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "math/rng.h"
#include "math/stopwatch.h"

namespace interreflect {
namespace {

HWY_EXPORT(sum);
HWY_EXPORT(triad);
HWY_EXPORT(multiply_add);
HWY_EXPORT(march_cone);
HWY_EXPORT(width);

constexpr std::size_t piece = std::size_t{1} << 18;  // 1 MiB a task

/// Least milliseconds of `repeats` calls, after one that maps the pages.
template <class Work>
double fastest(int repeats, const Work& work) {
    work();
    double best = 1e300;
    for (int k = 0; k < repeats; ++k) {
        const Stopwatch watch;
        work();
        best = std::min(best, watch.milliseconds());
    }
    return best;
}

auto filled(std::size_t floats) {
    auto array = hwy::AllocateAligned<float>(floats);
    oneapi::tbb::parallel_for(std::size_t{0}, floats / piece,
                              [&](std::size_t p) { std::fill_n(array.get() + p * piece, piece, 1.0f); });
    return array;
}

std::atomic<float> sink;  // keeps results alive

}  // namespace

double read_bandwidth(int repeats, std::size_t floats) {
    const auto array = filled(floats);
    const double best = fastest(repeats, [&] {
        oneapi::tbb::parallel_for(std::size_t{0}, floats / piece,
                                  [&](std::size_t p) { sink = HWY_DYNAMIC_DISPATCH(sum)(array.get() + p * piece, piece); });
    });
    return 4.0 * static_cast<double>(floats) / best * 1e-6;
}

double triad_bandwidth(int repeats, std::size_t floats) {
    const auto a = filled(floats), b = filled(floats), c = filled(floats);
    const double best = fastest(repeats, [&] {
        oneapi::tbb::parallel_for(std::size_t{0}, floats / piece, [&](std::size_t p) {
            HWY_DYNAMIC_DISPATCH(triad)(a.get() + p * piece, b.get() + p * piece, c.get() + p * piece, piece);
        });
    });
    return 3 * 4.0 * static_cast<double>(floats) / best * 1e-6;
}

double multiply_add_rate(int repeats) {
    constexpr std::size_t steps = 200'000;
    const int tasks = 16 * oneapi::tbb::this_task_arena::max_concurrency();
    const double best = fastest(
        repeats, [&] { oneapi::tbb::parallel_for(0, tasks, [&](int) { sink = HWY_DYNAMIC_DISPATCH(multiply_add)(steps); }); });
    const int lanes = vector_bytes() / 4;
    return 2.0 * 12 * steps * tasks * lanes / best * 1e-6;
}

double cone_step_rate(int repeats) {
    constexpr int size = 128, level_count = 8, steps = 9, cones = 1 << 13;
    const std::size_t halves = std::size_t{4} * size * size * (size + 1) * 8 / 7 + 4 * size * size;
    const auto texels = hwy::AllocateAligned<hwy::float16_t>(halves);
    std::memset(texels.get(), 0, halves * sizeof(hwy::float16_t));  // air: no cone ends early
    const hwy::float16_t* levels[level_count];
    for (std::size_t level = 0, first = 0; level < level_count; ++level) {
        levels[level] = texels.get() + first;
        const std::size_t n = size >> level;
        first += 4 * n * n * (n + 1);
    }
    const int tasks = 16 * oneapi::tbb::this_task_arena::max_concurrency();
    const double best = fastest(repeats, [&] {
        oneapi::tbb::parallel_for(0, tasks, [&](int task) {
            float sum = 0;
            Rng rng(1, static_cast<std::uint32_t>(task));
            float start[3], direction[3];
            for (int cone = 0; cone < cones; ++cone) {
                // Thirty-two neighbours start side by side and look the same way, as those of a tile of pixels do.
                for (int k = 0; k < 3; ++k) {
                    start[k] = cone % 32 == 0 ? size * rng.uniform() : start[k] + 0.1f;
                    if (cone % 32 == 0) direction[k] = rng.uniform() - 0.5f;
                }
                sum += HWY_DYNAMIC_DISPATCH(march_cone)(levels, size, start, direction, steps);
            }
            sink = sum;
        });
    });
    return 1e-3 * steps * cones * tasks / best;
}

int vector_bytes() { return HWY_DYNAMIC_DISPATCH(width)(); }

}  // namespace interreflect
#endif
