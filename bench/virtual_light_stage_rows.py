"""Each stage of virtual area lights beside its target, and their sum."""

from __future__ import annotations

import dataclasses
from typing import Any

from bench import limits
from bench.calibration import TARGETS_MACHINE, Calibration
from bench.rows import Row
from bench.timing import least
from bench.virtual_light_pipeline import LIGHTS, STAGES, Pipeline, Room
from bench.voxel_pipeline import Limit, bounded, cones_scale

REPEATS = 9
MORE = 512  # lights
# Milliseconds, by lights where their number counts.
MAPS, CLUSTERS, SHADOWS, SHADING, TOTAL = 10.0, {LIGHTS: 3.0, MORE: 5.0}, {LIGHTS: 5.0, MORE: 25.0}, 45.0, 65.0


@dataclasses.dataclass(frozen=True)
class Stage:
    name: str
    milliseconds: float
    bound: float
    limit: Limit
    scale: float
    note: str

    def row(self, calibration: Calibration) -> Row:
        return bounded(self.name, self.milliseconds, self.bound, self.limit, calibration, scale=self.scale, note=self.note)


def rows(calibration: Calibration, room: Room) -> list[Row]:
    few, many = Pipeline(room, LIGHTS), Pipeline(room, MORE)
    names = (*STAGES, "iteration")
    spent = least(*few.works(), few.one_iteration(), *many.works(), many.one_iteration(), repeats=REPEATS)
    of_few, of_many = (dict(zip(names, some, strict=True)) for some in (spent[: len(names)], spent[len(names) :]))
    shading = shade(calibration, few, of_few)
    maps = light_map(calibration, few, of_few)
    clusters = {pipeline: cluster(calibration, pipeline, spent) for pipeline, spent in ((few, of_few), (many, of_many))}
    shadows = {pipeline: shadow(calibration, pipeline, spent) for pipeline, spent in ((few, of_few), (many, of_many))}
    parts = [maps, clusters[few], shadows[few], shading]
    listed = ", ".join(f"{name} {ms:.2f}" for name, ms in of_few.items())
    whole = Stage(
        f"whole indirect light, {LIGHTS} with PCSS: {room.name}", sum(of_few[name] for name in STAGES), TOTAL,
        lambda c: sum(part.limit(c) for part in parts),
        sum(part.bound * part.scale for part in parts) / sum(part.bound for part in parts), f"stages in ms: {listed}",
    )  # fmt: skip
    return [one.row(calibration) for one in (maps, *clusters.values(), *shadows.values(), shading, whole)]


def stage(calibration: Calibration, name: str, milliseconds: float, bound: float, limit: Limit, note: str) -> Stage:
    """The bound grows as the limit does."""
    return Stage(name, milliseconds, bound, limit, limit(calibration) / limit(TARGETS_MACHINE), note)


def light_map(calibration: Calibration, made: Pipeline, spent: dict[str, float]) -> Stage:
    name = f"reflective shadow map of {made.way.map_size}^2: {made.room.name}"
    note = f"{made.maps.counts.asdict().get('rays', 0)} rays"
    return stage(calibration, name, spent["reflective_shadow_maps"], MAPS, lambda c: limits.reflective_map(c, made.texels), note)


def cluster(calibration: Calibration, made: Pipeline, spent: dict[str, float]) -> Stage:
    lights, comparisons = len(made.lights), made.splat_texels()
    note = (
        f"{comparisons / made.texels:.1f} centres a texel, {made.lights.counts.asdict().get('stray_texels', 0)} texels that no splat covers"
    )
    note += f"; seeds before them {spent['sample_lights']:.2f} ms"
    name = f"k-means, {lights} clusters, one iteration: {made.room.name}"
    return stage(calibration, name, spent["iteration"], CLUSTERS[lights], lambda c: limits.cluster(c, made.texels, comparisons), note)


def shadow(calibration: Calibration, made: Pipeline, spent: dict[str, float]) -> Stage:
    counts, lights = made.shadows.counts.asdict(), len(made.lights)
    points = counts.get("surface_points", 0)
    note = f"{points} points, {counts.get('empty_texels', 0)} empty texels, of which {counts.get('filled_texels', 0)} are filled"
    name = f"imperfect shadow maps, {lights} of {made.way.shadow_lights.size}^2: {made.room.name}"
    limit = lambda c: limits.imperfect_maps(c, points, made.shadows.bytes)  # noqa: E731
    return stage(calibration, name, spent["shadow_lights"], SHADOWS[lights], limit, note)


def shade(calibration: Calibration, made: Pipeline, spent: dict[str, float]) -> Stage:
    """Loads from the maps bound it, as they do a march of cones."""
    counts: dict[str, Any] = made.shaded().counts.asdict()
    evaluations, lookups = counts.get("light_evaluations", 0), counts.get("shadow_lookups", 0)
    note = f"{evaluations / made.room.pixels:.2f} lights and {lookups / made.room.pixels:.1f} lookups a pixel"
    name = f"shading {len(made.lights)} lights with PCSS, interleaved 4 x 4: {made.room.name}"
    limit = lambda c: limits.virtual_lights(c, made.room.pixels, evaluations, lookups)  # noqa: E731
    return Stage(name, spent["shade_lights"], SHADING, limit, cones_scale(calibration), note)
