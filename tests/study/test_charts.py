"""Charts of studies with fake methods: they show what the records hold and render nothing."""

import numpy as np
import pytest
from charted import measure
from study_fakes import Fake, Scene

from interreflect import charts, metrics
from interreflect.study.configurations import configurations
from interreflect.study.pareto import pareto
from interreflect.study.run import run
from interreflect.study.study import Study


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        return measure(tmp_path_factory.mktemp("study"), patch)


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
