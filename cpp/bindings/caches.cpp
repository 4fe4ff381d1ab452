/// Room caches: distribute, fill, preconvolve, interpolate.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>

#include "bindings/arrays.h"
#include "bindings/pyramids.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "bindings/technique.h"
#include "caches/distribute.h"
#include "caches/fill.h"
#include "caches/interpolate.h"
#include "caches/preconvolve.h"
#include "math/hemisphere_map.h"

namespace interreflect::bindings {
namespace {

using SharedPyramids = std::vector<std::shared_ptr<const Pyramid>>;

/// Half floats, four a texel.
py::array halves(const Buffer<std::uint16_t>& data, std::vector<py::ssize_t> shape, const py::object& owner) {
    auto bits = view(data.data(), std::move(shape), owner);
    return bits.attr("view")(py::dtype("float16"));
}

void bind_places(py::module_& m) {
    using Places = CachePlaces;
    py::class_<Places, std::shared_ptr<Places>> cls(m, "CachePlaces",
                                                    "Where radiance caches stand, tile by tile; n caches in parallel arrays.");
    const auto three = [&cls](const char* name, Buffer<vec3> Places::*member, const char* doc) {
        cls.def_property_readonly(
            name, [member](const py::object& self) { return vectors(self.cast<const Places&>().*member, self); }, doc);
    };
    const auto count = [&cls](const char* name, Buffer<std::uint32_t> Places::*member, const char* doc) {
        cls.def_property_readonly(
            name, [member](const py::object& self) { return numbers(self.cast<const Places&>().*member, self); }, doc);
    };
    three("position", &Places::position, "(n, 3): of the surface, world space.");
    three("normal", &Places::normal, "(n, 3): unit, the axis of the cache's hemisphere.");
    cls.def_property_readonly(
        "screen", [](const py::object& self) { return vectors(self.cast<const Places&>().screen, self); },
        "(n, 2): where each is seen, pixels from the upper left corner.");
    cls.def_property_readonly(
        "footprint", [](const py::object& self) { return numbers(self.cast<const Places&>().footprint, self); },
        "(n,): how long a tile is on the surface there, scene units.");
    count("pixel", &Places::pixel, "(n,): the pixel where it stands, row * width + column.");
    count("members", &Places::members, "(n,): pixels of its cluster.");
    count("body", &Places::body, "(n,): of the surface; 0 is the world.");
    cls.def_property_readonly(
        "age",
        [](const py::object& self) -> py::object {
            const auto& places = self.cast<const Places&>();
            return places.track ? py::object(numbers(places.track->age, self)) : py::none();
        },
        "(n,): for how many frames each was kept; 0: placed in this one. None but for ReuseCaches.");
    cls.def_property_readonly(
        "cluster",
        [](const py::object& self) {
            const auto& places = self.cast<const Places&>();
            return image_view(places.cluster, places.width, places.height, self);
        },
        "(height, width): the cache of each pixel's cluster; 2^32 - 1 where nothing was hit, or none stands.");
    cls.def("__len__", &Places::size)
        .def_readonly("tile", &Places::tile, "Side of the tiles, pixels.")
        .def_readonly("columns", &Places::columns)
        .def_readonly("rows", &Places::rows)
        .def_readonly("counts", &Places::counts)
        .def_property_readonly("bytes", &Places::bytes);
}

void bind_filled(py::module_& m) {
    py::class_<FilledCaches, std::shared_ptr<FilledCaches>>(
        m, "FilledCaches",
        "The radiance that arrives at caches: a hemisphere map each, of equal solid angles (hemisphere_direction).")
        .def_property_readonly(
            "texels",
            [](const py::object& self) {
                const auto& filled = self.cast<const FilledCaches&>();
                const auto n = static_cast<py::ssize_t>(filled.resolution);
                return halves(filled.texels, {static_cast<py::ssize_t>(filled.places->size()), n, n, 4}, self);
            },
            "(n, resolution, resolution, 4) float16: mean radiance over `scale`, and which share of the texel is open.")
        .def_readonly("resolution", &FilledCaches::resolution)
        .def_readonly("scale", &FilledCaches::scale)
        .def_property_readonly("places",
                               [](const FilledCaches& self) { return std::const_pointer_cast<CachePlaces>(self.places); })
        .def_readonly("counts", &FilledCaches::counts)
        .def_property_readonly("bytes", &FilledCaches::bytes);
}

void bind_convolved(py::module_& m) {
    py::class_<ConvolvedCaches, std::shared_ptr<ConvolvedCaches>>(m, "ConvolvedCaches", "Caches ready for lobes of every width.")
        .def_property_readonly(
            "levels",
            [](const py::object& self) {
                const auto& caches = self.cast<const ConvolvedCaches&>();
                const auto n = static_cast<py::ssize_t>(caches.filled->places->size());
                py::list levels;
                const py::array chain = halves(caches.light.chain, {n, caches.chain_texels, 4}, self);
                for (int i = 1; i < caches.levels(); ++i) {
                    const int size = caches.level_sizes[i], begin = caches.level_begins[i];
                    const py::slice part(begin, begin + size * size, 1);
                    levels.append(chain[py::make_tuple(py::slice(0, n, 1), part)].attr("reshape")(n, size, size, 4));
                }
                return py::tuple(levels);
            },
            "Level 1 and on of every cache: (n, size, size, 4) float16 each.")
        .def_property_readonly(
            "table",
            [](const py::object& self) {
                const auto& caches = self.cast<const ConvolvedCaches&>();
                const auto n = static_cast<py::ssize_t>(caches.filled->places->size()), size = py::ssize_t{caches.table_size};
                return halves(caches.light.table, {n, size, size, 4}, self);
            },
            "(n, table, table, 4) float16: mean over the cosine lobe about each texel's direction.")
        .def_property_readonly("filled",
                               [](const ConvolvedCaches& self) { return std::const_pointer_cast<FilledCaches>(self.filled); })
        .def_readonly("counts", &ConvolvedCaches::counts)
        .def_property_readonly("bytes", &ConvolvedCaches::bytes);
}

void bind_cache_light(py::module_& m) {
    py::class_<CacheLight, std::shared_ptr<CacheLight>>(m, "CacheLight", "Light that pixels get from caches.")
        .def_property_readonly(
            "gathered",
            [](const std::shared_ptr<CacheLight>& self) { return std::shared_ptr<GatheredLight>(self, &self->gathered); },
            "What arrives over the hemisphere, as `march` returns it.")
        .def_property_readonly(
            "glossy", [](const std::shared_ptr<CacheLight>& self) { return std::shared_ptr<GlossyLight>(self, &self->glossy); },
            "What the glossy lobe reflects, as `glossy` returns it.")
        .def_property_readonly(
            "weight",
            [](const py::object& self) {
                const auto& light = self.cast<const CacheLight&>();
                return image_view(light.weight, light.gathered.width, light.gathered.height, self);
            },
            "(height, width): sum of the caches' weights; 0 where nothing was hit. Of a pixel without one, that of what lit it.")
        .def_readonly("counts", &CacheLight::counts)
        .def_property_readonly("bytes", &CacheLight::bytes);
}

void bind_stages(py::module_& m) {
    bind_stage(m, "distribute", "Where in the picture radiance caches stand.", true, static_cast<const Distribute*>(nullptr));
    bind_stage(m, "fill", "The radiance that arrives at every cache.", true, static_cast<const Fill*>(nullptr));
    bind_stage(m, "preconvolve", "From a cache's radiance to its mean over lobes of any width.", true,
               static_cast<const Preconvolve*>(nullptr));
    bind_stage(m, "interpolate", "What pixels receive and reflect, from the caches around them.", true,
               static_cast<const Interpolate*>(nullptr));
}

void bind_functions(py::module_& m) {
    m.def(
        "distribute",
        [](const Distribute& technique, const GBuffer& gbuffer, const BoundScene& s, const CachePlaces* last) {
            return run([&] {
                return std::make_shared<CachePlaces>(
                    std::visit([&](const auto& one) { return distribute(one, gbuffer, s.scene, last); }, technique));
            });
        },
        py::arg("technique"), py::arg("gbuffer"), py::arg("scene"), py::arg("last") = py::none(), "Where radiance caches stand.");
    m.def(
        "fill",
        [](const Fill& technique, const std::shared_ptr<const CachePlaces>& places, const SharedPyramids& pyramids,
           const BoundScene& s, std::uint32_t seed) {
            const auto each = plain_pointers(pyramids);
            return run([&] {
                return std::make_shared<FilledCaches>(std::visit(
                    [&](const auto& one) { return fill(one, places, each, s.scene, *s.intersector, seed); }, technique));
            });
        },
        py::arg("technique"), py::arg("places").none(false), py::arg("pyramids"), py::arg("scene"), py::arg("seed") = 0,
        "The radiance that arrives at every cache.");
    m.def(
        "preconvolve",
        [](const Preconvolve& technique, const std::shared_ptr<const FilledCaches>& filled) {
            return run([&] {
                return std::make_shared<ConvolvedCaches>(
                    std::visit([&](const auto& one) { return preconvolve(one, filled); }, technique));
            });
        },
        py::arg("technique"), py::arg("filled").none(false), "Maps and tables for lobes of every width.");
    m.def(
        "interpolate",
        [](const Interpolate& technique, const std::optional<std::shared_ptr<ConvolvedCaches>>& given, const GBuffer& gbuffer,
           const BoundScene& s, const Fill& fill_by, const Preconvolve& preconvolve_by, const SharedPyramids& pyramids,
           std::uint32_t seed) {
            const auto each = plain_pointers(pyramids);
            const ConvolvedCaches* caches = given ? given->get() : nullptr;
            if (caches == nullptr && !std::holds_alternative<Evaluated>(technique))
                throw py::type_error("interpolate: caches may only be None for Evaluated");
            if (caches != nullptr &&
                (caches->filled->places->width != gbuffer.width || caches->filled->places->height != gbuffer.height))
                throw py::value_error("interpolate: caches were distributed over a picture of another size");
            const OwnCaches own{fill_by, preconvolve_by, each, *s.intersector, seed};
            return run([&] {
                return std::make_shared<CacheLight>(
                    std::visit([&](const auto& one) { return interpolate(one, caches, gbuffer, s.scene, own); }, technique));
            });
        },
        py::arg("technique"), py::arg("caches"), py::arg("gbuffer"), py::arg("scene"), py::arg("fill"), py::arg("preconvolve"),
        py::arg("pyramids"), py::arg("seed") = 0, "Light that pixels get from caches.");
    m.def(
        "hemisphere_direction",
        [](float x, float y) {
            return array3(hemisphere_direction({x, y}));
        },
        py::arg("x"), py::arg("y"),
        "Unit direction about +z of a point of the hemisphere map's unit square [Shirley and Chiu 1997, and Lambert's "
        "projection].");
    m.def(
        "hemisphere_square",
        [](const std::array<float, 3>& direction) {
            const vec2 square = hemisphere_square(vector3(direction));
            return std::array<float, 2>{square.x, square.y};
        },
        py::arg("direction"), "The inverse of hemisphere_direction, of a unit direction.");
}

}  // namespace

void bind_caches(py::module_& m) {
    bind_places(m);
    bind_filled(m);
    bind_convolved(m);
    bind_cache_light(m);
    bind_stages(m);
    bind_functions(m);
}

}  // namespace interreflect::bindings
