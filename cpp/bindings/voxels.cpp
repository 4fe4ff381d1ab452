/// Room voxels: where the grid stands, and the voxels until they are ready to be marched.
#include "voxels/grid.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <string>
#include <variant>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "bindings/technique.h"
#include "voxels/light_voxels.h"
#include "voxels/move_voxels.h"
#include "voxels/prefilter.h"
#include "voxels/voxelize.h"

namespace interreflect::bindings {
namespace {

using Int3 = std::array<int, 3>;
using Float3 = std::array<float, 3>;

Int3 array3(const ivec3& v) { return {v.x, v.y, v.z}; }

Domain make_domain(Float3 lower, float voxel_size, Int3 cells) {
    for (const float v : lower)
        if (!std::isfinite(v)) throw py::value_error("lower must be finite");
    if (!std::isfinite(voxel_size) || !(voxel_size > 0.0f)) throw py::value_error("voxel_size must be finite and above 0");
    for (const int n : cells)
        if (n < 1 || n > 1024) throw py::value_error("cells must lie in [1, 1024], got " + std::to_string(n));
    return {vector3(lower), voxel_size, {cells[0], cells[1], cells[2]}};
}

/// Maps (n, 3) points one by one.
template <class Map>
py::array_t<float> map_points(const py::array_t<float, py::array::c_style | py::array::forcecast>& points, const Map& map) {
    if (points.ndim() != 2 || points.shape(1) != 3) throw py::value_error("points must have the shape (n, 3)");
    py::array_t<float> mapped({points.shape(0), py::ssize_t{3}});
    const auto* in = reinterpret_cast<const vec3*>(points.data());
    auto* out = reinterpret_cast<vec3*>(mapped.mutable_data());
    for (py::ssize_t i = 0; i < points.shape(0); ++i) out[i] = map(in[i]);
    return mapped;
}

int checked_cascade(const Domain& domain, int cascade) {
    if (cascade < 0 || cascade >= domain.cascades)
        throw py::index_error("cascade must lie in [0, " + std::to_string(domain.cascades) + "), got " + std::to_string(cascade));
    return cascade;
}

void bind_maps(py::class_<Domain>& cls) {
    cls.def(
           "to_voxels",
           [](const Domain& d, const py::array_t<float, py::array::c_style | py::array::forcecast>& points) {
               return map_points(points, [&](const vec3& p) { return d.to_voxels(p); });
           },
           py::arg("points"),
           "(n, 3) voxel coordinates of (n, 3) points in world space: cells are their integer parts. Of nested grids, those in "
           "the "
           "finest that holds the point.")
        .def(
            "to_world",
            [](const Domain& d, const py::array_t<float, py::array::c_style | py::array::forcecast>& voxels, int cascade) {
                checked_cascade(d, cascade);
                return map_points(voxels, [&](const vec3& q) { return d.to_world(VoxelPlace{cascade, q}); });
            },
            py::arg("voxels"), py::arg("cascade") = 0, "(n, 3) points in world space of (n, 3) voxel coordinates in one grid.")
        .def(
            "density",
            [](const Domain& d, const py::array_t<float, py::array::c_style | py::array::forcecast>& points) {
                if (points.ndim() != 2 || points.shape(1) != 3) throw py::value_error("points must have the shape (n, 3)");
                py::array_t<float> densities({points.shape(0), py::ssize_t{3}, py::ssize_t{3}});
                const auto* in = reinterpret_cast<const vec3*>(points.data());
                auto* out = reinterpret_cast<mat3*>(densities.mutable_data());
                for (py::ssize_t i = 0; i < points.shape(0); ++i)
                    out[i] = glm::transpose(d.density(d.to_linear(in[i]))) * (1.0f / d.voxel_size);
                return densities;
            },
            py::arg("points"),
            "(n, 3, 3): voxels a unit of world space at (n, 3) points; row i, column j: of voxel axis i along world axis j.");
}

void bind_domain(py::module_& m) {
    py::class_<Domain> domain(m, "Domain", "A box of voxels in world space: evenly spread, warped, or nested grids.");
    domain
        .def(py::init(&make_domain), py::kw_only(), py::arg("lower"), py::arg("voxel_size"), py::arg("cells"),
             "Cubic voxels, evenly spread.")
        .def_property_readonly(
            "lower", [](const Domain& d) { return bindings::array3(d.lower); },
            "Lower corner, world space; of a view volume, the eye.")
        .def_property_readonly(
            "upper", [](const Domain& d) { return bindings::array3(d.upper()); }, "Upper corner, world space.")
        .def_readonly("voxel_size", &Domain::voxel_size, "Edge of a voxel of the finest grid before it is warped, world space.")
        .def_property_readonly(
            "cells", [](const Domain& d) { return array3(d.cells); }, "Voxels along x, y, z of each grid.")
        .def_readonly("cascades", &Domain::cascades, "How many nested grids.")
        .def_property_readonly("plain", &Domain::plain, "Whether voxels are cubes of one size.")
        .def("__eq__", [](const Domain& a, const py::object& b) { return py::isinstance<Domain>(b) && a == b.cast<Domain>(); })
        .def("__repr__", [](const Domain& d) {
            std::string text = "Domain(lower=" + py::repr(py::cast(bindings::array3(d.lower))).cast<std::string>() +
                               ", voxel_size=" + py::repr(py::float_(d.voxel_size)).cast<std::string>() +
                               ", cells=" + py::repr(py::cast(array3(d.cells))).cast<std::string>();
            if (d.cascades > 1) text += ", cascades=" + std::to_string(d.cascades);
            if (d.warp.kind != Warp::Kind::linear) text += ", warped";
            return text + ")";
        });
    bind_maps(domain);
    bind_stage(m, "warp", "How are a grid's voxels spread over space?", false, static_cast<WarpTechnique*>(nullptr));
    bind_stage(m, "region", "Which part of space do the voxels cover?", false, static_cast<Region*>(nullptr));
    const py::object grid = bind_technique<Grid>(m);
    grid.attr("place") = py::cpp_function(
        [](const py::object& self, const py::object& scene, const py::object& camera, const py::object& size) {
            return py::module_::import("interreflect.stages").attr("place")(self, scene, camera, size);
        },
        py::name("place"), py::is_method(grid), py::arg("scene"), py::arg("camera") = py::none(), py::arg("size") = py::none(),
        "The domain of this grid in a Scene: `interreflect.stages.place`.");
    m.def(
        "place",
        [](const Grid& technique, const BoundScene& scene, const Camera* camera, float aspect) {
            return run([&] { return place(technique, scene.scene, camera, aspect); });
        },
        py::arg("grid"), py::arg("scene"), py::arg("camera") = py::none(), py::arg("aspect") = 1.0f,
        "The domain of a grid in a scene, for a picture `aspect` times as wide as high.");
}

/// A read-only property that shows one of a value's arrays, (n, 3) or (n,), without a copy.
template <class Value, class Item, class... Options>
void array_property(py::class_<Value, Options...>& cls, const char* name, Buffer<Item> Value::*array, const char* doc) {
    cls.def_property_readonly(
        name,
        [array](const py::object& self) -> py::object {
            const Buffer<Item>& data = self.cast<const Value&>().*array;
            const auto count = static_cast<py::ssize_t>(data.size());
            if constexpr (std::is_same_v<Item, vec3>)
                return view(reinterpret_cast<const float*>(data.data()), {count, 3}, self);
            else
                return view(data.data(), {count}, self);
        },
        doc);
}

/// A rigid pose; ValueError for another matrix.
BodyPose pose_of(std::uint32_t body, const py::object& world_from_body) {
    const mat4 m = matrix4(world_from_body, "pose");
    const mat3 turn(m);
    const mat3 product = turn * glm::transpose(turn);
    for (int k = 0; k < 9; ++k)
        if (!(std::fabs(product[k / 3][k % 3] - (k % 4 == 0 ? 1.0f : 0.0f)) < 1e-4f))
            throw py::value_error("pose must be a rotation and a translation");
    return {body, turn, vec3(m[3])};
}

void bind_grid(py::module_& m) {
    py::class_<VoxelGrid, std::shared_ptr<VoxelGrid>> cls(m, "VoxelGrid",
                                                          "The voxels that the surface passes through, ascending by cell.");
    cls.def_readonly("domain", &VoxelGrid::domain).def_readonly("counts", &VoxelGrid::counts);
    cls.def("__len__", &VoxelGrid::size).def_property_readonly("bytes", &VoxelGrid::bytes, "Memory the arrays hold.");
    array_property(cls, "cell", &VoxelGrid::cell, "(n,) uint32: x + cells[0] (y + cells[1] z).");
    array_property(cls, "albedo", &VoxelGrid::albedo, "(n, 3): mean diffuse reflectance.");
    array_property(cls, "normal", &VoxelGrid::normal, "(n, 3): mean normal of the front sides, unit; 0 where they cancel.");
    array_property(cls, "emission", &VoxelGrid::emission, "(n, 3): mean radiance that the front emits, W/(m^2 sr).");
    array_property(cls, "position", &VoxelGrid::position, "(n, 3): mean position of the surface, world space.");
    array_property(cls, "opacity", &VoxelGrid::opacity, "(n,): solid share of the surface, below 1 where a mask has holes.");
    array_property(cls, "area", &VoxelGrid::area,
                   "(n,): area of the solid surface inside, in faces of an unwarped voxel of the finest grid.");
    cls.def_property_readonly(
           "body", [](const VoxelGrid& grid) { return grid.pose.body; },
           "Number of the body whose voxels these are, in its own space; 0: the world.")
        .def(
            "moved",
            [](const VoxelGrid& grid, std::uint32_t body, const py::object& pose) {
                if (grid.pose.body == 0 || body == 0) throw py::value_error("only voxels of a body can move");
                const BodyPose to = pose_of(body, pose);
                return run([&] { return std::make_shared<VoxelGrid>(move_voxels(grid, to)); });
            },
            py::arg("body"), py::arg("pose"),
            "The voxels with their body, or a copy of it numbered `body`, at the (4, 4) pose `world_from_body`.");
    cls.def_property_readonly(
        "coordinates",
        [](const VoxelGrid& grid) {
            py::array_t<std::int32_t> array({static_cast<py::ssize_t>(grid.size()), py::ssize_t{3}});
            auto out = array.mutable_unchecked<2>();
            for (std::size_t i = 0; i < grid.size(); ++i) {
                const ivec3 at = grid.domain.coordinates(grid.cell[i]);
                for (int axis = 0; axis < 3; ++axis) out(static_cast<py::ssize_t>(i), axis) = at[axis];
            }
            return array;
        },
        "(n, 3) int32: x, y, z of each voxel (a copy).");
    py::class_<LitVoxels, std::shared_ptr<LitVoxels>> lit(m, "LitVoxels", "Radiance that each voxel reflects.");
    lit.def_readonly("counts", &LitVoxels::counts).def_property_readonly("bytes", &LitVoxels::bytes, "Memory the arrays hold.");
    lit.def_property_readonly(
        "voxels", [](const LitVoxels& self) { return std::const_pointer_cast<VoxelGrid>(self.grid); },
        "The voxels that are lit.");
    array_property(lit, "radiance", &LitVoxels::radiance, "(n, 3): leaving the front, W/(m^2 sr).");
    array_property(lit, "back", &LitVoxels::back, "(n, 3): leaving the back; (0, 3) where only the front was lit.");
}

/// IEEE half to float.
float half_to_float(std::uint16_t h) {
    const std::uint32_t exponent = (h >> 10) & 31U, mantissa = h & 1023U;
    const float magnitude = exponent == 0    ? std::ldexp(static_cast<float>(mantissa), -24)
                            : exponent == 31 ? std::numeric_limits<float>::infinity()
                                             : std::ldexp(static_cast<float>(mantissa + 1024U), static_cast<int>(exponent) - 25);
    return (h & 0x8000U) != 0 ? -magnitude : magnitude;
}

py::array_t<float> read_level(const Pyramid& pyramid, int index, int face) {
    if (index < 0 || index >= static_cast<int>(pyramid.levels.size()))
        throw py::index_error("level must lie in [0, " + std::to_string(pyramid.levels.size()) + "), got " +
                              std::to_string(index));
    const Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(index)];
    if (face < 0 || face >= pyramid.faces)
        throw py::index_error("face must lie in [0, " + std::to_string(pyramid.faces) + "), got " + std::to_string(face));
    py::array_t<float> array({level.size.z, level.size.y, level.size.x, 4});
    float* out = array.mutable_data();
    for (int z = 0; z < level.size.z; ++z)
        for (int y = 0; y < level.size.y; ++y)
            for (int x = 0; x < level.size.x; ++x) {
                const std::uint16_t* texel = &level.texels[4 * level.index(x, y, z, level.faces == 1 ? 0 : face)];
                for (int channel = 0; channel < 4; ++channel)
                    *out++ = half_to_float(texel[channel]) * (channel < 3 ? pyramid.scale : 1.0f);
            }
    return array;
}

void bind_pyramid(py::module_& m) {
    py::class_<Pyramid, std::shared_ptr<Pyramid>>(m, "Pyramid", "Radiance and opacity of ever larger voxels, as half floats.")
        .def_readonly("domain", &Pyramid::domain)
        .def_property_readonly(
            "body", [](const Pyramid& p) { return p.pose.body; }, "Number of the body it is of; 0: the world.")
        .def_readonly("counts", &Pyramid::counts)
        .def_readonly("faces", &Pyramid::faces, "1, or 6 from the second level on: seen through -x +x -y +y -z +z.")
        .def_readonly("scale", &Pyramid::scale, "Radiance of a stored 1.")
        .def_property_readonly(
            "lit", [](const Pyramid& p) { return std::const_pointer_cast<LitVoxels>(p.lit); }, "The voxels it was made from.")
        .def_property_readonly(
            "levels", [](const Pyramid& p) { return p.levels.size(); }, "How many levels; the last is one texel.")
        .def_property_readonly("bytes", &Pyramid::bytes, "Memory the levels hold.")
        .def(
            "level", &read_level, py::arg("index"), py::arg("face") = 0,
            "(z, y, x, 4) float32, a copy: radiance premultiplied by opacity in W/(m^2 sr), and opacity. 0 is the finest level.");
}

/// The part of a scene that is one body's, in its own space where `pose` has it now; without a body, all of it.
Scene part_of(const BoundScene& whole, const std::optional<std::uint32_t>& body, const py::object& pose) {
    Scene part = whole.scene;
    if (!body) return part;
    const mat4 world_from_body = pose.is_none() ? mat4(1.0f) : matrix4(pose, "pose");
    part.geometry = part_of_geometry(*part.geometry, *body, glm::inverse(world_from_body));
    return part;
}

VoxelHistory history_of(
    const std::variant<std::monostate, std::shared_ptr<const Pyramid>, std::shared_ptr<const LitVoxels>>& given) {
    if (const auto* pyramid = std::get_if<1>(&given)) return {(*pyramid)->lit, *pyramid};
    if (const auto* lit = std::get_if<2>(&given)) return {*lit, nullptr};
    return {};
}

}  // namespace

