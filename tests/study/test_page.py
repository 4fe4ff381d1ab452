"""The page in a browser without a network: charts draw, filters filter, pictures compare, keys work, narrow screens fit."""

import json
import shutil

import numpy as np
import pytest
from charted import measure
from matplotlib import colormaps

from interreflect import metrics
from interreflect.study.configurations import configurations
from interreflect.study.page.pictures import error_levels
from interreflect.study.pareto import pareto
from interreflect.study.report import report

playwright = pytest.importorskip("playwright.sync_api", reason="needs the extra `dev` (playwright)")
pytest.importorskip("plotly", reason="needs the extra `view`")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed; ./run test installs it")


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        return measure(tmp_path_factory.mktemp("study"), patch, seeds=(0, 1, 2))


@pytest.fixture(scope="module")
def address(records, tmp_path_factory):
    return report(records, tmp_path_factory.mktemp("page") / "report.html").as_uri()


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as play:
        opened = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield opened
        opened.close()


@pytest.fixture
def visit(browser, address):
    """Opens the page offline; at the end, nothing was asked of a network and the console holds no error."""
    contexts, complaints, requests = [], [], []

    def open_page(width=1200, height=900, **options):
        context = browser.new_context(viewport={"width": width, "height": height}, offline=True, **options)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda request: requests.append(request.url))
        page.goto(address)
        page.wait_for_function("document.body.dataset.drawn && document.body.dataset.pictured", timeout=60_000)
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert complaints == []
    assert [url for url in requests if url != address and not url.startswith(("data:", "blob:"))] == []


def traces(page, chart="speed-0"):
    return json.loads(page.evaluate(f"JSON.stringify(document.getElementById('{chart}').data)"))


def points(page, chart="speed-0"):
    return [(x, y) for trace in traces(page, chart) if trace["mode"] == "markers" and trace["name"] != "front"
            for x, y in zip(trace["x"], trace["y"], strict=True)]  # fmt: skip


def pixels(page, selector):
    """(height, width, 3) bytes of a canvas."""
    read = """canvas => ({ width: canvas.width, height: canvas.height,
                           bytes: [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data] })"""
    found = page.locator(selector).first.evaluate(read)
    return np.array(found["bytes"]).reshape(found["height"], found["width"], 4)[..., :3]


def shown(image, truth):
    return 255 * metrics.tone_map(image, truth)


STAGE = "#compare-0 .stage canvas"


def test_every_measured_configuration_is_drawn_at_its_time_and_error(visit, records):
    page = visit()
    table = configurations(records)
    for index, (_, rows) in enumerate(table.groupby("scene", sort=False)):
        drawn = sorted(points(page, f"speed-{index}"))
        np.testing.assert_allclose(drawn, sorted(rows[["milliseconds", "relmse"]].itertuples(index=False, name=None)))
        assert page.locator(f"#speed-{index} .scatterlayer .points path").count() >= len(rows)
        assert page.locator(f"#stages-{index} .barlayer .point").count() >= 2 * len(rows)  # march and shade of each


def test_rings_mark_the_front_of_the_library(visit, records):
    rings = next(trace for trace in traces(visit()) if trace.get("name") == "front")
    front = pareto(records)
    front = front[front["scene"] == "plain"]
    np.testing.assert_allclose(sorted(rings["x"]), sorted(front["milliseconds"]))


def test_a_filter_on_a_knob_leaves_its_points_and_rows(visit, records):
    page = visit()
    choice = page.locator("#filters label", has_text="error").locator("select").last
    choice.select_option("0.1")
    table = configurations(records)
    kept = table[table["error"] == 0.1]
    expected = kept[kept["scene"] == "plain"][["milliseconds", "relmse"]]
    np.testing.assert_allclose(sorted(points(page)), sorted(expected.itertuples(index=False, name=None)))
    assert page.locator("tr[data-point]:visible").count() == len(kept)
    assert page.locator("#kept").text_content() == f"{len(kept)} of {len(table)} configurations"
    page.locator("button[type=reset]").click()
    page.wait_for_function(f"document.querySelectorAll('tr[data-point]:not([hidden])').length === {len(table)}")


def test_axes_and_switches_change_the_chart(visit, records):
    page = visit()
    page.locator("select[name=y]").select_option("flip")
    flips = configurations(records)
    assert sorted(y for _, y in points(page)) == pytest.approx(sorted(flips[flips["scene"] == "plain"]["flip"]))
    page.locator("input[name=front]").uncheck()
    assert all(trace.get("name") != "front" and trace["mode"] != "lines" for trace in traces(page))
    page.locator("select[name=bars]").select_option("milliseconds")
    bars = traces(page, "stages-0")
    ends = np.sum([trace["x"] for trace in bars], axis=0)
    assert sorted(ends) == pytest.approx(sorted(flips[flips["scene"] == "plain"]["milliseconds"]))


