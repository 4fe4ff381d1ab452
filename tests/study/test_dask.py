"""Studies on a cluster: two processes of this machine that Dask takes for hosts' workers."""

import itertools
import math
import os
import subprocess
import sys
from pathlib import Path

import pytest
import study_fakes
from study_fakes import Fake, Scene, lasting
from typer.testing import CliRunner

from interreflect.cli import app
from interreflect.study import dask
from interreflect.study.run import run
from interreflect.study.store import load_records
from interreflect.study.study import Study, sweep

distributed = pytest.importorskip("distributed", reason="needs the extra `distributed`")


def study_of(methods, **changes):
    values = {"name": "far", "scenes": [Scene()], "methods": methods, "size": (32, 24), "repeats": 1, "max_repeats": 1}
    return Study(**values | changes)


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """A cluster of two workers whose truths are fakes, and the folder that all of its notes go to."""
    folder = tmp_path_factory.mktemp("cluster")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("INTERREFLECT_CACHE", str(folder / "cache"))
        patch.setenv(study_fakes.TRUTH, "1")
        patch.setenv("STUDY_FAKES_RENDERS", str(folder / "renders"))
        patch.setenv("STUDY_FAKES_SPANS", str(folder / "spans"))
        patch.setenv("STUDY_FAKES_MEETING", str(folder / "meeting"))
        options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None, "local_directory": str(folder)}
        with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
            yield client, folder


def test_a_cluster_measures_what_one_machine_measures(shared, tmp_path):
    client, _ = shared
    methods = [*sweep(Fake, {"error": [0.1, 0.2], "mode": ["ok", "nan"]}), Fake(mode="crashes")]
    study = study_of(methods, scenes=[Scene(), Scene("bright", 3.0)])
    far = run(study, tmp_path / "far", client=client)
    near = run(study, tmp_path / "near")
    assert len(far) == 10
    assert lasting(far.table).equals(lasting(near.table))
    assert all(far.has_images(record) for record in far if record.status != "failed")


def test_timed_cells_are_alone_on_a_host(shared, tmp_path):
    client, folder = shared
    (folder / "spans").write_text("")
    run(study_of([Fake(error=0.1 * k, mode="takes its time") for k in range(1, 7)]), tmp_path / "r", client=client)
    spans = sorted(tuple(map(float, line.split())) for line in (folder / "spans").read_text().splitlines())
    assert len(spans) == 12  # a warm-up and a repeat each
    assert all(later[0] >= earlier[1] for earlier, later in itertools.pairwise(spans))


def test_untimed_cells_run_side_by_side_on_a_host(shared, tmp_path):
    client, folder = shared
    (folder / "meeting").mkdir()
    records = run(study_of([Fake(error=0.1 * k, mode="meets another") for k in (1, 2)], repeats=0), tmp_path / "r", client=client)
    assert [record.failure for record in records] == ["", ""]


def test_a_process_of_the_cluster_that_dies_costs_its_cell_a_retry(shared, tmp_path):
    client, _ = shared
    pids = client.run(os.getpid)
    killer = f"import os, signal, time; time.sleep(.6); os.kill({next(iter(pids.values()))}, signal.SIGKILL)"
    process = subprocess.Popen([sys.executable, "-c", killer])
    study = study_of([Fake(error=0.1 * k, mode="takes its time") for k in range(1, 9)], repeats=0)
    records = run(study, tmp_path / "r", client=client)
    assert process.poll() == 0  # it died meanwhile
    assert list(records.table["status"]) == ["ok"] * 8
    assert all(math.isfinite(error) for error in records.table["relmse"])
    client.wait_for_workers(2, timeout=30)


def test_an_interrupt_ends_the_cells_under_way(shared, tmp_path, monkeypatch):
    client, folder = shared
    (folder / "renders").write_bytes(b"")
    collect = dask._Dispatch._collect

    def collect_until_both_hang(self):
        if len((folder / "renders").read_bytes()) == 2:
            raise KeyboardInterrupt
        collect(self)

    monkeypatch.setattr(dask._Dispatch, "_collect", collect_until_both_hang)
    with pytest.raises(KeyboardInterrupt):
        run(study_of([Fake(error=e, mode="hangs") for e in (0.1, 0.2)], repeats=0), tmp_path / "r", client=client)
    # Both processes have one thread each; the cells would have kept them for ten minutes.
    assert [task.result(timeout=30) for task in client.map(abs, [-1, -2], pure=False)] == [1, 2]


def test_a_cluster_resumes_what_one_machine_began(shared, tmp_path):
    client, folder = shared
    run(study_of([Fake()]), tmp_path / "r")
    (folder / "renders").write_bytes(b"")
    assert len(run(study_of([Fake(), Fake(error=0.3)]), tmp_path / "r", client=client)) == 2
    assert len((folder / "renders").read_bytes()) == 2


def test_the_command_line_takes_a_scheduler(shared, tmp_path):
    client, _ = shared
    code = f"""
import sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from study_fakes import Fake, Scene
from interreflect.study.study import Study
study = Study(name="far", scenes=[Scene()], methods=[Fake()], size=(32, 24), repeats=1)
"""
    (tmp_path / "far.py").write_text(code)
    options = ["--out", str(tmp_path / "r"), "--dask", client.scheduler.address, "--timeout", "60", "--memory", "4096"]
    done = CliRunner().invoke(app, ["study", str(tmp_path / "far.py"), *options], catch_exceptions=False)
    assert done.exit_code == 0 and "1 cells" in done.output
    assert load_records(tmp_path / "r")[0].status == "ok"


def test_what_is_no_client_is_refused(tmp_path):
    with pytest.raises(TypeError, match=r"client must be a distributed\.Client, got object"):
        run(study_of([Fake()]), tmp_path / "r", client=object())
    assert not (tmp_path / "r").exists()
