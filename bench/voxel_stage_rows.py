"""Each stage of voxel cone tracing alone, at three resolutions."""

from __future__ import annotations

import dataclasses
from typing import Any

import interreflect as ir
from bench import limits
from bench.calibration import Calibration
from bench.rows import Row, absent
from bench.sponza import Sponza
from bench.timing import least, timed
from bench.voxel_pipeline import INTERLEAVED, RESOLUTIONS, Limit, bounded, cones_scale, method, sunlit, sunlit_sponza
from interreflect import stages

REPEATS = 9
REPEATS_OF_LIGHT = 25  # injection is a small difference of two
SPACINGS = (0.8, 0.7, 0.7)  # of tessellated vertices, voxels: the widest, in steps of 0.1, that leave no holes
GLOSSY = "sponza_crytek/glossy.toml"
SOFTWARE, PROTOTYPE = "software OpenGL, older machine", "prototype, machine of the targets"
RASTERIZE, TESSELLATE, MAP, INJECT = (
    "voxelize, rasterized, 4 samples",
    "voxelize, tessellated, no holes",
    "light for injection, shadow map",
    "injection",
)
TRACED = "light and injection, traced"
FILTER, CONES, EVERY = "filtering, isotropic", "diffuse cones, interleaved 2 x 2", "diffuse cones, all six at every pixel"
GLOSSY_CONE = "glossy cone of 5 degrees, interleaved 2 x 2"
# Milliseconds at 64^3, 128^3 and 256^3: the target, and what a peer needs.
TARGETS: dict[str, tuple[tuple[float, float, float], tuple[str, tuple[float, float, float]] | None]] = {
    RASTERIZE: ((8, 15, 50), (SOFTWARE, (137, 148, 245))),
    TESSELLATE: ((8, 15, 60), (SOFTWARE + ", with holes", (125, 238, 522))),
    MAP: ((12, 12, 12), (SOFTWARE + ", 4096^2", (242, 242, 242))),
    INJECT: ((1, 3, 8), (SOFTWARE, (124, 124, 124))),
    TRACED: ((13, 15, 20), (SOFTWARE + ", 4096^2", (366, 366, 366))),  # of both rows above
    FILTER: ((0.2, 0.8, 5), (PROTOTYPE, (0.2, 0.8, 7))),
    CONES: ((60, 70, 80), (PROTOTYPE + ", not merged", (59, 73, 82))),
    EVERY: ((190, 230, 260), (PROTOTYPE, (217, 272, 313))),
    GLOSSY_CONE: ((60, 75, 90), None),
}


def rows(calibration: Calibration, sponza: Sponza) -> list[Row]:
    scene = sunlit_sponza(sponza)
    found = [row for k in range(len(RESOLUTIONS)) for row in _stages(calibration, sponza, scene, k)]
    return found + _glossy(calibration)


def _row(calibration: Calibration, stage: str, k: int, milliseconds: float, limit: Limit, **more: Any) -> Row:
    bounds, peer = TARGETS[stage]
    name = f"{stage}: {RESOLUTIONS[k]}^3"
    return bounded(name, milliseconds, bounds[k], limit, calibration, None if peer is None else (peer[0], peer[1][k]), **more)


