/// Room surfels: place, cluster, sites of caches, link, light, evaluate.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "bindings/technique.h"
#include "direct/shadow.h"
#include "surfels/cluster.h"
#include "surfels/evaluate.h"
#include "surfels/light_caches.h"
#include "surfels/link.h"
#include "surfels/link/shared_cut.h"
#include "surfels/open_sides.h"
#include "surfels/place.h"
#include "surfels/place/spacing.h"
#include "surfels/pull.h"
#include "surfels/shadow_links.h"
#include "surfels/sites.h"
#include "surfels/surfel_pixels.h"
#include "surfels/used_caches.h"
#include "surfels/window.h"

namespace interreflect::bindings {
namespace {

void bind_stages(py::module_& m) {
    bind_stage(m, "place_surfels", "Which disks stand for the still surface.", false, static_cast<const PlaceSurfels*>(nullptr));
    bind_stage(m, "cluster_surfels", "Which surfels send light on as one.", false, static_cast<const ClusterSurfels*>(nullptr));
    bind_stage(m, "place_caches", "Where caches of incident radiance stand.", true, static_cast<const PlaceCaches*>(nullptr));
    bind_stage(m, "link", "Which patches of surfels send light to each cache.", true, static_cast<const Link*>(nullptr));
    bind_stage(m, "shadow_links", "What bodies that move take from the light of links.", false,
               static_cast<const ShadowLinks*>(nullptr));
    bind_stage(m, "evaluate", "What pixels get from caches of incident radiance.", true, static_cast<const Evaluate*>(nullptr));
}

void bind_precomputation(py::module_& m) {
    m.def(
        "place_surfels",
        [](const PlaceSurfels& technique, const BoundScene& s) {
            return run([&] {
                return std::make_shared<Surfels>(
                    std::visit([&](const auto& one) { return place_surfels(one, s.scene, *s.intersector); }, technique));
            });
        },
        py::arg("technique"), py::arg("scene"), "Disks that stand for the still surface.");
    m.def(
        "open_sides",
        [](const Surfels& fronts, const BoundScene& s) {
            return run([&] { return std::make_shared<Surfels>(open_sides(fronts, s.scene, *s.intersector)); });
        },
        py::arg("fronts"), py::arg("scene"),
        "Those surfels whose side sees the front of something; on two-sided materials on both sides.");
    m.def(
        "surfel_spacing",
        [](const Surfels& surfels) {
            const Buffer<float> spacing = run([&] { return surfel_spacing(surfels); });
            return py::array_t<float>(static_cast<py::ssize_t>(spacing.size()), spacing.data());
        },
        py::arg("surfels"),
        "(n,): distance of each to the nearest other one on its side, over the root of its area; infinite where there is none.");
    m.def(
        "cluster_surfels",
        [](const ClusterSurfels& technique, const Surfels& surfels) {
            return run([&] {
                return std::make_shared<ClusteredSurfels>(
                    std::visit([&](const auto& one) { return cluster_surfels(one, surfels); }, technique));
            });
        },
        py::arg("technique"), py::arg("surfels"), "A tree over surfels, and the surfels in the order of its leaves.");
    m.def(
        "surfel_pixels",
        [](const ClusteredSurfels& surfels, const BoundScene& s) {
            return run([&] { return std::make_shared<GBuffer>(surfel_pixels(surfels.surfels, s.scene)); });
        },
        py::arg("surfels"), py::arg("scene"), "Surfels as the pixels of a picture, row by row.");
    m.def(
        "place_caches",
        [](const CacheGrid& technique, const BoundScene& s, const BoundScene& about) {
            return run([&] {
                return std::make_shared<CacheSites>(
                    place_caches(technique, s.scene, *s.intersector, about.scene.geometry->bounds()));
            });
        },
        py::arg("technique"), py::arg("scene"), py::arg("about"), "Caches in a box about a scene, which may hold more.");
    m.def(
        "place_caches",
        [](const LightMap& technique, const BoundScene& s, const BoundScene& about, const py::object& texcoord) {
            const auto corners = rows<vec2, float>(texcoord, "texcoord");
            return run([&] {
                return std::make_shared<CacheSites>(
                    place_caches(technique, s.scene, *s.intersector, about.scene.geometry->bounds(), corners));
            });
        },
        py::arg("technique"), py::arg("scene"), py::arg("about"), py::arg("texcoord"),
        "Caches in the texels of a map, and in a box about a scene, which may hold more. texcoord: (3 triangles, 2) float32, of "
        "every corner, in texels; negative: the triangle has no chart.");
    m.def(
        "still_triangles",
        [](const BoundScene& s) {
            const auto& arrays = *s.scene.geometry->arrays;
            const Group& still = s.scene.geometry->groups.front();
            py::array_t<float> corners({static_cast<py::ssize_t>(still.triangle_count), py::ssize_t{3}, py::ssize_t{3}});
            for (std::size_t t = 0; t < still.triangle_count; ++t)
                for (int corner = 0; corner < 3; ++corner)
                    for (int k = 0; k < 3; ++k)
                        corners.mutable_at(t, corner, k) = arrays.positions[arrays.triangles[t][corner]][k];
            return py::make_tuple(corners, arrays.triangles.size());
        },
        py::arg("scene"),
        "(n, 3, 3) float32: corners of what does not move, world space, a copy; these are the scene's first n triangles. And how "
        "many it has in all.");
    m.def(
        "pixel_sites",
        [](const GBuffer& gbuffer) { return run([&] { return std::make_shared<CacheSites>(pixel_sites(gbuffer)); }); },
        py::arg("gbuffer"), "A cache for every pixel that sees a surface.");
    const auto bind_link = [&m]<class Technique>(const Technique*) {
        m.def(
            "link",
            [](const Technique& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const BoundScene& s) {
                return run(
                    [&] { return std::make_shared<CacheLinks>(link(technique, sites, surfels, s.scene, *s.intersector)); });
            },
            py::arg("technique"), py::arg("sites"), py::arg("surfels"), py::arg("scene"),
            "Which patches of surfels send light to each cache.");
        m.def(
            "shared_cut",
            [](const Technique& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const BoundScene& s) {
                return run(
                    [&] { return std::make_shared<SharedCut>(shared_cut(technique, sites, surfels, s.scene, *s.intersector)); });
            },
            py::arg("technique"), py::arg("sites"), py::arg("surfels"), py::arg("scene"),
            "One cut of the tree for every cache; bands and kind of the technique do not matter.");
        m.def(
            "take_links",
            [](const Technique& technique, const SharedCut& cut) {
                return run([&] { return std::make_shared<CacheLinks>(take_links(technique, cut)); });
            },
            py::arg("technique"), py::arg("cut"), "Links out of a shared cut: the same bits as from `link`.");
    };
    bind_link(static_cast<const ShLinks*>(nullptr));
    bind_link(static_cast<const RuntimeProjection*>(nullptr));
}

/// A scene's point, spot and directional lights alone.
Scene lamps_of(const Scene& scene) {
    Scene lamps;
    lamps.geometry = scene.geometry;
    lamps.point_lights = scene.point_lights, lamps.spot_lights = scene.spot_lights;
    lamps.directional_lights = scene.directional_lights;
    return lamps;
}

template <class Technique>
void bind_lamp_shadow(py::module_& m) {
    m.def(
        "lamp_shadow",
        [](const Technique& technique, const BoundScene& s, const GBuffer& g, std::uint32_t seed) {
            return run([&] {
                const Scene lamps = lamps_of(s.scene);
                return std::make_shared<DirectLight>(shadow(technique, s.scene, *s.intersector, LightSampler(lamps), g, seed));
            });
        },
        py::arg("technique"), py::arg("scene"), py::arg("gbuffer"), py::arg("seed") = 0,
        "What pixels reflect of point, spot and directional lights alone: emitters come through links.");
}

void bind_run_time(py::module_& m) {
    bind_lamp_shadow<TracedShadows>(m);
    bind_lamp_shadow<ShadowMap>(m);
    m.def(
        "lamp_shadow",
        [](const ShadowMap& technique, const BoundScene& s, const GBuffer& g, const ShadowMaps& maps, std::uint32_t seed) {
            return run([&] {
                const Scene lamps = lamps_of(s.scene);
                return std::make_shared<DirectLight>(
                    shadow(technique, maps, s.scene, *s.intersector, LightSampler(lamps), g, seed));
            });
        },
        py::arg("technique"), py::arg("scene"), py::arg("gbuffer"), py::arg("maps"), py::arg("seed") = 0,
        "By maps that are there.");
    m.def(
        "pull",
        [](const ClusteredSurfels& surfels, const py::object& radiance, bool radiosity, bool pack) {
            const auto array = exact_array<float>(radiance, "radiance");
            if (array.ndim() < 1 || array.shape(array.ndim() - 1) != 3)
                throw py::value_error("radiance must have shape (..., 3)");
            const std::span<const vec3> values(reinterpret_cast<const vec3*>(array.data()),
                                               static_cast<std::size_t>(array.size()) / 3);
            return run([&] {
                NodeLight light = pull(surfels.tree, values, radiosity);
                return std::make_shared<NodeLight>(pack ? packed(std::move(light)) : std::move(light));
            });
        },
        py::arg("surfels"), py::arg("radiance"), py::arg("radiosity") = false, py::arg("packed") = false,
        "The sum of the surfels' flux under every node, or the mean of their radiosity; packed: in 4 bytes a node.");
    m.def(
        "light_caches",
        [](const CacheLinks& links, const NodeLight& light, int bands, int chrominance_bands, const py::object& used) {
            const Marks marks(used, "used");
            return run([&] {
                return std::make_shared<LightCaches>(light_caches(links, light, {bands, chrominance_bands}, marks.values));
            });
        },
        py::arg("links"), py::arg("light"), py::arg("bands"), py::arg("chrominance_bands") = 0, py::arg("used") = py::none(),
        "The sum over each cache's links. used: (caches,) uint8, 0 where nothing reads a cache and it may stay black.");
    m.def(
        "window_caches", [](LightCaches& caches, const std::string& window) { run([&] { window_caches(caches, window); }); },
        py::arg("caches"), py::arg("window"), "Weakens the higher bands of caches' light, in place: none, hanning or lanczos.");
    m.def(
        "used_caches",
        [](const CacheSites& sites, const GBuffer& gbuffer) {
            const Buffer<std::uint8_t> used = run([&] { return used_caches(sites, gbuffer); });
            return py::array_t<std::uint8_t>(static_cast<py::ssize_t>(used.size()), used.data());
        },
        py::arg("sites"), py::arg("gbuffer"), "(caches,): 1 where some pixel reads the cache, else 0.");
    m.def(
        "sample_caches",
        [](const AllSurfels& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const NodeLight& light,
           int chrominance_bands, const BoundScene& s, std::uint32_t seed, const py::object& used) {
            const Marks marks(used, "used");
            return run([&] {
                return std::make_shared<LightCaches>(light_caches(technique, sites, surfels, light,
                                                                  {technique.bands, chrominance_bands}, s.scene, *s.intersector,
                                                                  seed, marks.values));
            });
        },
        py::arg("technique"), py::arg("sites"), py::arg("surfels"), py::arg("light"), py::arg("chrominance_bands"),
        py::arg("scene"), py::arg("seed") = 0, py::arg("used") = py::none(),
        "Rays from every cache to surfels themselves. used: as `light_caches` takes it.");
    m.def(
        "evaluate",
        [](const SphericalHarmonicLobes& technique, const LightCaches& caches, const CacheSites& sites, const GBuffer& gbuffer,
           const BoundScene& s) {
            return run([&] { return std::make_shared<SurfelLight>(evaluate(technique, caches, sites, gbuffer, s.scene)); });
        },
        py::arg("technique"), py::arg("caches"), py::arg("sites"), py::arg("gbuffer"), py::arg("scene"),
        "What pixels get from caches.");
    m.def(
        "evaluate",
        [](const DirectLinks& technique, const CacheLinks& links, const NodeLight& light, const CacheSites& sites,
           const GBuffer& gbuffer, const BoundScene& s) {
            return run([&] { return std::make_shared<SurfelLight>(evaluate(technique, links, light, sites, gbuffer, s.scene)); });
        },
        py::arg("technique"), py::arg("links"), py::arg("light"), py::arg("sites"), py::arg("gbuffer"), py::arg("scene"),
        "What pixels get from the links of caches.");
    m.def(
        "evaluate",
        [](const DirectLinks& technique, const AllSurfels& links, const CacheSites& sites, const ClusteredSurfels& surfels,
           const NodeLight& light, const GBuffer& gbuffer, const BoundScene& s, std::uint32_t seed) {
            return run([&] {
                return std::make_shared<SurfelLight>(
                    evaluate(technique, links, sites, surfels, light, gbuffer, s.scene, *s.intersector, seed));
            });
        },
        py::arg("technique"), py::arg("links"), py::arg("sites"), py::arg("surfels"), py::arg("light"), py::arg("gbuffer"),
        py::arg("scene"), py::arg("seed") = 0, "What pixels get from surfels themselves, as the caches that they read see them.");
}

}  // namespace

void bind_surfels(py::module_& m) {
    bind_surfel_data(m);
    bind_stages(m);
    bind_precomputation(m);
    bind_run_time(m);
}

}  // namespace interreflect::bindings
