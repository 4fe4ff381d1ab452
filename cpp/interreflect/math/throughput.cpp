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

int width() { return static_cast<int>(hn::Lanes(hn::ScalableTag<float>()) * sizeof(float)); }

}  // namespace interreflect::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <hwy/aligned_allocator.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "math/stopwatch.h"

namespace interreflect {
namespace {

HWY_EXPORT(sum);
HWY_EXPORT(triad);
HWY_EXPORT(multiply_add);
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
    return 2.0 * 12 * steps * tasks * (vector_bytes() / 4) / best * 1e-6;
}

int vector_bytes() { return HWY_DYNAMIC_DISPATCH(width)(); }

}  // namespace interreflect
#endif