def _stages(calibration: Calibration, sponza: Sponza, scene: ir.Scene, k: int) -> list[Row]:
    way = method(RESOLUTIONS[k])
    tessellation, every = ir.Tessellation(spacing=SPACINGS[k]), ir.EveryPixel()
    injection, isotropic = ir.ShadowMapInjection(), ir.VolumeCoverage()
    domain = stages.place(way.grid, scene, sponza.camera)
    voxels, tessellated = (stages.voxelize(technique, scene, domain) for technique in (way.voxelize, tessellation))
    patch = stages.voxelize(way.voxelize, scene, stages.place(_patch(scene, sponza), scene, sponza.camera))
    lit = stages.light_voxels(way.light_voxels, scene, voxels)
    pyramid = stages.prefilter(way.prefilter, lit)

    def march(share: Any) -> Any:
        return stages.march(way.march, pyramid, sponza.gbuffer, scene, share=share)

    light, light_patch, traced = least(
        timed(lambda: stages.light_voxels(injection, scene, voxels)),
        timed(lambda: stages.light_voxels(injection, scene, patch)),
        timed(lambda: stages.light_voxels(ir.TracedLighting(), scene, voxels)),
        repeats=REPEATS_OF_LIGHT,
    )
    rasterize, tessellate, filtered, shared, everywhere = least(
        timed(lambda: stages.voxelize(way.voxelize, scene, domain)),
        timed(lambda: stages.voxelize(tessellation, scene, domain)),
        timed(lambda: stages.prefilter(isotropic, lit)),
        timed(lambda: march(INTERLEAVED)),
        timed(lambda: march(every)),
        repeats=REPEATS,
    )
    texels, texels_bytes = injection.size**2, stages.prefilter(isotropic, lit).bytes
    rays = stages.light_voxels(ir.TracedLighting(), scene, voxels).counts.asdict()["shadow_rays"]
    holes = ir.voxel_coverage(tessellated, stages.voxelize(ir.ExactOverlap(), scene, domain))

    def voxelizing(grid: Any) -> Limit:
        samples = grid.counts.asdict()["samples"]
        return lambda c: limits.voxelize(c, sponza.vertices, sponza.triangles, samples, len(grid))

    def marching(share: Any) -> Limit:
        steps = march(share).counts.asdict()["cone_steps"]
        return lambda c: limits.cone_march(c, steps)

    def row(stage: str, milliseconds: float, limit: Limit, **more: Any) -> Row:
        return _row(calibration, stage, k, milliseconds, limit, **more)

    scale = cones_scale(calibration)
    closed = f"spacing {SPACINGS[k]}, {len(tessellated)} voxels, {holes.holes} holes of {holes.exact} voxels of the exact overlap"
    vertices = row(TESSELLATE, tessellate, voxelizing(tessellated), note=closed, details={"holes": holes.holes, "missing": holes.missing})
    return [
        row(RASTERIZE, rasterize, voxelizing(voxels), note=f"{len(voxels)} voxels"),
        dataclasses.replace(vertices, met=bool(vertices.met) and holes.holes == 0),
        row(MAP, light_patch, lambda c: limits.light_map(c, texels), note=f"map of {injection.size}^2; with injection {light:.2f} ms"),
        row(INJECT, light - light_patch, lambda c: limits.inject(c, texels, len(voxels)), note="what is left of the whole beside the map"),
        row(TRACED, traced, lambda c: limits.trace_lights(c, rays, len(voxels)), note="what TracedLighting does in place of both"),
        row(FILTER, filtered, lambda c: limits.prefilter(c, texels_bytes, len(voxels))),
        row(CONES, shared, marching(INTERLEAVED), scale=scale),
        row(EVERY, everywhere, marching(every), scale=scale),
    ]


def _patch(scene: ir.Scene, sponza: Sponza) -> ir.Grid:
    """A grid about one point of the surface: lighting it takes the map and hardly anything else."""
    middle = sponza.gbuffer.position[sponza.gbuffer.position.shape[0] // 2, sponza.gbuffer.position.shape[1] // 2]
    half = 1e-3 * float((scene.bounds[1] - scene.bounds[0]).max())
    sides = {f"{end}_{axis}": float(middle[i] + by) for end, by in (("lower", -half), ("upper", half)) for i, axis in enumerate("xyz")}
    return ir.Grid(resolution=2, region=ir.Box(**sides))


def _glossy(calibration: Calibration) -> list[Row]:
    try:
        scene = sunlit(ir.load_scene(GLOSSY))
    except FileNotFoundError:
        return [absent(GLOSSY_CONE, "at most 60, 75 and 90 ms", f"{GLOSSY} is not here")]
    gbuffer = stages.trace_gbuffer(scene, "nave", (1280, 720))
    cone = ir.GlossyCone(half_angle=5, share=INTERLEAVED)
    found = []
    for k, resolution in enumerate(RESOLUTIONS):
        way = method(resolution)
        voxels = stages.voxelize(way.voxelize, scene, stages.place(way.grid, scene, "nave"))
        pyramid = stages.prefilter(way.prefilter, stages.light_voxels(way.light_voxels, scene, voxels))
        milliseconds = least(timed(lambda p=pyramid: stages.glossy(cone, p, gbuffer, scene)), repeats=REPEATS)[0]
        steps = stages.glossy(cone, pyramid, gbuffer, scene).counts.asdict()["cone_steps"]
        limit: Limit = lambda c, n=steps: limits.cone_march(c, n)  # noqa: E731
        found.append(_row(calibration, GLOSSY_CONE, k, milliseconds, limit, scale=cones_scale(calibration)))
    return found
