"""Values show themselves in notebooks, long work shows a bar there, and interrupting it keeps what was done."""

import textwrap
import time
from html.parser import HTMLParser
from pathlib import Path

import pytest
from study_fakes import Fake, Scene

import interreflect as ir
from interreflect import _core, progress
from interreflect.study.store import load_records
from interreflect.study.study import Study


class Balance(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.text = [], ""

    def handle_starttag(self, tag, attributes):
        if tag not in ("img", "br"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        pass

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def seen(value):
    """The text of what a notebook shows; its tags are balanced."""
    parser = Balance()
    parser.feed(value._repr_html_())
    assert parser.open == []
    return parser.text


@pytest.mark.parametrize("cls", sorted({cls for stage in _core.stages.values() for cls in stage["techniques"]}, key=lambda c: c.__name__))
def test_a_technique_shows_its_meaning_and_every_knob(cls):
    text = seen(cls())
    assert cls.description["doc"] in text
    for knob in cls.description["params"]:
        assert knob["name"] in text and knob["doc"] in text


def test_a_method_shows_its_knobs_and_which_are_changed():
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=32))
    text = seen(method)
    assert all(name in text for name in method.knobs())
    assert "32changed" in text and text.count("changed") == 1


def test_a_study_shows_its_question_and_cells():
    study = Study(name="a < b?", scenes=[Scene()], methods=[Fake(error=0.1), Fake(error=0.2)], size=(24, 16), seeds=(0, 1))
    text = seen(study)
    assert "a < b?" in text and "4 cells" in text and "error=0.2" in text and "plain" in text


def test_a_frame_shows_its_picture_and_stages():
    frame = ir.methods.ConstantAmbient().render(ir.scenes.cornell_box(), size=(16, 12))
    assert "data:image/png;base64" in frame._repr_html_()
    assert all(name in seen(frame) for name in frame.profile.stages)


def test_the_bar_shows_in_terminals_and_notebooks_only(monkeypatch):
    assert progress.bar(total=1).disable is True  # this test writes to neither
    monkeypatch.setattr(progress, "in_notebook", lambda: True)
    with progress.bar(total=1) as shown:
        assert shown.disable is False


CELL = textwrap.dedent("""
    import sys, time
    sys.path.insert(0, {folder!r})
    import study_fakes
    from study_fakes import Fake, Scene, use_fake_truth
    from interreflect.study.run import run
    from interreflect.study.study import Study, sweep

    use_fake_truth({store!r} + "/truths")
    methods = sweep(Fake, {{"error": [k / 1000 for k in range(1, 1000)]}})
    study = Study(name="long", scenes=[Scene()], methods=methods, size=(24, 16), repeats=1)
    run(study, {store!r} + "/r")
""")


def test_a_notebook_shows_the_time_left_and_interrupting_it_keeps_what_was_done(tmp_path):
    manager_module = pytest.importorskip("jupyter_client.manager", reason="needs the extra `notebooks`")
    manager, client = manager_module.start_new_kernel(kernel_name="python3")
    try:
        cells = tmp_path / "r" / "cells"
        asked = client.execute(CELL.format(folder=str(Path(__file__).parent), store=str(tmp_path)))
        end = time.monotonic() + 90
        while len(list(cells.glob("*.json"))) < 5 and time.monotonic() < end:
            time.sleep(0.02)
        manager.interrupt_kernel()
        shown = ""
        while True:
            message = client.get_iopub_msg(timeout=60)
            if message["msg_type"] == "stream":
                shown += message["content"]["text"]
            if message["msg_type"] == "error":
                assert message["content"]["ename"] == "KeyboardInterrupt"
            ended = message["msg_type"] == "status" and message["content"]["execution_state"] == "idle"
            if ended and message["parent_header"].get("msg_id") == asked:
                break
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
    assert "long:" in shown and "/999 [" in shown and "<" in shown  # cells of all, time passed < time left
    records = load_records(tmp_path / "r")
    assert 5 <= len(records) < 999 and records.damaged == ()
    assert {record.status for record in records} == {"ok"}
