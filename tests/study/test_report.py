"""The page of a study: one file that holds what the records say and loads nothing."""

import dataclasses
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from charted import measure
from matplotlib.figure import Figure
from study_fakes import Fake, Scene

from interreflect.study.configurations import configurations
from interreflect.study.page.pictures import comparison
from interreflect.study.report import LARGEST, report
from interreflect.study.run import run
from interreflect.study.study import Study

pytest.importorskip("plotly", reason="needs the extra `view`")


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        return measure(tmp_path_factory.mktemp("study"), patch)


@pytest.fixture(scope="module")
def page(records, tmp_path_factory):
    return report(records, tmp_path_factory.mktemp("page") / "report.html").read_text()


class Page(HTMLParser):
    """Collects what a page refers to, and whether its tags are balanced."""

    def __init__(self):
        super().__init__()
        self.open, self.links = [], []

    def handle_starttag(self, tag, attributes):
        self.links += [value for name, value in attributes if name in ("src", "href", "srcset")]
        if tag not in ("meta", "img", "source", "br", "link", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


class Finding:
    """Any result that draws and describes itself."""

    def chart(self, dark=False):
        figure = Figure(figsize=(1, 1), facecolor="black" if dark else "white")
        figure.subplots().plot([1, 2])
        return figure

    def _repr_html_(self):
        return "<p>shadows: 40 % of the error</p>"


def test_the_report_is_one_page_that_loads_nothing_from_elsewhere(page):
    seen = Page()
    seen.feed(page)
    assert seen.open == []
    assert all(link.startswith("data:") for link in seen.links)
    assert not re.search(r"url\(|@import|https?://", page)
    assert "prefers-color-scheme: dark" in page
    assert len(page.encode()) <= LARGEST


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


def test_a_finding_gets_a_section_with_its_chart_for_light_and_dark(records, tmp_path):
    text = report(records, tmp_path / "report.html", Finding()).read_text()
    section = text[text.index("<h2>Finding</h2>") :]
    assert "40 % of the error" in section
    light, dark = re.search(r'srcset="(data:[^"]+)"><img src="(data:[^"]+)"', section).groups()
    assert light != dark


def test_a_study_without_a_measured_cell_says_so_on_its_page(tmp_path, fake_truth):
    failed = run(Study(name="none", scenes=[Scene()], methods=[Fake(mode="raises")], size=(24, 16)), tmp_path / "r")
    page = report(failed, tmp_path / "page.html").read_text()
    assert "RuntimeError: lamp broken" in page
    assert "no charts" in page and "No pictures were kept" in page


def test_pictures_shrink_until_they_fit_the_page(tmp_path, fake_truth):
    study = Study(name="large", scenes=[Scene()], methods=[Fake(error=e) for e in (0.1, 0.2)], size=(640, 360), repeats=1)
    noisy = run(study, tmp_path / "r")
    whole = comparison(noisy, 10**8)
    assert '"width":640,"height":360' in whole
    small = comparison(noisy, len(whole) * 2 // 3)
    assert '"width":320,"height":180' in small and len(small) < len(whole)
    assert "do not fit" in comparison(noisy, 1000)


def test_without_plotly_the_report_names_the_extra(records, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "plotly.offline", None)
    with pytest.raises(ImportError, match=r"interreflect\[view\]"):
        report(records, tmp_path / "report.html")


def test_shrinking_keeps_the_mean():
    from interreflect.study.page.pictures import shrunk

    image = np.random.default_rng(0).random((12, 8, 3))
    np.testing.assert_allclose(shrunk(image, 4).mean(), image.mean())
    assert shrunk(image[:-1], 4).shape == (2, 2, 3)
