/// The peer of the bench: Embree alone, as fast as its own tutorials make it, timed inside. A Python module, so that one program
/// measures the peer and ours in turn.
#include <embree3/rtcore.h>
#include <oneapi/tbb/parallel_for.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "bench/ray_calls.h"
#include "data/camera.h"
#include "math/stopwatch.h"

namespace {
namespace py = pybind11;
using namespace interreflect;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

constexpr int lanes = 16;
constexpr int tile = 16, side = 4;

struct alignas(64) Valid {
    int lane[lanes];
};

/// A scene of solid triangles in a device of its own.
class EmbreePeer {
  public:
    EmbreePeer(const Array<float>& positions, const Array<std::uint32_t>& triangles)
        : device_(rtcNewDevice(nullptr)),
          positions_(positions.data(), positions.data() + positions.size()),
          triangles_(triangles.data(), triangles.data() + triangles.size()) {
        positions_.reserve(positions_.size() + 4);
        build();
    }
    ~EmbreePeer() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreePeer(const EmbreePeer&) = delete;
    EmbreePeer& operator=(const EmbreePeer&) = delete;

    /// Milliseconds to build the hierarchy (medium quality).
    double build() {
        if (scene_ != nullptr) rtcReleaseScene(scene_);
        const Stopwatch watch;
        scene_ = rtcNewScene(device_);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0, 12,
                                   positions_.size() / 3);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles_.data(), 0, 12,
                                   triangles_.size() / 3);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        return watch.milliseconds();
    }

    /// Milliseconds for the primary rays of a picture, 16 wide, filled inside the clock; keeps distance and triangle.
    double primary(const Camera& camera, int width, int height) {
        const CameraRays rays(camera, width, height);
        depth_.resize(static_cast<std::size_t>(width) * height);
        triangle_.resize(depth_.size());
        const Stopwatch watch;
        const int columns = (width + tile - 1) / tile, rows = (height + tile - 1) / tile;
        oneapi::tbb::parallel_for(0, columns * rows, [&](int t) {
            const int x0 = t % columns * tile, y0 = t / columns * tile;
            for (int y = y0; y < std::min(y0 + tile, height); y += side)
                for (int x = x0; x < std::min(x0 + tile, width); x += side) primary_packet(rays, x, y);
        });
        return watch.milliseconds();
    }

    /// Milliseconds for one shadow ray from each of the given origins (n, 3), 16 wide, neighbours side by side.
    double shadow(const Array<float>& origins, const Array<float>& direction) {
        const float* o = origins.data();
        const float* d = direction.data();
        const auto count = static_cast<std::size_t>(origins.shape(0));
        blocked_.resize(count);
        const Stopwatch watch;
        oneapi::tbb::parallel_for(std::size_t{0}, (count + lanes - 1) / lanes, [&](std::size_t packet) {
            RTCRay16 ray;
            Valid valid;
            const std::size_t first = packet * lanes;
            for (int k = 0; k < lanes; ++k) {
                const std::size_t i = std::min(first + k, count - 1);
                valid.lane[k] = first + k < count ? -1 : 0;
                ray.org_x[k] = o[3 * i], ray.org_y[k] = o[3 * i + 1], ray.org_z[k] = o[3 * i + 2];
                ray.dir_x[k] = d[0], ray.dir_y[k] = d[1], ray.dir_z[k] = d[2];
                ray.tnear[k] = 0, ray.tfar[k] = std::numeric_limits<float>::infinity();
                ray.time[k] = 0, ray.mask[k] = ~0U, ray.flags[k] = 0;
            }
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
            rtcOccluded16(valid.lane, scene_, &context, &ray);
            for (int k = 0; k < lanes && first + k < count; ++k) blocked_[first + k] = ray.tfar[k] < 0;
        });
        return watch.milliseconds();
    }

    /// Milliseconds for any rays (n, 3) by one of Embree's calls: width 1, 8, 16, or 256 for a stream.
    double trace(const Array<float>& origins, const Array<float>& directions, int width, bool any_hit, bool coherent) {
        if (origins.ndim() != 2 || origins.shape(1) != 3 || directions.size() != origins.size())
            throw std::invalid_argument("origins and directions must both be (n, 3)");
        const bench::RayList rays{origins.data(), directions.data(), static_cast<std::size_t>(origins.shape(0))};
        return bench::trace(scene_, rays, width, any_hit, coherent);
    }

  private:
    void primary_packet(const CameraRays& rays, int x0, int y0) {
        RTCRayHit16 query;
        Valid valid;
        for (int k = 0; k < lanes; ++k) {
            const int x = x0 + k % side, y = y0 + k / side;
            valid.lane[k] = x < rays.width && y < rays.height ? -1 : 0;
            const vec3 d = rays.direction(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            query.ray.org_x[k] = rays.origin.x, query.ray.org_y[k] = rays.origin.y, query.ray.org_z[k] = rays.origin.z;
            query.ray.dir_x[k] = d.x, query.ray.dir_y[k] = d.y, query.ray.dir_z[k] = d.z;
            query.ray.tnear[k] = 0, query.ray.tfar[k] = std::numeric_limits<float>::infinity();
            query.ray.time[k] = 0, query.ray.mask[k] = ~0U, query.ray.flags[k] = 0;
            query.hit.geomID[k] = query.hit.instID[0][k] = query.hit.primID[k] = RTC_INVALID_GEOMETRY_ID;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcIntersect16(valid.lane, scene_, &context, &query);
        for (int k = 0; k < lanes; ++k) {
            const int x = x0 + k % side, y = y0 + k / side;
            if (valid.lane[k] == 0) continue;
            depth_[static_cast<std::size_t>(y) * rays.width + x] = query.ray.tfar[k];
            triangle_[static_cast<std::size_t>(y) * rays.width + x] = query.hit.primID[k];
        }
    }

    RTCDevice device_;
    RTCScene scene_ = nullptr;
    std::vector<float> positions_;
    std::vector<std::uint32_t> triangles_;
    std::vector<float> depth_;
    std::vector<std::uint32_t> triangle_;
    std::vector<std::uint8_t> blocked_;
};

}  // namespace

PYBIND11_MODULE(_peers, m) {
    m.doc() = "Embree alone, timed inside: the peer of the bench.";
    py::class_<EmbreePeer>(m, "EmbreePeer")
        .def(py::init<const Array<float>&, const Array<std::uint32_t>&>(), py::arg("positions"), py::arg("triangles"))
        .def("build", &EmbreePeer::build, "Milliseconds to build the hierarchy, medium quality.")
        .def(
            "primary",
            [](EmbreePeer& self, const std::array<float, 3>& position, const std::array<float, 3>& target,
               const std::array<float, 3>& up, float fov_x, int width, int height) {
                const auto vector = [](const std::array<float, 3>& v) { return vec3(v[0], v[1], v[2]); };
                return self.primary({vector(position), vector(target), vector(up), fov_x}, width, height);
            },
            py::arg("position"), py::arg("target"), py::arg("up"), py::arg("fov_x"), py::arg("width"), py::arg("height"),
            "Milliseconds for the primary rays of a picture, 16 wide.")
        .def("shadow", &EmbreePeer::shadow, py::arg("origins"), py::arg("direction"),
             "Milliseconds for one shadow ray from each origin (n, 3), 16 wide.")
        .def("trace", &EmbreePeer::trace, py::arg("origins"), py::arg("directions"), py::arg("width"), py::arg("any_hit"),
             py::arg("coherent"), "Milliseconds for rays (n, 3) by one of Embree's calls: width 1, 8, 16, or 256 for a stream.");
}
