"""Renders frames at a resolution and prints the peak of this process's memory while it loaded and while it rendered, MiB, as JSON."""

import json
import re
import sys
from pathlib import Path

sys.path[0:1] = [str(Path(__file__).resolve().parent.parent)]

import interreflect as ir  # noqa: E402
from bench.sponza import PATH, SIZE  # noqa: E402
from bench.voxel_pipeline import method, sunlit  # noqa: E402


def peak() -> float:
    found = re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())
    assert found is not None
    return int(found[1]) / 1024


prepared = method(int(sys.argv[1])).prepare(sunlit(ir.load_scene(PATH)))
loading = peak()
Path("/proc/self/clear_refs").write_text("5")  # the peak starts anew from what is held
for seed in range(3):
    prepared.render("nave", size=SIZE, seed=seed)
print(json.dumps({"loading": loading, "rendering": peak()}))
