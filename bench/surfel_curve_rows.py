"""How the precomputation of setting 1 grows with the surfels, from a thousand to a million: at most as n log n."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import interreflect as ir
from bench.rows import Row, within
from bench.voxel_pipeline import measured
from interreflect import stages

ASKED = (1024, 8192, 65536, 262144, 1048576)


def rows(scene: ir.Scene) -> list[Row]:
    """Surfels, tree and links of one light map and grid; each row's bound is the one before, grown by n log n."""
    way: Any = ir.methods.IlluminanceComposition.preset("setting 1")
    sites = stages.place_caches(way.place_caches, scene, None, scene)
    found: list[Row] = []
    before: tuple[float, int] | None = None
    for asked in ASKED:
        placed, placing = spent(lambda n=asked: stages.place_surfels(way.place_surfels.replace(surfels=n), scene))
        tree, clustering = spent(lambda p=placed: stages.cluster_surfels(way.cluster_surfels, p))
        _, linking = spent(lambda t=tree: stages.link(way.link, sites, t, scene))
        whole, n = placing + clustering + linking, len(tree)
        note = f"{n} surfels: placed in {placing / 1e3:.2f} s, clustered in {clustering / 1e3:.2f} s, linked in {linking / 1e3:.2f} s"
        name = f"precomputation of {asked} surfels"
        if before is None:
            found.append(measured(name, whole, note))
        else:
            found.append(within(name, whole, None, before[0] * grown(n) / grown(before[1]), note=note))
        before = (whole, n)
    return found


def grown(n: int) -> float:
    return n * math.log2(n)


def spent(call: Callable[[], Any]) -> tuple[Any, float]:
    """What a call returns, and its milliseconds; once, as seconds need no minimum."""
    start = time.perf_counter()
    made = call()
    return made, 1e3 * (time.perf_counter() - start)
