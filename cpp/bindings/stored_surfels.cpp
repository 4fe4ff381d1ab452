/// Surfels, sites and links as arrays and numbers by name, for a file, and back.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstring>
#include <memory>
#include <string>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "surfels/link.h"
#include "surfels/stored.h"

namespace interreflect::bindings {
namespace {

template <class T>
struct Row {
    using Scalar = T;
};
template <>
struct Row<vec2> {
    using Scalar = float;
};
template <>
struct Row<vec3> {
    using Scalar = float;
};
template <>
struct Row<ConeLink> {
    using Scalar = std::uint16_t;
};

/// Every array and number of a product, by its name in a file.
template <class Visit>
void each_field(ClusteredSurfels& s, const Visit& visit) {
    visit("position", s.surfels.position), visit("normal", s.surfels.normal), visit("area", s.surfels.area);
    visit("triangle", s.surfels.triangle), visit("barycentric", s.surfels.barycentric), visit("extent", s.surfels.extent);
    visit("leaves", s.tree.leaves), visit("leaf_end", s.tree.leaf_end), visit("node", s.tree.node);
    visit("node_area", s.tree.area), visit("inversions", s.tree.inversions);
}
template <class Visit>
void each_field(Counts& counts, const Visit& visit) {
    for (const NamedCount& count : every_count) visit(("counted_" + std::string(count.name)).c_str(), counts.*count.member);
}
template <class Visit>
void each_field(CacheSites& s, const Visit& visit) {
    visit("position", s.position), visit("normal", s.normal), visit("offset", s.offset);
    visit("map_size", s.map.size), visit("map_cache", s.map.cache);
    visit("map_triangle", s.map.triangle), visit("map_texcoord", s.map.texcoord);
    visit("nx", s.grid.size.x), visit("ny", s.grid.size.y), visit("nz", s.grid.size.z);
    visit("levels", s.grid.levels), visit("reach", s.grid.reach), visit("normal_offset", s.grid.normal_offset);
    visit("lower_x", s.grid.box.lower.x), visit("lower_y", s.grid.box.lower.y), visit("lower_z", s.grid.box.lower.z);
    visit("upper_x", s.grid.box.upper.x), visit("upper_y", s.grid.box.upper.y), visit("upper_z", s.grid.box.upper.z);
    visit("grid_cache", s.grid.cache), visit("grid_nearest", s.grid.nearest);
    each_field(s.counts, visit);
}
template <class Visit>
void each_field(CacheLinks& l, const Visit& visit) {
    bool cones = l.kind == CacheLinks::Kind::cones;
    visit("is_cones", cones);
    l.kind = cones ? CacheLinks::Kind::cones : CacheLinks::Kind::projected;
    visit("per_cache", l.per_cache), visit("bands", l.bands), visit("radiosity", l.radiosity), visit("unit", l.unit);
    visit("caches", l.caches), visit("nodes", l.nodes);
    visit("link_node", l.node), visit("coefficients", l.coefficients), visit("cones", l.cones);
    each_field(l.counts, visit);
}

template <class Visit>
void each_field(LinkCandidates& l, const Visit& visit) {
    each_field(l.nodes, visit);
    visit("child", l.child);
}

struct Store {
    py::dict& into;
    py::handle owner;

    template <class T>
    void operator()(const char* name, Buffer<T>& data) const {
        using Scalar = typename Row<T>::Scalar;
        std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(data.size())};
        if (sizeof(T) > sizeof(Scalar)) shape.push_back(sizeof(T) / sizeof(Scalar));
        into[name] = view(reinterpret_cast<const Scalar*>(data.data()), shape, owner);
    }
    template <class T>
    void operator()(const char* name, T& number) const {
        into[name] = number;
    }
};

struct Restore {
    const py::dict& from;

    py::object get(const char* name) const {
        if (!from.contains(name)) throw py::value_error(std::string("stored arrays lack ") + name);
        return from[name];
    }
    template <class T>
    void operator()(const char* name, Buffer<T>& data) const {
        using Scalar = typename Row<T>::Scalar;
        constexpr auto columns = static_cast<py::ssize_t>(sizeof(T) / sizeof(Scalar));
        const auto array = exact_array<Scalar>(get(name), name);
        if (array.ndim() != (columns > 1 ? 2 : 1) || (columns > 1 && array.shape(1) != columns))
            throw py::value_error(std::string("stored ") + name + " has another shape");
        data = Buffer<T>(static_cast<std::size_t>(array.shape(0)));
        if (data.size() > 0) std::memcpy(static_cast<void*>(data.data()), array.data(), data.bytes());
    }
    template <class T>
    void operator()(const char* name, T& number) const {
        try {
            number = get(name).cast<T>();
        } catch (const py::cast_error&) {
            throw py::value_error(std::string("stored ") + name + " is not a number of its kind");
        }
    }
};

template <class Product>
void bind_stored(py::module_& m) {
    m.def(
        "to_store",
        [](const std::shared_ptr<Product>& product) {
            py::dict made;
            const py::object owner = py::cast(product);
            each_field(*product, Store{made, owner});
            return made;
        },
        py::arg("product"), "Every array (a view) and number of a precomputed product, by name.");
}

template <class Product, class... Context>
std::shared_ptr<Product> restored(const py::dict& stored, const Context&... context) {
    auto made = std::make_shared<Product>();
    each_field(*made, Restore{stored});
    check_stored(*made, context...);
    if constexpr (requires { complete(*made, context...); }) complete(*made, context...);
    return made;
}

}  // namespace

void bind_stored_surfels(py::module_& m) {
    bind_stored<ClusteredSurfels>(m), bind_stored<CacheSites>(m), bind_stored<CacheLinks>(m);
    bind_stored<LinkCandidates>(m);
    m.def(
        "surfels_from_store",
        [](const py::dict& stored, const BoundScene& s) { return restored<ClusteredSurfels>(stored, s.scene); },
        py::arg("stored"), py::arg("scene"), "What `to_store` gave; every number is checked against the scene.");
    m.def(
        "sites_from_store", [](const py::dict& stored, const BoundScene& s) { return restored<CacheSites>(stored, s.scene); },
        py::arg("stored"), py::arg("scene"), "What `to_store` gave; every number is checked against the scene.");
    m.def(
        "links_from_store",
        [](const py::dict& stored, const CacheSites& sites, const ClusteredSurfels& surfels) {
            return restored<CacheLinks>(stored, sites, surfels);
        },
        py::arg("stored"), py::arg("sites"), py::arg("surfels"),
        "What `to_store` gave; every number is checked, also against what they link.");
    m.def(
        "candidates_from_store",
        [](const py::dict& stored, const CacheSites& sites, const ClusteredSurfels& surfels) {
            return restored<LinkCandidates>(stored, sites, surfels);
        },
        py::arg("stored"), py::arg("sites"), py::arg("surfels"),
        "What `to_store` gave; every number is checked, also against what they link.");
}

}  // namespace interreflect::bindings
