"""Worker processes: what takes one along is a row, and none outlives the study that started it."""

import math
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest
from study_fakes import Fake, Scene, lasting

import interreflect as ir
import interreflect.study.workers as workers
from interreflect.study.run import run
from interreflect.study.store import load_records
from interreflect.study.study import Study

PACKAGE, HERE = Path(__file__).parents[2] / "python", Path(__file__).parent
MIB = 2**20


def study_of(*modes, **changes):
    values = {
        "name": "s",
        "scenes": [Scene()],
        "methods": [Fake(mode=mode) for mode in modes],
        "size": (32, 24),
        "repeats": 1,
        "max_repeats": 1,
    }
    return Study(**values | changes)


@pytest.mark.usefixtures("fake_truth")
@pytest.mark.parametrize(
    ("mode", "words", "limits"),
    [
        ("crashes", "ended by SIGSEGV", {}),
        ("is killed", "ended by SIGKILL", {}),
        ("leaves", "exit code 3", {}),
        ("hangs", "timeout: not done after 0.5 s", {"timeout": 0.5}),
        ("eats memory", r"memory: \d+ MiB, at most 300 MiB", {"memory": 300 * MIB}),
    ],
)
def test_a_cell_that_takes_its_worker_along_is_a_row_and_the_study_goes_on(tmp_path, mode, words, limits):
    table = run(study_of("ok", mode, "nan"), tmp_path / "r", **limits).table
    assert list(table["status"]) == ["ok", "failed", "not finite"]
    assert table["failure"].str.contains(words)[1], table["failure"][1]
    assert math.isnan(table["relmse"][1])


@pytest.mark.usefixtures("fake_truth")
def test_a_cell_that_failed_for_a_limit_is_tried_again_under_a_wider_one_only(tmp_path, monkeypatch):
    monkeypatch.setenv("STUDY_FAKES_RENDERS", str(tmp_path / "renders"))
    study = study_of("hangs", "ok")
    renders = []
    for timeout in (0.3, 0.3, 0.2, 0.6):
        run(study, tmp_path / "r", timeout=timeout)
        renders.append(len((tmp_path / "renders").read_bytes()))
    assert renders == [3, 3, 3, 4]  # the warm-up that hangs; warm-up and one repeat; then the first again
    assert "0.6 s" in load_records(tmp_path / "r")[0].failure


def test_a_worker_that_stays_knows_the_cameras_of_a_scene_of_the_same_content(tmp_path):
    first = ir.scenes.cornell_box()
    second = first.replace(cameras={"other": first.camera})
    assert first.hash == second.hash
    for number, scene in enumerate((first, second)):
        study = Study(
            name=f"cameras {number}", scenes=[scene], methods=[ir.methods.ConstantAmbient()], size=(16, 12), bounces=1, repeats=0,
            reference=ir.Reference(noise=1.0, max_spp=4),
        )  # fmt: skip
        (record,) = run(study, tmp_path / str(number))
        assert record.status == "ok", record.failure


@pytest.mark.usefixtures("fake_truth")
def test_peak_memory_is_what_a_method_holds_at_most(tmp_path):
    big, small = run(study_of("eats memory briefly", "ok"), tmp_path / "r").table["peak_memory_bytes"]
    assert big - small == pytest.approx(256 * MIB, rel=0.05)  # what it allocates; scene and truth are in both
    assert 0 <= small < 64 * MIB


@pytest.mark.usefixtures("fake_truth")
def test_what_a_method_prints_reaches_standard_error(tmp_path, capfd):
    run(study_of("prints"), tmp_path / "r")
    assert "a word from a method" in capfd.readouterr().err


