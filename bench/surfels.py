"""The suite `surfels`: the stages of illuminance composition in the paper's two settings, on Sponza by its sun at 1920 x 1080.

Surfels are lit by a shadow map that is there, as in the paper; its own time is that of the stage's rows. Stages run in a frame's order:
a stage finds in cache what the one before it left there, and nothing else.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

import interreflect as ir
from bench import limits, sponza, surfel_curve_rows
from bench.calibration import TARGETS_MACHINE, Calibration, calibrate
from bench.rows import Row, absent, within
from bench.timing import Work, least, timed
from bench.voxel_pipeline import bounded, sunlit
from interreflect import stages

SIZE = (1920, 1080)
REPEATS = 15
MIB = 1 << 20


@dataclasses.dataclass(frozen=True)
class Setting:
    """Bounds in ms; precomputation in s; memory in MiB, links projected and cones."""

    name: str
    surfels: float
    pull: float
    projected: float
    cones: float
    whole: float
    precomputation: float
    memory: tuple[float, float]


SETTINGS = (
    Setting("setting 1", 1.0, 0.2, 3.0, 6.0, 4.2, 120.0, (104.3, 42.8)),
    Setting("setting 2", 0.3, 0.1, 0.6, 1.2, 1.0, 30.0, (32.5, 19.58)),
)
EVALUATION = 20.0


def run(peers: Any) -> tuple[Calibration, list[Row]]:
    """Calibrates, then measures every row. peers: the module `_peers`."""
    measured_on = sponza.load(peers)
    calibration = calibrate(measured_on)
    if measured_on is None:
        return calibration, [absent("illuminance composition", "as the stages' rows say", "Sponza is not here")]
    scene = sunlit(measured_on.scene)
    of_settings = [row for setting in SETTINGS for row in rows(calibration, setting, scene)]
    return calibration, [*of_settings, *surfel_curve_rows.rows(scene)]


def rows(calibration: Calibration, setting: Setting, scene: ir.Scene) -> list[Row]:
    way: Any = ir.methods.IlluminanceComposition.preset(setting.name).replace(bounces=1)
    prepared = way.prepare(scene)
    surfels, pixels, sites, links = (prepared.state[key] for key in ("surfels", "pixels", "sites", "links"))
    cones_way = ir.RuntimeProjection(links=way.link.links, bands=way.link.bands, near_rays=0)
    cones = stages.link(cones_way, sites, surfels, scene)
    by_map = ir.ShadowMap()
    maps = stages.shadow_maps(by_map, scene)
    gbuffer = ir.trace_gbuffer(scene, "nave", SIZE)
    made: dict[str, Any] = {}  # each stage reads what the one before has just made, as in a frame, and what the frame before left

    def keep(product: str, call: Callable[[], Any]) -> Work:
        return timed(lambda: made.__setitem__(product, call()))

    def lights(technique: Any, by: Any) -> Callable[[], Any]:
        return lambda: stages.light_caches(technique, by, sites, surfels, made["sent"], scene)

    lighting, pulling, projected, evaluated, by_cones = least(
        keep("lit", lambda: stages.shadow(by_map, scene, pixels, maps=maps)),
        keep("sent", lambda: stages.pull(surfels, np.asarray(made["lit"].radiance))),
        keep("caches", lights(way.link, links)),
        keep("seen", lambda: stages.evaluate(way.evaluate, made["caches"], sites, gbuffer, scene)),
        keep("by cones", lights(cones_way, cones)), repeats=REPEATS,
    )  # fmt: skip
    caches, sent = made["caches"], made["sent"]
    name = setting.name
    evaluations = made["seen"].counts.asdict()["cache_evaluations"]
    told = f"{len(surfels)} surfels, {len(sites)} caches"
    links_limit = lambda c: limits.move(c, links.bytes)  # noqa: E731
    limit_of = {
        "lighting": lambda c: limits.move(c, (52 + 9 * 4 + 12) * len(surfels)),
        "pull": lambda c: limits.move(c, 2 * 12 * len(surfels.leaves)),
        "cones": lambda c: cone_links(c, len(sites) * cones.per_cache, cones.bytes),
        "evaluation": lambda c: evaluation(c, evaluations),
    }
    of_links = f"{told}, {links.bytes / MIB:.1f} MiB of links; {1e6 * projected / len(sites):.0f} ns a cache"
    found = [
        bounded(f"surfel lighting by the sun: {name}", lighting, setting.surfels, limit_of["lighting"], calibration,
                note=f"{told}; a map of {by_map.size} x {by_map.size} texels, 3 x 3 of them compared"),
        bounded(f"pull: {name}", pulling, setting.pull, limit_of["pull"], calibration, note=told),
        bounded(f"cache lighting, links in spherical harmonics: {name}", projected, setting.projected, links_limit, calibration,
                note=of_links),
        within(f"cache lighting within 1.2 of its limit: {name}", projected, links_limit(calibration), 1.2 * links_limit(calibration)),
        bounded(f"cache lighting, run-time projection: {name}", by_cones, setting.cones, limit_of["cones"], calibration,
                note=f"{cones.bytes / MIB:.1f} MiB of links"),
        bounded(f"sum, links in spherical harmonics: {name}", lighting + pulling + projected, setting.whole, links_limit, calibration),
        bounded(f"evaluation at 1920 x 1080: {name}", evaluated, EVALUATION, limit_of["evaluation"], calibration,
                note=f"{evaluations / (SIZE[0] * SIZE[1]):.1f} caches a pixel"),
        precomputation(calibration, setting, prepared.precompute_milliseconds / 1e3, told),
    ]  # fmt: skip
    held = surfels.bytes + sites.bytes + caches.bytes + sent.bytes
    for kind, bytes_of, most in (("spherical harmonics", links.bytes, setting.memory[0]), ("cones", cones.bytes, setting.memory[1])):
        found.append(memory(f"memory, links as {kind}: {setting.name}", (held + bytes_of) / MIB, most))
    return found


def evaluation(c: Calibration, evaluations: float) -> float:
    """Nine coefficients of three colours in each cache, as the cosine needs; of each pixel position, two normals, triangle and instance
    are read, irradiance and glossy radiance written."""
    return max(limits.compute(c, 2.0 * 27 * evaluations), limits.move(c, (3 * 12 + 8 + 24) * SIZE[0] * SIZE[1]))


def cone_links(c: Calibration, count: int, bytes_of: int) -> float:
    """Four bands: 48 multiply-adds and about as many operations more for a cone's direction and zonal polynomials."""
    return max(limits.move(c, bytes_of), limits.compute(c, (2 * 48 + 50.0) * count))


def precomputation(calibration: Calibration, setting: Setting, seconds: float, told: str) -> Row:
    """Most of it is visibility: the bound grows as this machine's rays do."""
    scale = TARGETS_MACHINE.best("occlusion") / calibration.best("occlusion")
    return within(f"precomputation: {setting.name}", 1e3 * seconds, None, 1e3 * setting.precomputation, scale, note=told)


def memory(name: str, mebibytes: float, most: float) -> Row:
    return Row(name, None, None, None, None, f"at most {most:g} MiB", mebibytes <= most, note=f"{mebibytes:.1f} MiB")
