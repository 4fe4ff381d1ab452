"""Loads a scene, traces one ray, prints the seconds since the start of this program and the peak of memory in MiB, as JSON."""

import time

START = time.perf_counter()

import json  # noqa: E402
import re  # noqa: E402
import sys  # noqa: E402
from pathlib import Path  # noqa: E402

import interreflect as ir  # noqa: E402

scene = ir.load_scene(sys.argv[1])
hit = ir.trace_gbuffer(scene, size=(1, 1))
seconds = time.perf_counter() - START
# Not getrusage: its maximum starts from that of the process that started this one.
peak = re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())
assert peak is not None
mebibytes = int(peak[1]) / 1024
print(json.dumps({"seconds": seconds, "mebibytes": mebibytes, "depth": float(hit.depth[0, 0])}))
