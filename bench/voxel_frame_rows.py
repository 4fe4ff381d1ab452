"""Whole frames: every stage anew; warped beside linear grids; a paper's preset; and what a process holds while it renders."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import interreflect as ir
from bench import limits
from bench.calibration import TARGETS_MACHINE, Calibration
from bench.rows import Row
from bench.sponza import SIZE, Sponza
from bench.timing import least, timed
from bench.voxel_pipeline import RESOLUTIONS, bounded, cones_scale, measured, method, sunlit_sponza

ROOT = Path(__file__).resolve().parent.parent
REPEATS = 9
FRAMES, FRAME_CONES, FRAME_PEER = (130.0, 150.0, 220.0), (60.0, 70.0, 80.0), (2172.0, 2385.0, 2802.0)
PEER = "software OpenGL, older machine"
WARPED_TIMES = 1.5
MEBIBYTES, PEER_MEBIBYTES = 500.0, (675.0, 675.0, 767.0)
PRESET, PRESET_SIZES = "Freed 2018", ((1280, 720), (1600, 900), (1920, 1080))


def rows(calibration: Calibration, sponza: Sponza) -> list[Row]:
    scene = sunlit_sponza(sponza)
    found = [frame(calibration, sponza, scene, k) for k in range(len(RESOLUTIONS))]
    found += [warped(scene, resolution) for resolution in RESOLUTIONS]
    found += [preset(scene, size) for size in PRESET_SIZES]
    return found + [memory(k) for k in range(len(RESOLUTIONS))]


def frame(calibration: Calibration, sponza: Sponza, scene: ir.Scene, k: int) -> Row:
    """The bound grows as the cones' part by a plain march's steps, the rest as its limits."""
    prepared = method(RESOLUTIONS[k]).prepare(scene)
    profiles: list[Any] = [prepared.render("nave", size=SIZE).profile for _ in range(1 + REPEATS)][1:]
    fastest = min(profiles, key=lambda profile: profile.milliseconds)
    counts = {name: stage.counts for name, stage in fastest.stages.items()}
    voxels, texels_bytes = counts["voxelize"]["voxels"], fastest.stages["prefilter"].bytes

    def around(c: Calibration) -> float:
        voxelizing = limits.voxelize(c, sponza.vertices, sponza.triangles, counts["voxelize"]["samples"], voxels)
        lighting = limits.trace_lights(c, counts["light_voxels"]["shadow_rays"], voxels) + limits.prefilter(c, texels_bytes, voxels)
        return limits.gbuffer(c, sponza.pixels) + limits.sun_shadows(c, sponza.pixels) + voxelizing + lighting

    def limit(c: Calibration) -> float:
        return around(c) + limits.cone_march(c, counts["march"]["cone_steps"])

    rest = (FRAMES[k] - FRAME_CONES[k]) * around(calibration) / around(TARGETS_MACHINE)
    scale = (FRAME_CONES[k] * cones_scale(calibration) + rest) / FRAMES[k]
    stages = {name: round(min(profile.stages[name].milliseconds for profile in profiles), 2) for name in fastest.stages}
    note = "stages in ms: " + ", ".join(f"{name} {spent:g}" for name, spent in stages.items())
    name = f"frame, every stage anew: {RESOLUTIONS[k]}^3"
    peer = (PEER, FRAME_PEER[k])
    return bounded(name, fastest.milliseconds, FRAMES[k], limit, calibration, peer, scale, note=note, details={"stages": stages})


def warped(scene: ir.Scene, resolution: int) -> Row:
    """A frame in a grid warped about the camera beside one in a linear grid of as many voxels, in turn."""
    ways = [method(resolution, grid=ir.Grid(resolution=resolution, warp=warp)) for warp in (ir.CubicSpline(), ir.Linear())]
    bent, straight = (way.prepare(scene) for way in ways)
    profiles: dict[str, list[Any]] = {"bent": [], "straight": []}

    def work(name: str, prepared: Any) -> float:
        profiles[name].append(prepared.render("nave", size=SIZE).profile)
        return float(profiles[name][-1].milliseconds)

    ours, linear = least(lambda: work("bent", bent), lambda: work("straight", straight), repeats=REPEATS)
    least_of = {k: {s: min(p.stages[s].milliseconds for p in of) for s in of[0].stages} for k, of in profiles.items()}
    note = f"{ours / linear:.2f}x; stages over linear ones: " + ", ".join(
        f"{stage} {spent:.1f} / {least_of['straight'][stage]:.1f}" for stage, spent in least_of["bent"].items()
    )
    target, met = f"at most {WARPED_TIMES:g}x the linear grid", ours <= WARPED_TIMES * linear
    return Row(f"frame in a warped grid: {resolution}^3", ours, None, "the linear grid", linear, target, met, note=note)


def preset(scene: ir.Scene, size: tuple[int, int]) -> Row:
    prepared = ir.methods.VoxelConeTracing.preset(PRESET).prepare(scene)
    profiles: list[Any] = []

    def render() -> None:
        profiles.append(prepared.render("nave", size=size).profile)

    milliseconds = least(timed(render), repeats=2)[0]
    fastest = min(profiles, key=lambda profile: profile.milliseconds)
    note = "stages in ms: " + ", ".join(f"{name} {stage.milliseconds:.1f}" for name, stage in fastest.stages.items())
    peer = ("GTX 970", 11.12) if size == SIZE else None
    return measured(f"preset {PRESET}, frame: {size[0]} x {size[1]}", milliseconds, note, peer)


def memory(k: int) -> Row:
    """In a process of its own, its scene loaded before."""
    command = [sys.executable, str(Path(__file__).with_name("peak_memory.py")), str(RESOLUTIONS[k])]
    printed = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout
    peak: dict[str, float] = json.loads(printed.splitlines()[-1])
    note = f"{peak['rendering']:.0f} MiB while rendering, {peak['loading']:.0f} while loading; the peer's frame {PEER_MEBIBYTES[k]:g} MiB"
    target, met = f"at most {MEBIBYTES:g} MiB while rendering", peak["rendering"] <= MEBIBYTES
    return Row(f"peak memory: {RESOLUTIONS[k]}^3", None, None, PEER, None, target, met, note=note, details={"mebibytes": peak})