def test_pointing_at_a_configuration_names_it(visit):
    page = visit()
    page.locator("#speed-0 .scatterlayer .points path").first.hover(force=True)
    page.wait_for_selector("#speed-0 .hoverlayer text")
    assert "relMSE" in page.locator("#speed-0 .hoverlayer").text_content()


def test_the_stage_shows_truth_on_the_left_and_the_picture_on_the_right_of_the_slider(visit, records):
    page = visit()
    truth = records.truth(records[0])[0]
    right = int(page.locator("#compare-0 select[name=right]").input_value())
    seen, width = pixels(page, STAGE), truth.shape[1]
    expected = shown(truth, truth)[:, : width // 2]
    np.testing.assert_allclose(seen[:, : width // 2], expected, atol=2)  # half a step of the stored light (1.2 %), and rounding
    small = pixels(page, f"canvas[data-light='{right}']")
    np.testing.assert_array_equal(seen[:, width // 2 + 1 :], small[:, width // 2 + 1 :])
    page.locator("#compare-0 input[name=split]").fill("0")
    np.testing.assert_array_equal(pixels(page, STAGE), small)


def test_exposure_and_errors_are_those_of_the_library(visit, records):
    page = visit()
    truth = records.truth(records[0])[0]
    stage = page.locator("#compare-0 .stage")
    stage.focus()
    for key in ("ArrowRight",) * 30 + ("+",) * 2:  # the whole stage to the left picture, then one stop up
        page.keyboard.press(key)
    brighter = 255 * ((lambda v: v / (1 + v))(2 * 0.18 * truth / truth.mean())) ** (1 / 2.2)
    np.testing.assert_allclose(pixels(page, STAGE), brighter, atol=2)  # as above
    page.keyboard.press("e")
    page.keyboard.press(" ")
    name = page.locator("#compare-0 select[name=right] option:checked").text_content()
    method, error = name.split(" ")[0], float(name.split("error ")[1].split(",")[0])
    record = next(r for r in records if (r.method, r.knobs["error"], r.status, r.scene) == (method, error, "ok", "plain"))
    levels = error_levels(metrics.error_map(records.images(record)[0], truth))
    np.testing.assert_allclose(pixels(page, STAGE), 255 * colormaps["magma"](levels)[..., :3], atol=1)


def test_keys_flip_the_pictures_and_choose_them(visit):
    page = visit()
    stage = page.locator("#compare-0 .stage")
    stage.focus()
    page.keyboard.press(" ")
    flipped = pixels(page, STAGE)
    page.keyboard.press(" ")
    assert (pixels(page, STAGE) != flipped).any()
    page.keyboard.press("1")
    assert page.locator("#compare-0 select[name=right]").input_value() == "0"
    page.locator("#compare-0 [data-flip]").press("Enter")
    assert float(page.locator("#compare-0 input[name=split]").input_value()) in (0, 100)


def test_tables_sort_by_keyboard(visit, records):
    page = visit()
    table = page.locator("table.sortable").last
    head = page.locator("section:has(h2:text('Every configuration')) th button", has_text="relmse").first
    for pressed, descending in (("Enter", False), ("Space", True)):
        head.press(pressed)
        column = head.evaluate("button => button.closest('th').cellIndex")
        values = page.locator("tr[data-point]").evaluate_all(f"rows => rows.map(row => Number(row.cells[{column}].dataset.value))")
        assert values == sorted(values, reverse=descending)
    assert table.count() == 1


@pytest.mark.parametrize("width", [360, 768])
def test_narrow_screens_show_the_whole_width(visit, width):
    page = visit(width=width, height=740)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    for chart in page.locator(".chart svg.main-svg").all():
        assert chart.bounding_box()["width"] <= width


@pytest.mark.parametrize(("scheme", "bright"), [("light", True), ("dark", False)])
def test_pages_and_charts_are_light_or_dark_as_the_reader_prefers(visit, scheme, bright):
    page = visit(color_scheme=scheme)
    paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert (np.mean([int(number) for number in paper[4:-1].split(",")]) > 128) == bright
    chart = page.evaluate("document.getElementById('speed-0').layout.paper_bgcolor")
    assert (int(chart[1:3], 16) > 128) == bright
