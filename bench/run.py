"""Measures a suite beside its limits and peers: prints the table, writes results/bench/<suite>.json. Called by ./run bench [suite]."""

from __future__ import annotations

import importlib
import json
import os
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SUITES = ("core", "voxels", "caches", "virtual-lights", "surfels")


def main(suite: str) -> None:
    if suite not in SUITES:
        sys.exit(f"there is no suite {suite!r}; there are {', '.join(SUITES)}")
    sys.path[0:1] = [str(ROOT), str(ROOT / "build" / "bench" / "bench")]  # in place of this script's own folder
    from bench import rows

    start, load = time.perf_counter(), os.getloadavg()[0]
    calibration, measured = importlib.import_module(f"bench.{suite.replace('-', '_')}").run(importlib.import_module("_peers"))
    results = ROOT / "results" / "bench"
    rows.write(measured, results / f"{suite}.json")
    (results / f"{suite}_calibration.json").write_text(json.dumps(calibration.asdict(), indent=1) + "\n")
    print(
        f"read {calibration.read:.1f} GB/s, triad {calibration.triad:.1f} GB/s, multiply-add {calibration.multiply_add:.0f} GFLOP/s "
        f"({8 * calibration.vector_bytes} bits, {calibration.threads} threads), cone steps {calibration.cone_steps:.0f} million a second"
    )
    for kind, rates in calibration.rays.items():
        print(f"{kind} rays, million a second: " + ", ".join(f"{call} {rate:.1f}" for call, rate in rates.items()))
    rows.show(measured)
    met = sum(row.met is True for row in measured)
    print(f"{met} of {len(measured)} targets met, in {time.perf_counter() - start:.0f} s")
    print(f"load {load:.1f} before, {os.getloadavg()[0]:.1f} after")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "core")
