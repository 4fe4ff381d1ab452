"""A study killed at random moments: nothing torn, and the same table as an unbroken run."""

import os
import random
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pandas as pd
import pytest
from study_fakes import lasting

from interreflect.study.store import load_records

SCRIPT = textwrap.dedent("""
    import dataclasses, pathlib, sys, time
    sys.path.insert(0, sys.argv[1])
    from study_fakes import Fake, FakePrepared, Scene, use_fake_truth
    from interreflect.study.run import run
    from interreflect.study.study import Study, sweep

    folder = pathlib.Path(sys.argv[2])
    use_fake_truth(folder / "truths")

    class Slow(Fake):
        def prepare(self, scene, threads=None):
            time.sleep(.02)
            return FakePrepared(self, scene)

    methods = sweep(Slow, {"error": [.1, .2, .3, .4], "mode": ["ok", "nan", "raises"]})
    scenes = [Scene(), Scene("bright", 3.0)]
    run(Study(name="kill", scenes=scenes, methods=methods, seeds=range(2), size=(64, 48), repeats=1), folder / "r")
""")
CELLS = 48


@pytest.mark.parametrize("kills", [3, pytest.param(100, marks=pytest.mark.long)])
def test_a_killed_study_resumes_to_the_table_of_an_unbroken_one(tmp_path, kills):
    (tmp_path / "script.py").write_text(SCRIPT)

    def start(folder):
        package = Path(__file__).parents[2] / "python"
        command = [sys.executable, str(tmp_path / "script.py"), str(Path(__file__).parent), str(tmp_path / folder)]
        environment = os.environ | {"PYTHONPATH": str(package)}
        return subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True)

    def cells(folder):
        return len(list((tmp_path / folder / "r").glob("cells/*.json")))

    whole = start("whole")
    assert whole.wait(60) == 0, whole.stderr.read()
    chance, before = random.Random(kills), 0
    for kill in range(kills):
        process = start("killed")
        goal = (CELLS - 2) * kill // kills
        while cells("killed") <= goal and process.poll() is None:
            time.sleep(0.001)
        time.sleep(chance.uniform(0, 0.06))  # about one cell
        os.killpg(process.pid, signal.SIGKILL)  # the workers too
        assert process.wait() == -signal.SIGKILL, process.stderr.read()
        assert before <= cells("killed") < CELLS, "a kill lost a cell, or came too late"
        before = cells("killed")
    last = start("killed")
    assert last.wait(60) == 0, last.stderr.read()
    tables = [lasting(load_records(tmp_path / folder / "r").table) for folder in ("whole", "killed")]
    assert len(tables[0]) == CELLS
    pd.testing.assert_frame_equal(*tables)
    assert not list(tmp_path.rglob("*.part")) + list(tmp_path.rglob("*.damaged"))


def test_an_interrupt_leaves_a_study_that_resumes(tmp_path, fake_truth):
    from study_fakes import Fake, FakePrepared, Scene

    from interreflect.study.run import run
    from interreflect.study.study import Study

    class Interrupted(Fake):
        def prepare(self, scene, threads=None):
            if self.error == 0.3 and not (tmp_path / "interrupted").exists():
                (tmp_path / "interrupted").touch()
                raise KeyboardInterrupt
            return FakePrepared(self, scene)

    study = Study(name="stop", scenes=[Scene()], methods=[Interrupted(error=e) for e in (0.1, 0.2, 0.3, 0.4)], size=(32, 24), repeats=1)
    with pytest.raises(KeyboardInterrupt):
        run(study, tmp_path / "r")
    records = load_records(tmp_path / "r")
    assert (len(records), records.missing) == (2, 2)
    assert len(run(study, tmp_path / "r")) == 4
