"""Charts of studies with fake methods: they show what the records hold and render nothing."""

import re
import zlib

import numpy as np
import pytest
from charted import measure
from study_fakes import Fake, Scene

from interreflect import charts, metrics
from interreflect.charts.style import add_legend, new_figure
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


def pdf_objects(content):
    """A PDF's text with its streams unpacked."""
    unpacked = [content]
    for stream in re.findall(rb"stream\r?\n(.*?)endstream", content, re.DOTALL):
        try:
            unpacked.append(zlib.decompress(stream))
        except zlib.error:
            continue
    return b"\n".join(unpacked)


def test_figures_for_papers_embed_their_fonts_as_outlines(records, tmp_path):
    drawn = {"speed_accuracy": charts.speed_accuracy, "stages": charts.stages, "images": charts.images}
    drawn["curves"] = lambda records: charts.curves(records, x="milliseconds")
    for name, draw in drawn.items():
        draw(records).savefig(tmp_path / f"{name}.pdf")
        text = pdf_objects((tmp_path / f"{name}.pdf").read_bytes())
        assert b"/FontFile2" in text, name  # a TrueType font within the file
        assert b"/Type3" not in text, name  # which journals refuse
        fonts = re.findall(rb"/BaseFont /([^ /\n]+)", text)
        assert fonts and all(b"DejaVu" in font for font in fonts), (name, fonts)


def test_charts_of_lines_are_vectors(records, tmp_path):
    charts.speed_accuracy(records).savefig(tmp_path / "chart.pdf")
    assert b"/Subtype /Image" not in pdf_objects((tmp_path / "chart.pdf").read_bytes())


def test_colours_differ_for_people_who_lack_a_kind_of_cone():
    """Machado et al. 2009, full deuteranopia and protanopia; any two of the first six colours stay 10 apart in CIELAB."""
    from skimage.color import rgb2lab

    from interreflect.charts.style import COLOURS

    linear = lambda c: np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)  # noqa: E731
    encoded = lambda c: np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)  # noqa: E731
    protan = [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    deutan = [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    colours = np.array([[int(c[k : k + 2], 16) / 255 for k in (1, 3, 5)] for c in COLOURS[:6]])
    for loss in (protan, deutan):
        lab = rgb2lab(encoded(np.clip(linear(colours) @ np.transpose(loss), 0, 1))[None])[0]
        apart = np.linalg.norm(lab[:, None] - lab[None], axis=2) + 1e3 * np.eye(6)
        assert apart.min() > 10


def test_curves_show_every_configuration_that_has_the_knob(records):
    figure = charts.curves(records, x="error", y="relmse", x_label="error")
    table = configurations(records)
    for axes, (_, rows) in zip(figure.axes, table.groupby("scene", sort=False), strict=True):
        drawn = sorted(float(x) for line in axes.lines if line.get_marker() in ("o", "s") for x in line.get_xdata())
        assert drawn == sorted(rows["error"])
        assert axes.get_xlabel() == "error" and axes.get_ylabel() == "relMSE"
    with pytest.raises(ValueError, match="no measured record"):
        charts.curves(records, x="march.cones")


def test_a_label_leaves_out_knobs_that_the_techniques_of_a_row_do_not_have(records):
    """As `share.width`, where one configuration interleaves and another does not: in the table NaN, in a record's own row absent."""
    row = next(record for record in records if record.status == "ok" and record.method == "fake").row()
    assert charts.label(records, row | {"error": float("nan")}) == "fake"
    assert charts.label(records, {name: value for name, value in row.items() if name != "error"}) == "fake"


def test_long_words_squeeze_no_panel(records, monkeypatch):
    monkeypatch.setattr("interreflect.charts.records._knobs", lambda row, names: "many knobs " * 30)
    figure = charts.speed_accuracy(records)
    figure.draw_without_rendering()
    assert all(axes.get_position().width > 0.3 for axes in figure.axes)  # two panels


def test_a_legend_of_many_methods_stays_within_a_narrow_figure():
    figure = new_figure((6.4, 4.8), dark=False)
    axes = figure.subplots()
    for name in ("voxel-cone-tracing", "ambient-occlusion", "constant-ambient", "path-tracing", "path-tracing-denoised"):
        axes.plot([0, 1], label=name)
    add_legend(figure, [axes], dark=False)
    figure.draw_without_rendering()
    box = figure.legends[0].get_window_extent()
    assert box.x0 >= 0 and box.x1 <= figure.bbox.width
