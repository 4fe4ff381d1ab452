/// Links that frames change: chosen by their light, blocked by bodies.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/pyramids.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "surfels/link.h"
#include "surfels/shadow_links.h"

namespace interreflect::bindings {

void bind_frame_links(py::module_& m) {
    m.def(
        "link",
        [](const FluxLinks& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const BoundScene& s) {
            return run(
                [&] { return std::make_shared<LinkCandidates>(link(technique, sites, surfels, s.scene, *s.intersector)); });
        },
        py::arg("technique"), py::arg("sites"), py::arg("surfels"), py::arg("scene"),
        "Links from which every frame chooses: `choose_links`.");
    m.def(
        "choose_links",
        [](const FluxLinks& technique, const LinkCandidates& candidates, const ClusteredSurfels& surfels, const NodeLight& light,
           const py::object& used) {
            const Marks marks(used, "used");
            return run([&] {
                return std::make_shared<CacheLinks>(choose_links(technique, candidates, surfels.tree, light, marks.values));
            });
        },
        py::arg("technique"), py::arg("candidates"), py::arg("surfels"), py::arg("light"), py::arg("used") = py::none(),
        "The links that bring every cache most of this light.");
    m.def(
        "shadow_links",
        [](const BodyCones& technique, LightCaches& caches, const CacheLinks& links, const NodeLight& light,
           const CacheSites& sites, const ClusteredSurfels& surfels, const std::vector<std::shared_ptr<const Pyramid>>& pyramids,
           const BoundScene& s, bool reflect) {
            const auto bodies = plain_pointers(pyramids);
            return run([&] {
                return shadow_links(technique, caches, links, light, sites, surfels, bodies, s.scene, *s.intersector, reflect);
            });
        },
        py::arg("technique"), py::arg("caches"), py::arg("links"), py::arg("light"), py::arg("sites"), py::arg("surfels"),
        py::arg("pyramids"), py::arg("scene"), py::arg("reflect") = true,
        "Takes from caches' light, in place, what bodies block, and adds what they send where `reflect`; pyramids: of the "
        "bodies.");
}

}  // namespace interreflect::bindings
