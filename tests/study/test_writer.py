"""Writing behind the study's back: in order, whole or not at all, and never silently not."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
from study_fakes import Fake, Scene

from interreflect.study.run import run
from interreflect.study.store import Store, load_records
from interreflect.study.study import Study


def study(**more: Any) -> Study:
    return Study(name="w", scenes=[Scene()], methods=[Fake(error=0.1), Fake(error=0.2)], size=(32, 24), repeats=1, **more)


def test_a_folder_that_cannot_be_written_ends_the_study_and_leaves_no_record(tmp_path, fake_truth, monkeypatch):
    def full(*_: Any) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr(Store, "write", full)
    with pytest.raises(OSError, match="no space left"):
        run(study(), tmp_path / "r")
    assert not list((tmp_path / "r").glob("cells/*"))


def test_nothing_is_written_while_a_frame_is_timed(tmp_path, fake_truth, monkeypatch):
    writing, met = tmp_path / "writing", tmp_path / "met"
    keep = Store.write

    def slow(self: Store, *cell: Any) -> None:
        writing.touch()
        time.sleep(0.1)
        keep(self, *cell)
        writing.unlink()

    monkeypatch.setattr(Store, "write", slow)

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
