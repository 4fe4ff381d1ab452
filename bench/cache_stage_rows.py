"""Each stage of clustered radiance caching beside its target, and their sum."""

from __future__ import annotations

from bench import limits
from bench.cache_pipeline import Cars, steps_of
from bench.calibration import TARGETS_MACHINE, Calibration
from bench.rows import Row
from bench.timing import least, timed
from bench.voxel_pipeline import Limit, bounded, cones_scale
from interreflect import stages

REPEATS = 9
PAPER = "GTX 670"
# Milliseconds: the target, and the paper's.
LIGHT, DISTRIBUTE, CREATE, EVALUATE, TOTAL = (60, 27), (25, 31), (160, 39), (80, 33.5), (325, 131)


def rows(calibration: Calibration, cars: Cars) -> list[Row]:
    way, scene = cars.method, cars.scene
    spent = least(
        timed(lambda: stages.light_voxels(way.light_voxels, scene, cars.voxels)),
        timed(lambda: stages.distribute(way.distribute, cars.gbuffer, scene)),
        timed(lambda: stages.fill(way.fill, cars.places, cars.pyramid, scene)),
        timed(lambda: stages.preconvolve(way.preconvolve, cars.filled)),
        timed(lambda: stages.interpolate(way.interpolate, cars.convolved, cars.gbuffer, scene, cars.pyramid, way.fill, way.preconvolve)),
        repeats=REPEATS,
    )
    light, distribution, filling, convolving, evaluation = spent
    counts = cars.filled.counts.asdict()
    lit = stages.light_voxels(way.light_voxels, scene, cars.voxels)
    received = stages.interpolate(way.interpolate, cars.convolved, cars.gbuffer, scene, cars.pyramid, way.fill, way.preconvolve)
    read = received.counts.asdict()
    bounds: tuple[Limit, ...] = (
        lambda c: limits.cone_march(c, steps_of(lit)),
        lambda c: limits.distribute(c, cars.pixels),
        lambda c: limits.create(c, counts["cone_steps"], cars.filled.bytes),
        lambda c: limits.evaluate(c, cars.pixels, read["cache_evaluations"]),
    )
    grown = [bound(calibration) / bound(TARGETS_MACHINE) for bound in bounds]
    scales = [cones_scale(calibration), grown[1], cones_scale(calibration), grown[3]]
    targets = (LIGHT, DISTRIBUTE, CREATE, EVALUATE)
    total = sum(target[0] * scale for target, scale in zip(targets, scales, strict=True))
    caches, covered = len(cars.places), read["covered_pixels"] / (read["covered_pixels"] + read["uncovered_pixels"])
    made = [
        ("voxel lighting with shadow cones", light, LIGHT, bounds[0], f"{len(cars.voxels)} voxels, {lit.counts.asdict()['cones']} cones"),
        ("distribution", distribution, DISTRIBUTE, bounds[1], f"{caches} caches of 4096 wanted, tiles of {cars.places.tile} pixels"),
        (
            "creation and pre-convolution", filling + convolving, CREATE, bounds[2],
            f"{counts['cones']} cones, {counts['cone_steps']} steps; filling {filling:.1f}, pre-convolving {convolving:.1f} ms",
        ),
        (
            "evaluation by gathering, two tiles", evaluation, EVALUATE, bounds[3],
            f"{read['cache_evaluations'] / cars.pixels:.1f} caches a pixel, {100 * covered:.2f} % of the pixels covered",
        ),
        (
            "total without direct light and G-buffer", sum(spent), TOTAL, lambda c: sum(bound(c) for bound in bounds),
            "voxel lighting, distribution, creation, evaluation",
        ),
    ]  # fmt: skip
    by = [*scales, total / sum(target[0] for target in targets)]
    return [
        bounded(name, milliseconds, target, limit, calibration, (PAPER, paper), scale, note=note)
        for (name, milliseconds, (target, paper), limit, note), scale in zip(made, by, strict=True)
    ]