void bind_voxels(py::module_& m) {
    bind_domain(m);
    bind_grid(m);
    bind_pyramid(m);
    bind_stage(m, "voxelize", "Which cells of a grid does the scene's surface pass through, and what does it look like there?",
               true, static_cast<Voxelize*>(nullptr));
    bind_stage(m, "light_voxels", "Which radiance does the surface in each voxel reflect from the lights?", true,
               static_cast<LightVoxels*>(nullptr));
    bind_stage(m, "prefilter", "What does a box of voxels look like from afar?", false, static_cast<Prefilter*>(nullptr));
    m.def(
        "voxelize",
        [](const Voxelize& technique, const BoundScene& whole, const Domain& domain, const std::optional<std::uint32_t>& body,
           const py::object& pose) {
            const Scene scene = part_of(whole, body, pose);
            return run([&] {
                auto voxels =
                    std::make_shared<VoxelGrid>(std::visit([&](const auto& t) { return voxelize(t, scene, domain); }, technique));
                voxels->pose.body = body.value_or(0);
                return voxels;
            });
        },
        py::arg("technique"), py::arg("scene"), py::arg("domain"), py::arg("body") = py::none(), py::arg("pose") = py::none(),
        "The voxels of the scene's surface; or of one body in its own space, which `pose` brings to the world (0: of what stands "
        "still).");
    m.def(
        "light_voxels",
        [](const LightVoxels& technique, const BoundScene& scene, std::shared_ptr<const VoxelGrid> voxels, std::uint32_t seed,
           const std::variant<std::monostate, std::shared_ptr<const Pyramid>, std::shared_ptr<const LitVoxels>>& history,
           const std::vector<std::shared_ptr<VoxelGrid>>& others) {
            const LightingTask task{scene.scene, *scene.intersector,  *scene.lights, voxels,
                                    voxels,      history_of(history), seed,          {others.begin(), others.end()}};
            return run([&] {
                return std::visit([&](const auto& t) { return std::make_shared<LitVoxels>(light_voxels(t, task)); }, technique);
            });
        },
        py::arg("technique"), py::arg("scene"), py::arg("voxels"), py::arg("seed") = 0, py::arg("history") = py::none(),
        py::arg("others") = py::list(),
        "The radiance that each voxel reflects. others: voxels of the scene's other parts. history: the last frame's LitVoxels, "
        "or the Pyramid made from them.");
    m.def(
        "prefilter",
        [](const Prefilter& technique, std::shared_ptr<const LitVoxels> lit) {
            return run([&] {
                auto pyramid =
                    std::make_shared<Pyramid>(std::visit([&](const auto& t) { return prefilter(t, *lit); }, technique));
                pyramid->lit = lit;
                return pyramid;
            });
        },
        py::arg("technique"), py::arg("lit"), "Radiance and opacity of ever larger voxels.");
}

}  // namespace interreflect::bindings
