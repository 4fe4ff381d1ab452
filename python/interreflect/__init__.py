"""Interreflect: a laboratory for real-time global illumination.

Scenes go in; methods, composed of interchangeable stages, make pictures; each picture is measured against a path-traced
truth; studies chart speed against accuracy. Names are loaded when first used, so that `import interreflect` is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

# Public name -> the module that holds it ("module" alone: the module itself).
_HOMES = {
    **dict.fromkeys(("Scene", "Mesh", "Material", "Texture", "Camera"), "scenes.values"),
    **dict.fromkeys(("PointLight", "SpotLight", "DirectionalLight", "EnvironmentLight"), "scenes.values"),
    "directional_lights": "scenes.median_cut",
    "load_scene": "scenes.load",
    "SceneError": "errors",
    "Motion": "motion",
    **dict.fromkeys(("Frame",), "frame"),
    "Pieces": "methods.pieces",
    **dict.fromkeys(("Profile", "Stage"), "profile"),
    **dict.fromkeys(("trace_gbuffer", "voxelize", "light_voxels", "prefilter", "march", "glossy", "shadow", "sky", "shade"), "stages"),
    **dict.fromkeys(("distribute", "fill", "preconvolve", "interpolate"), "stages"),
    **dict.fromkeys(("light_maps", "sample_lights", "cluster_lights", "shadow_lights", "shade_lights"), "stages"),
    **dict.fromkeys(("techniques", "exact"), "stages"),
    **dict.fromkeys(("VoxelCoverage", "voxel_coverage"), "coverage"),
    **dict.fromkeys(("SurfelSpacing", "surfel_spacing"), "spacing"),
    "voxel_view": "cubes",
    "cluster_view": "clusters",
    "light_cluster_view": "clusters",
    **dict.fromkeys(("Study", "sweep"), "study.study"),
    "run": "study.run",
    "Records": "study.records",
    "load_records": "study.store",
    **dict.fromkeys(("Reference", "reference"), "study.reference"),
    **dict.fromkeys(("pareto", "hypervolume", "knee", "inefficiency", "cheapest", "best", "equal_time", "equal_error"), "study.pareto"),
    "attribute": "study.attribution",
    "ladder": "study.ladder",
    "search": "study.search",
    "sensitivity": "study.sensitivity",
    "marginal": "study.marginal",
    "advise": "study.advise",
    "report": "study.report",
    "view": "live.server",
    "about": "machine",  # not a module of that name: importing it would put the module in the function's place
}
_MODULES = ("methods", "scenes", "metrics", "charts", "stability")


def _is_technique(name: str, value: Any) -> bool:
    return isinstance(value, type) and hasattr(value, "description") and value.__name__ == name


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f"interreflect.{name}")
    if name in _HOMES:
        module = import_module(f"interreflect.{_HOMES[name]}")
        value = getattr(module, name)
        globals()[name] = value  # a submodule of the same name (study.run, reference, ...) must not shadow it
        return value
    if not name.startswith("_"):
        core = import_module("interreflect._core")
        value = getattr(core, name, None)
        if _is_technique(name, value):
            return value
    raise AttributeError(f"module 'interreflect' has no attribute {name!r}")


def __dir__() -> list[str]:
    core = import_module("interreflect._core")
    techniques = [name for name in dir(core) if _is_technique(name, getattr(core, name))]
    return sorted({*_HOMES, *_MODULES, *techniques, "__version__"})


if TYPE_CHECKING:
    from interreflect import charts as charts
    from interreflect import methods as methods
    from interreflect import metrics as metrics
    from interreflect import scenes as scenes
    from interreflect import stability as stability
    from interreflect._core import Grid as Grid
    from interreflect.clusters import cluster_view as cluster_view
    from interreflect.clusters import light_cluster_view as light_cluster_view
    from interreflect.coverage import VoxelCoverage as VoxelCoverage
    from interreflect.coverage import voxel_coverage as voxel_coverage
    from interreflect.cubes import voxel_view as voxel_view
    from interreflect.errors import SceneError as SceneError
    from interreflect.frame import Frame as Frame
    from interreflect.live.server import view as view
    from interreflect.machine import about as about
    from interreflect.methods.pieces import Pieces as Pieces
    from interreflect.motion import Motion as Motion
    from interreflect.profile import Profile as Profile
    from interreflect.profile import Stage as Stage
    from interreflect.scenes.load import load_scene as load_scene
    from interreflect.scenes.median_cut import directional_lights as directional_lights
    from interreflect.scenes.values import Camera as Camera
    from interreflect.scenes.values import DirectionalLight as DirectionalLight
    from interreflect.scenes.values import EnvironmentLight as EnvironmentLight
    from interreflect.scenes.values import Material as Material
    from interreflect.scenes.values import Mesh as Mesh
    from interreflect.scenes.values import PointLight as PointLight
    from interreflect.scenes.values import Scene as Scene
    from interreflect.scenes.values import SpotLight as SpotLight
    from interreflect.scenes.values import Texture as Texture
    from interreflect.spacing import SurfelSpacing as SurfelSpacing
    from interreflect.spacing import surfel_spacing as surfel_spacing
    from interreflect.stages import cluster_lights as cluster_lights
    from interreflect.stages import distribute as distribute
    from interreflect.stages import exact as exact
    from interreflect.stages import fill as fill
    from interreflect.stages import glossy as glossy
    from interreflect.stages import interpolate as interpolate
    from interreflect.stages import light_maps as light_maps
    from interreflect.stages import light_voxels as light_voxels
    from interreflect.stages import march as march
    from interreflect.stages import preconvolve as preconvolve
    from interreflect.stages import prefilter as prefilter
    from interreflect.stages import sample_lights as sample_lights
    from interreflect.stages import shade as shade
    from interreflect.stages import shade_lights as shade_lights
    from interreflect.stages import shadow as shadow
    from interreflect.stages import shadow_lights as shadow_lights
    from interreflect.stages import sky as sky
    from interreflect.stages import techniques as techniques
    from interreflect.stages import trace_gbuffer as trace_gbuffer
    from interreflect.stages import voxelize as voxelize
    from interreflect.study.advise import advise as advise
    from interreflect.study.attribution import attribute as attribute
    from interreflect.study.ladder import ladder as ladder
    from interreflect.study.marginal import marginal as marginal
    from interreflect.study.pareto import best as best
    from interreflect.study.pareto import cheapest as cheapest
    from interreflect.study.pareto import equal_error as equal_error
    from interreflect.study.pareto import equal_time as equal_time
    from interreflect.study.pareto import hypervolume as hypervolume
    from interreflect.study.pareto import inefficiency as inefficiency
    from interreflect.study.pareto import knee as knee
    from interreflect.study.pareto import pareto as pareto
    from interreflect.study.records import Records as Records
    from interreflect.study.reference import Reference as Reference
    from interreflect.study.reference import reference as reference
    from interreflect.study.report import report as report
    from interreflect.study.run import run as run
    from interreflect.study.search import search as search
    from interreflect.study.sensitivity import sensitivity as sensitivity
    from interreflect.study.store import load_records as load_records
    from interreflect.study.study import Study as Study
    from interreflect.study.study import sweep as sweep
