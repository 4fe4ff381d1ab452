"""Writing behind the study's back: in order, whole or not at all, and never silently not."""

from __future__ import annotations

import dataclasses
import os
import threading
import time
from typing import Any

import numpy as np
import pytest
from study_fakes import Fake, Scene

from interreflect.study import measure
from interreflect.study.measure import Bench
from interreflect.study.messages import Phase, Pictures, receive, send
from interreflect.study.plan import Plan
from interreflect.study.reference import Reference
from interreflect.study.run import run
from interreflect.study.store import Store, load_records
from interreflect.study.study import Study
from interreflect.study.workers import Limits


def study(**more: Any) -> Study:
    return Study(name="w", scenes=[Scene()], methods=[Fake(error=0.1), Fake(error=0.2)], size=(32, 24), repeats=1, **more)


def test_a_folder_that_cannot_be_written_ends_the_study_and_leaves_no_record(tmp_path, fake_truth, monkeypatch):
    def full(*_: Any) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr(Store, "write", full)
    with pytest.raises(OSError, match="no space left"):
        run(study(), tmp_path / "r")
    assert not list((tmp_path / "r").glob("cells/*"))


@pytest.mark.parametrize("what", ["write", "write_pictures"])
def test_nothing_is_written_while_a_frame_is_timed(tmp_path, fake_truth, monkeypatch, what):
    writing, met = tmp_path / "writing", tmp_path / "met"
    keep = getattr(Store, what)

    def slow(self: Store, *cell: Any) -> None:
        writing.touch()
        time.sleep(0.1)
        keep(self, *cell)
        writing.unlink()

    monkeypatch.setattr(Store, what, slow)

    class Watching(Fake):
        def prepare(self, scene: Any, threads: Any = None) -> Any:
            prepared = super().prepare(scene, threads)
            render, calls = prepared.render, []

            def watched(*given: Any, **named: Any) -> Any:
                calls.append(None)
                if len(calls) > 1:  # the first call warms up
                    with met.open("a") as file:
                        file.write("in the way\n" if writing.exists() else "alone\n")
                return render(*given, **named)

            object.__setattr__(prepared, "render", watched)  # a frozen value
            return prepared

    watched = Study(name="w", scenes=[Scene()], methods=[Watching(error=e) for e in (0.1, 0.2, 0.3)], size=(32, 24), repeats=2)
    run(watched, tmp_path / "r")
    assert len(met.read_text().splitlines()) >= 6 and set(met.read_text().splitlines()) == {"alone"}


def test_pictures_and_records_are_whole_when_a_run_returns(tmp_path, fake_truth):
    records = run(study(), tmp_path / "r")
    again = load_records(tmp_path / "r")
    assert len(again) == 2 and all(again.has_images(record) for record in again)
    assert np.array_equal(records.images(records[0])[0], again.images(again[0])[0])


def test_the_pictures_are_on_their_way_before_the_metrics_are_computed(tmp_path, fake_truth, monkeypatch):
    order: list[str] = []

    def say(message: Phase | Pictures) -> None:
        order.append(message.name if isinstance(message, Phase) else "pictures")

    compare = measure.compare
    monkeypatch.setattr(measure, "compare", lambda *given: (order.append("compared"), compare(*given))[1])
    with Plan(study(), tmp_path / "r", Limits()) as plan:
        request = dataclasses.replace(plan.request(0), scene=plan.scene_of(0)(), repeats=0)
    assert Bench(say, lambda: None).measure(request).changes["status"] == "ok"
    assert order[-3:] == ["metrics", "pictures", "compared"]


def test_the_studys_bar_is_told_how_far_a_truth_is(tmp_path, fake_truth):
    told: list[Phase | Pictures] = []
    wanted = Study(name="w", scenes=[Scene()], methods=[Fake()], size=(32, 24), repeats=0, reference=Reference(1e-9, 64))
    with Plan(wanted, tmp_path / "r", Limits()) as plan:
        request = dataclasses.replace(plan.request(0), scene=plan.scene_of(0)())
    assert Bench(told.append, lambda: None).measure(request).changes["truth_spp"] == 64
    words = [message.detail for message in told if isinstance(message, Phase) and message.name == "truth" and message.detail]
    assert words[0].startswith("0 of 64 spp") and "left" in words[0]
    assert words[-1].startswith("64 of 64 spp, noise ")


def test_no_record_speaks_of_pictures_that_could_not_be_written(tmp_path, fake_truth, monkeypatch):
    def full(*_: Any) -> None:
        time.sleep(0.2)  # until the record has been handed over
        raise OSError("no space left on device")

    monkeypatch.setattr(Store, "write_pictures", full)
    with pytest.raises(OSError, match="no space left"):
        run(study(), tmp_path / "r")
    assert not list((tmp_path / "r").glob("cells/*"))


def test_a_picture_that_cannot_be_compared_leaves_no_file(tmp_path, fake_truth):
    small = Study(name="w", scenes=[Scene()], methods=[Fake(mode="small"), Fake()], size=(32, 24), repeats=1)
    records = run(small, tmp_path / "r")
    assert [record.images for record in records] == [False, True]
    assert [path.stem for path in (tmp_path / "r" / "images").iterdir()] == [records[1].key]


def test_pictures_larger_than_a_pipe_arrive_as_they_were_and_can_be_written_to():
    theirs, ours = os.pipe()
    light = np.random.default_rng(1).random((300, 400, 3), np.float32)  # 1.4 MB
    with open(theirs, "rb", buffering=0) as reading, open(ours, "wb") as writing:
        sender = threading.Thread(target=send, args=(writing, Pictures((light, light[::2]), ("key", (light, light.T)))))
        sender.start()
        received = receive(reading)
        sender.join()
    for sent, got in zip((light, light[::2], light, light.T), (*received.cell, *received.truth[1]), strict=True):
        assert np.array_equal(sent, got)
    received.cell[0][0] = 0