@pytest.mark.usefixtures("fake_truth")
def test_a_worker_that_cannot_start_stops_the_study_with_its_reason(tmp_path, monkeypatch):
    workers._end_resting()
    broken = tmp_path / "python"
    broken.write_text("#!/bin/sh\necho No module named interreflect >&2\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(broken))
    with pytest.raises(RuntimeError, match="exit code 1: No module named"):
        run(study_of("ok"), tmp_path / "r")


@pytest.fixture
def script():
    """Starts scripts, and ends at last those that still run: one that a failed test left would keep its locks from the next."""
    started = []

    def start(folder, body):
        started.append(started_script(folder, body))
        return started[-1]

    yield start
    for process in started:
        process.kill()
        process.wait()


def started_script(folder, body):
    """A script without a `__main__` guard, with a method of its own. A shell's background job ignores interrupts: the script must not."""
    code = f"""
        import pathlib, signal, sys, time
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.path.insert(0, {str(HERE)!r})
        from study_fakes import Fake, FakePrepared, Scene, use_fake_truth
        from interreflect.study.run import run
        from interreflect.study.study import Study
        folder = pathlib.Path({str(folder)!r})
        use_fake_truth(folder / "truths")
        class Mine(Fake):
            def prepare(self, scene, threads=None):
                (folder / "began").touch()
                time.sleep(self.time)
                return FakePrepared(self, scene)
        {body}
    """
    (folder / "script.py").write_text(textwrap.dedent(code))
    return subprocess.Popen(
        [sys.executable, str(folder / "script.py")], env=os.environ | {"PYTHONPATH": str(PACKAGE)}, stderr=subprocess.PIPE, text=True
    )


RUN = 'run(Study(name="s", scenes=[Scene()], methods=[Mine(time={time})], size=(32, 24), repeats=1, max_repeats=1), folder / "r")'


def workers_of(process):
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(child) for child in children]


def wait_until(condition, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "not in time"
        time.sleep(0.002)


def test_a_method_of_a_script_without_a_main_guard_is_measured(tmp_path, script):
    process = script(tmp_path, RUN.format(time=0))
    assert process.wait(60) == 0, process.stderr.read()
    assert load_records(tmp_path / "r")[0].status == "ok"


@pytest.mark.parametrize("to_group", [False, True])
def test_an_interrupt_is_honoured_within_a_fifth_of_a_second_and_leaves_no_worker(tmp_path, to_group, script):
    process = script(tmp_path, f"import os; os.setpgid(0, 0); {RUN.format(time=600)}")
    wait_until((tmp_path / "began").exists)
    (worker,) = workers_of(process)
    start = time.monotonic()
    os.killpg(process.pid, signal.SIGINT) if to_group else process.send_signal(signal.SIGINT)
    wait_until(lambda: not Path(f"/proc/{worker}").exists())
    assert time.monotonic() - start < 0.2
    assert process.wait(10) != 0  # Python's own way out: imports to unload, a traceback to print
    assert "KeyboardInterrupt" in process.stderr.read()


def test_a_worker_ends_with_its_parent_in_the_middle_of_a_cell(tmp_path, script):
    process = script(tmp_path, RUN.format(time=600))
    wait_until((tmp_path / "began").exists)
    (worker,) = workers_of(process)
    process.kill()
    process.wait()
    wait_until(lambda: not Path(f"/proc/{worker}").exists(), 2)


@pytest.mark.usefixtures("fake_truth")
def test_two_runs_share_a_folder_without_measuring_a_cell_twice(tmp_path, monkeypatch, script):
    monkeypatch.setenv("STUDY_FAKES_RENDERS", str(tmp_path / "renders"))
    runs = [script(tmp_path, SHARED) for _ in range(2)]
    for process in runs:
        assert process.wait(100) == 0, process.stderr.read()
    assert len((tmp_path / "renders").read_bytes()) == 2 * 12
    tables = [lasting(load_records(tmp_path / "r").table), lasting(run(study_of(*["ok"], **TWELVE), tmp_path / "alone").table)]
    assert list(tables[0]["error"]) == list(tables[1]["error"])
    assert list(tables[0]["relmse"]) == list(tables[1]["relmse"])
    assert not list((tmp_path / "r").rglob("*.part")) + list((tmp_path / "r").rglob("*.damaged"))


TWELVE = {"methods": [Fake(error=0.1 + 0.01 * k) for k in range(12)]}
SHARED = (
    'run(Study(name="s", scenes=[Scene()], methods=[Fake(error=.1 + .01 * k) for k in range(12)], size=(32, 24), repeats=1, max_repeats=1),'
    ' folder / "r")'
)
