"""Studies of many cells: memory that stays, records that load, and little beside the cells."""

import dataclasses
import os
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest
from study_fakes import Fake, Scene

import interreflect.study.files as files
from interreflect.study.run import run
from interreflect.study.store import Store, load_records
from interreflect.study.study import Study

SCRIPT = textwrap.dedent("""
    import pathlib, sys
    import interreflect as ir
    folder = pathlib.Path(sys.argv[1])
    cones = [ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16 + k)) for k in range(10)]
    paths = [ir.methods.PathTracing(spp=1 + k % 2, bounces=k) for k in range(10)]
    methods = [method for pair in zip(cones, paths) for method in pair]
    seeds = range(int(sys.argv[2]))
    study = ir.Study(name="soak", scenes=[ir.scenes.cornell_box()], methods=methods, size=(64, 48), seeds=seeds, bounces=1,
                     repeats=1, max_repeats=1, reference=ir.Reference(noise=.5, max_spp=16), images=True)
    ir.run(study, folder)
""")


def resident(process):
    """Bytes that a process and its children hold; none where it is gone."""
    total = 0
    for pid in [process, *Path(f"/proc/{process}/task/{process}/children").read_text().split()]:
        total += int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return total


@pytest.mark.long
def test_memory_is_flat_over_a_thousand_cells(tmp_path):
    """Within 5 % after the first fifty, of the study and its worker together; twenty methods of two kinds in turn, fifty seeds each."""
    package = Path(__file__).parents[2] / "python"
    (tmp_path / "script.py").write_text(SCRIPT)
    environment = os.environ | {"PYTHONPATH": str(package), "INTERREFLECT_CACHE": str(tmp_path / "cache")}
    process = subprocess.Popen([sys.executable, str(tmp_path / "script.py"), str(tmp_path / "r"), "50"], env=environment)
    early, late = [], []
    while process.poll() is None:
        done = len(list((tmp_path / "r").glob("cells/*.json")))
        try:
            held = resident(process.pid)
        except OSError:
            continue  # it has ended, or its worker
        if 50 <= done < 200:
            early.append(held)
        if 800 <= done < 990:
            late.append(held)
        time.sleep(0.05)
    assert process.returncode == 0
    assert early and late
    assert max(late) < 1.05 * max(early), f"{max(early) / 2**20:.1f} MiB, then {max(late) / 2**20:.1f}"


@pytest.mark.long
def test_ten_thousand_records_load_in_a_second(tmp_path, fake_truth, monkeypatch):
    """Processor time, which other programs do not lengthen as they do the clock's; the files are in the system's page cache."""
    record = run(Study(name="s", scenes=[Scene()], methods=[Fake()], size=(32, 24), repeats=30, images=False), tmp_path / "r")[0]
    monkeypatch.setattr(files.os, "fsync", lambda _: None)
    store, cells = Store(tmp_path / "r"), []
    for k in range(10_000):
        key = f"{k:032x}"
        store.write(dataclasses.replace(record, key=key, seed=k))
        cells.append({"key": key, "scene": "plain", "camera": "front"})
    store.begin("s", cells)
    times = []
    for _ in range(3):
        start = time.process_time()
        assert len(load_records(tmp_path / "r")) == 10_000
        times.append(time.process_time() - start)
    assert min(times) < 1.0
