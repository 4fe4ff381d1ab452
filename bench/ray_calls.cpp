#include "bench/ray_calls.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "math/stopwatch.h"

namespace interreflect::bench {
namespace {

/// Embree's packet of N rays with hits: the fields of RTCRayHit8 and RTCRayHit16, and one call that takes either.
template <int N>
using Packet = std::conditional_t<N == 8, RTCRayHit8, RTCRayHit16>;

void call(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit8* rays, bool any_hit) {
    any_hit ? rtcOccluded8(valid, scene, context, &rays->ray) : rtcIntersect8(valid, scene, context, rays);
}
void call(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit16* rays, bool any_hit) {
    any_hit ? rtcOccluded16(valid, scene, context, &rays->ray) : rtcIntersect16(valid, scene, context, rays);
}

struct Task {
    RTCScene scene;
    const RayList& rays;
    bool any_hit;
    RTCIntersectContext context;
    float* distance;
};

RTCRay one_ray(const RayList& rays, std::size_t i) {
    const float *o = rays.origins + 3 * i, *d = rays.directions + 3 * i;
    return {o[0], o[1], o[2], 0, d[0], d[1], d[2], 0, std::numeric_limits<float>::infinity(), ~0U, 0, 0};
}

RTCRayHit one_query(const RayList& rays, std::size_t i) {
    RTCRayHit query{};
    query.ray = one_ray(rays, i);
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return query;
}

void trace_singly(Task& task, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
        RTCRayHit query = one_query(task.rays, i);
        task.any_hit ? rtcOccluded1(task.scene, &task.context, &query.ray) : rtcIntersect1(task.scene, &task.context, &query);
        task.distance[i] = query.ray.tfar;
    }
}

template <int N>
void trace_packets(Task& task, std::size_t first, std::size_t last) {
    for (std::size_t start = first; start < last; start += N) {
        alignas(64) int valid[N];
        Packet<N> query;
        for (int k = 0; k < N; ++k) {
            const std::size_t i = std::min(start + k, last - 1);
            const float *o = task.rays.origins + 3 * i, *d = task.rays.directions + 3 * i;
            valid[k] = start + k < last ? -1 : 0;
            query.ray.org_x[k] = o[0], query.ray.org_y[k] = o[1], query.ray.org_z[k] = o[2];
            query.ray.dir_x[k] = d[0], query.ray.dir_y[k] = d[1], query.ray.dir_z[k] = d[2];
            query.ray.tnear[k] = 0, query.ray.tfar[k] = std::numeric_limits<float>::infinity();
            query.ray.time[k] = 0, query.ray.mask[k] = ~0U, query.ray.flags[k] = 0;
            query.hit.geomID[k] = query.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        call(valid, task.scene, &task.context, &query, task.any_hit);
        for (int k = 0; k < N && start + k < last; ++k) task.distance[start + k] = query.ray.tfar[k];
    }
}

void trace_streams(Task& task, std::size_t first, std::size_t last) {
    RTCRay occlusion[stream_rays];
    RTCRayHit nearest[stream_rays];
    const auto count = static_cast<unsigned>(last - first);
    for (unsigned k = 0; k < count; ++k)
        if (task.any_hit)
            occlusion[k] = one_ray(task.rays, first + k);
        else
            nearest[k] = one_query(task.rays, first + k);
    task.any_hit ? rtcOccluded1M(task.scene, &task.context, occlusion, count, sizeof(RTCRay))
                 : rtcIntersect1M(task.scene, &task.context, nearest, count, sizeof(RTCRayHit));
    for (unsigned k = 0; k < count; ++k) task.distance[first + k] = task.any_hit ? occlusion[k].tfar : nearest[k].ray.tfar;
}

}  // namespace

double trace(RTCScene scene, const RayList& rays, int width, bool any_hit, bool coherent) {
    if (width != 1 && width != 8 && width != 16 && width != stream_rays)
        throw std::invalid_argument("width must be 1, 8, 16 or 256, got " + std::to_string(width));
    std::vector<float> distance(rays.count);
    const Stopwatch watch;
    oneapi::tbb::parallel_for(std::size_t{0}, (rays.count + stream_rays - 1) / stream_rays, [&](std::size_t block) {
        const std::size_t first = block * stream_rays, last = std::min(first + stream_rays, rays.count);
        Task task{scene, rays, any_hit, {}, distance.data()};
        rtcInitIntersectContext(&task.context);
        task.context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        if (width == 1) trace_singly(task, first, last);
        if (width == 8) trace_packets<8>(task, first, last);
        if (width == 16) trace_packets<16>(task, first, last);
        if (width == stream_rays) trace_streams(task, first, last);
    });
    return watch.milliseconds();
}

}  // namespace interreflect::bench
