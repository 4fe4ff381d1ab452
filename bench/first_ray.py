"""Loads a scene, traces one ray, prints the seconds since the start of this program and the peak of memory in MiB, as JSON."""

import time

START = time.perf_counter()

import json  # noqa: E402
import resource  # noqa: E402
import sys  # noqa: E402

import interreflect as ir  # noqa: E402

scene = ir.load_scene(sys.argv[1])
hit = ir.trace_gbuffer(scene, size=(1, 1))
seconds = time.perf_counter() - START
mebibytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps({"seconds": seconds, "mebibytes": mebibytes, "depth": float(hit.depth[0, 0])}))
