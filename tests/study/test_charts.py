"""Charts and reports of studies with fake methods: they show what the records hold and render nothing."""

import dataclasses
from html.parser import HTMLParser

import numpy as np
import pytest
from study_fakes import Fake, Scene

from interreflect import charts, metrics
from interreflect.study.configurations import configurations
from interreflect.study.pareto import pareto
from interreflect.study.report import report
from interreflect.study.run import run
from interreflect.study.store import load_records
from interreflect.study.study import Study, sweep


class Rival(Fake):
    """The same under another name."""

    name = "rival"


METHODS = [
    *sweep(Fake, {"error": [0.1, 0.4]}),
    Rival(error=0.2, time=0.5),
    Rival(error=0.05, time=9.0),
    Fake(mode="raises"),
    Fake(mode="nan"),
]


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    import study_fakes

    folder = tmp_path_factory.mktemp("study")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(study_fakes.TRUTH, "1")
        patch.setenv("INTERREFLECT_CACHE", str(folder / "cache"))
        scenes = [Scene(), Scene("<bright & wide>", 3.0)]
        run(Study(name="a < b?", scenes=scenes, methods=METHODS, size=(24, 16), repeats=1), folder / "r")
    return load_records(folder / "r")


@pytest.fixture(scope="module")
def page(records, tmp_path_factory):
    return report(records, tmp_path_factory.mktemp("page") / "report.html").read_text()


def points(axes):
    return sorted(tuple(point) for dots in axes.collections[:2] for point in np.asarray(dots.get_offsets()).tolist())


def test_every_measured_configuration_is_a_point_at_its_time_and_error(records):
    figure = charts.speed_accuracy(records)
    assert len(figure.axes) == 2  # one per scene
    for axes, scene in zip(figure.axes, ("plain", "<bright & wide>"), strict=True):
        table = configurations(records)
        rows = table[table["scene"] == scene]
        np.testing.assert_allclose(points(axes), sorted(rows[["milliseconds", "relmse"]].itertuples(index=False, name=None)))


def test_rings_mark_the_front(records):
    axes = charts.speed_accuracy(records).axes[0]
    front = pareto(records)
    ringed = np.asarray(axes.collections[2].get_offsets())
    np.testing.assert_allclose(ringed, front[front["scene"] == "plain"][["milliseconds", "relmse"]])


def test_axes_are_logarithmic_and_name_their_units(records):
    axes = charts.speed_accuracy(records).axes[0]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert axes.get_xlabel() == "time per frame, ms (median)"
    assert axes.get_ylabel() == "relMSE"
    assert charts.speed_accuracy(records, y="ssim").axes[0].get_yscale() == "linear"


def test_bars_of_stages_add_up_to_the_frame(records):
    figure = charts.stages(records)
    for axes in figure.axes:
        ends = {}
        for bar in axes.patches:
            ends[round(bar.get_y(), 3)] = max(ends.get(round(bar.get_y(), 3), 0.0), bar.get_x() + bar.get_width())
        method, scene = axes.get_title().partition(",")[0].split(": ")
        table = records.table
        rows = table[(table["method"] == method) & (table["scene"] == scene) & (table["status"] == "ok")]
        assert sorted(ends.values()) == pytest.approx(sorted(rows["milliseconds"]))


def test_pictures_stand_beside_their_truth(records):
    figure = charts.images(records, limit=2)
    shown = [axes for axes in figure.axes if axes.images]
    assert len(shown) == 2 * (1 + 2 * 2)  # per scene: the truth, two pictures, two error maps
    truth = records.truth(records[0])[0]
    np.testing.assert_allclose(shown[0].images[0].get_array(), metrics.tone_map(truth, truth))


def test_no_chart_touches_the_global_state_of_matplotlib(records):
    from matplotlib import pyplot

    for draw in (charts.speed_accuracy, charts.stages, charts.images):
        draw(records).canvas.draw()
    assert pyplot.get_fignums() == []


def test_a_study_without_a_measured_cell_says_so_instead_of_drawing(tmp_path, fake_truth):
    failed = run(Study(name="none", scenes=[Scene()], methods=[Fake(mode="raises")], size=(24, 16)), tmp_path / "r")
    for draw in (charts.speed_accuracy, charts.stages, charts.images):
        with pytest.raises(ValueError, match="no "):
            draw(failed)
    page = report(failed, tmp_path / "page.html").read_text()
    assert "RuntimeError: lamp broken" in page


class Page(HTMLParser):
    """Collects what a page refers to, and whether its tags are balanced."""

    def __init__(self):
        super().__init__()
        self.open, self.links, self.rows = [], [], 0

    def handle_starttag(self, tag, attributes):
        self.rows += tag == "tr"
        self.links += [value for name, value in attributes if name in ("src", "href", "srcset")]
        if tag not in ("meta", "img", "source", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_report_is_one_page_that_loads_nothing_from_elsewhere(page):
    seen = Page()
    seen.feed(page)
    assert seen.open == []
    assert seen.links
    assert all(link.startswith("data:image/png;base64,") for link in seen.links)
    assert "url(" not in page
    assert "prefers-color-scheme: dark" in page


def test_the_report_escapes_what_records_say(page):
    assert "a &lt; b?" in page
    assert "&lt;bright &amp; wide&gt;" in page
    assert "<bright" not in page


def test_the_report_holds_every_configuration_and_failure(records, page):
    assert "lamp broken" in page
    assert "numbers of the picture are not finite" in page
    for value in configurations(records)["relmse"]:
        assert f'data-value="{float(value)!r}"' in page


def test_the_report_warns_of_missing_and_damaged_cells(records, tmp_path):
    partial = dataclasses.replace(records, missing=3, damaged=("cells/x.json: torn",))
    text = report(partial, tmp_path / "report.html").read_text()
    assert "3 cells are not measured yet" in text
    assert "cells/x.json: torn" in text
