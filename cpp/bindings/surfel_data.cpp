/// Room surfels, what its stages make: surfels, sites of caches, links and light.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "surfels/evaluate.h"
#include "surfels/link.h"
#include "surfels/link/shared_cut.h"

namespace interreflect::bindings {
namespace {

void bind_surfels_data(py::module_& m) {
    py::class_<Surfels, std::shared_ptr<Surfels>>(m, "Surfels",
                                                  "Disks that stand for a scene's still surface; n in parallel arrays.")
        .def_property_readonly(
            "position", [](const py::object& self) { return vectors(self.cast<const Surfels&>().position, self); },
            "(n, 3): world space.")
        .def_property_readonly(
            "normal", [](const py::object& self) { return vectors(self.cast<const Surfels&>().normal, self); },
            "(n, 3): unit, of the triangle's front.")
        .def_property_readonly(
            "area", [](const py::object& self) { return numbers(self.cast<const Surfels&>().area, self); },
            "(n,): scene units squared.")
        .def_property_readonly(
            "triangle", [](const py::object& self) { return numbers(self.cast<const Surfels&>().triangle, self); },
            "(n,): number over all triangles of the scene.")
        .def_readonly("extent", &Surfels::extent, "Diagonal of the still surface's bounds, scene units.")
        .def("__len__", &Surfels::size)
        .def_property_readonly("bytes", &Surfels::bytes);
    using Clustered = ClusteredSurfels;
    py::class_<Clustered, std::shared_ptr<Clustered>>(
        m, "ClusteredSurfels", "Surfels in the order of a binary tree's leaves, and the tree in post-order.")
        .def_property_readonly(
            "surfels", [](const std::shared_ptr<Clustered>& self) { return std::shared_ptr<Surfels>(self, &self->surfels); },
            "In the order of the leaves.")
        .def_property_readonly(
            "leaves", [](const py::object& self) { return numbers(self.cast<const Clustered&>().tree.leaves, self); },
            "(2n - 1,): surfels under each node; the right child of node i is i - 1, the left one i - 2 leaves[i - 1].")
        .def_property_readonly(
            "leaf_end", [](const py::object& self) { return numbers(self.cast<const Clustered&>().tree.leaf_end, self); },
            "(2n - 1,): the node's surfels are [leaf_end - leaves, leaf_end).")
        .def_property_readonly(
            "node", [](const py::object& self) { return numbers(self.cast<const Clustered&>().tree.node, self); },
            "(n,): of each surfel.")
        .def_property_readonly(
            "area", [](const py::object& self) { return numbers(self.cast<const Clustered&>().tree.area, self); },
            "(2n - 1,): of each node's surfels, scene units squared.")
        .def_property_readonly(
            "inversions", [](const Clustered& self) { return self.tree.inversions; },
            "Merges nearer than one of those that they build on.")
        .def("__len__", [](const Clustered& self) { return self.surfels.size(); })
        .def_property_readonly("bytes", &Clustered::bytes);
    py::class_<NodeLight, std::shared_ptr<NodeLight>>(m, "NodeLight", "What every node of a tree of surfels sends on.")
        .def_property_readonly(
            "value",
            [](const py::object& self) {
                const auto& light = self.cast<const NodeLight&>();
                if (!light.is_packed()) return vectors(light.value, self);
                py::array_t<float> values({static_cast<py::ssize_t>(light.size()), py::ssize_t{3}});
                for (std::size_t i = 0; i < light.size(); ++i) {
                    const vec3 value = light.at(i);
                    for (int k = 0; k < 3; ++k) values.mutable_data()[3 * i + static_cast<std::size_t>(k)] = value[k];
                }
                return values;
            },
            "(2n - 1, 3): flux, W, or radiosity, W/m^2; a copy where it is packed.")
        .def_property_readonly("packed", &NodeLight::is_packed,
                               "Whether each is kept in 4 bytes, nine bits a colour and one exponent.")
        .def_readonly("radiosity", &NodeLight::radiosity)
        .def_property_readonly("bytes", &NodeLight::bytes);
}

void bind_sites(py::module_& m) {
    py::class_<CacheSites, std::shared_ptr<CacheSites>>(m, "CacheSites", "Where caches of incident radiance stand.")
        .def_property_readonly(
            "position", [](const py::object& self) { return vectors(self.cast<const CacheSites&>().position, self); },
            "(n, 3): world space.")
        .def_property_readonly(
            "normal", [](const py::object& self) { return vectors(self.cast<const CacheSites&>().normal, self); },
            "(n, 3): unit, or (0, 0, 0) where light may come from everywhere.")
        .def("__len__", &CacheSites::size)
        .def_readonly("counts", &CacheSites::counts)
        .def_property_readonly("bytes", &CacheSites::bytes);
}

void bind_links(py::module_& m) {
    py::class_<CacheLinks, std::shared_ptr<CacheLinks>>(m, "CacheLinks", "Which patches of surfels send light to each cache.")
        .def_readonly("per_cache", &CacheLinks::per_cache)
        .def_readonly("radiosity", &CacheLinks::radiosity, "Whether they take the nodes' radiosity in place of flux.")
        .def_property_readonly(
            "node",
            [](const CacheLinks& self) {
                const bool cones = self.kind == CacheLinks::Kind::cones;
                py::array_t<std::uint32_t> nodes(
                    {static_cast<py::ssize_t>(self.caches), static_cast<py::ssize_t>(self.per_cache)});
                for (std::size_t i = 0; i < static_cast<std::size_t>(nodes.size()); ++i)
                    nodes.mutable_data()[i] = cones ? self.cones[i].node : self.node[i];
                return nodes;
            },
            "(caches, links): node of the tree; a copy.")
        .def_readonly("counts", &CacheLinks::counts)
        .def_property_readonly("bytes", &CacheLinks::bytes);
    py::class_<LinkCandidates, std::shared_ptr<LinkCandidates>>(m, "LinkCandidates",
                                                                "Of every cache a tree of links, from which every frame chooses.")
        .def_property_readonly("counts", [](const LinkCandidates& self) { return self.nodes.counts; })
        .def_property_readonly("bytes", &LinkCandidates::bytes);
    py::class_<SharedCut, std::shared_ptr<SharedCut>>(
        m, "SharedCut", "One cut of the tree for every cache, with all that links of any kind keep of it.")
        .def_property_readonly("bytes", &SharedCut::bytes);
    py::class_<LightCaches, std::shared_ptr<LightCaches>>(m, "LightCaches", "Incident radiance in spherical harmonics.")
        .def_readonly("bands", &LightCaches::bands)
        .def_readonly("chrominance_bands", &LightCaches::chrominance_bands)
        .def_property_readonly(
            "coefficients",
            [](const py::object& self) {
                const auto& caches = self.cast<const LightCaches&>();
                return halves(caches.coefficients.data(),
                              {static_cast<py::ssize_t>(caches.caches), static_cast<py::ssize_t>(caches.stride())}, self);
            },
            "(caches, bands^2 + 2 chrominance_bands^2) float16, multiples of `unit`: of red, green and blue, or where "
            "chrominance "
            "has fewer bands of Y, Co and Cg.")
        .def_property_readonly(
            "unit", [](const py::object& self) { return numbers(self.cast<const LightCaches&>().unit, self); },
            "(caches,): what each cache's coefficients are multiples of, a power of two.")
        .def_readonly("counts", &LightCaches::counts)
        .def_property_readonly("bytes", &LightCaches::bytes);
    py::class_<SurfelLight, std::shared_ptr<SurfelLight>>(m, "SurfelLight", "What pixels get from caches of surfels' light.")
        .def_property_readonly(
            "gathered",
            [](const std::shared_ptr<SurfelLight>& self) { return std::shared_ptr<GatheredLight>(self, &self->gathered); },
            "What arrives over the hemisphere: irradiance alone.")
        .def_property_readonly(
            "glossy", [](const std::shared_ptr<SurfelLight>& self) { return std::shared_ptr<GlossyLight>(self, &self->glossy); },
            "What the glossy lobe reflects: radiance alone.")
        .def_readonly("counts", &SurfelLight::counts)
        .def_property_readonly("bytes", &SurfelLight::bytes);
}

}  // namespace

void bind_surfel_data(py::module_& m) {
    bind_surfels_data(m);
    bind_sites(m);
    bind_links(m);
}

}  // namespace interreflect::bindings
