"""The ledger: what follows from checks, and what each claim makes of records that were made up to hold or not."""

import csv
import dataclasses
import io
import re
from pathlib import Path

import numpy as np
import pytest
from experiments.ledger import book, freed, rehfeld
from experiments.ledger.claim import ANSWERED, DOES_NOT_HOLD, HOLDS, IN_PART, NOT_YET, Check, Claim, above, below, judge, told
from experiments.ledger.page import RECORDED, as_csv, as_html, as_markdown, as_text
from experiments.rehfeld import resolution, surface_coverage
from experiments.shared.keep import NONE, NotRecorded, recorded
from experiments.shared.panels import picture

import interreflect as ir
from interreflect.study.records import Record, Records

CLAIM = Claim("X1", "figure 1", "A claim.")
CLAIM_W = Claim("W8", "figure 1", "A claim.")
CLAIMS = Path(__file__).parents[3] / "shared" / "CLAIMS.md"


def record(number, stages=(), metrics=(), knobs=(), size=(4, 4), **more):
    """A record of these stages' counts and milliseconds, metrics and knobs."""
    full = {name: {"milliseconds": 1.0, "bytes": 0, "counts": {}} | dict(stage) for name, stage in dict(stages).items()}
    return Record(
        key=f"k{number}", scene="s", scene_hash="h", camera="c", camera_values={}, method="m", knobs=dict(knobs), seed=0, size=size,
        bounces=1, threads=2, machine={}, stages=full, metrics=dict(metrics), truth="t", images=True, **more,
    )  # fmt: skip


def records(*made, folder="nowhere"):
    return Records("made up", tuple(made), folder)


def counted(stage, *counts):
    return records(*(record(i, {stage: {"counts": one}}) for i, one in enumerate(counts)))


def words(checks):
    return judge(CLAIM, checks).word


def pictured(folder, images, truth=None):
    """Records with pictures, as a study keeps them: (image, indirect) each."""
    (folder / "images").mkdir()
    (folder / "truths").mkdir()
    for i, (image, indirect) in enumerate(images):
        np.savez(folder / "images" / f"k{i}.npz", image=image, indirect=indirect)
    if truth is not None:
        np.savez(folder / "truths" / "t.npz", image=truth, indirect=truth)
    return records(*(record(i) for i in range(len(images))), folder=folder)


def test_a_claim_holds_where_every_check_does_and_in_part_where_some_do():
    yes, no = Check("a", "1", True), Check("b", "2", False)
    assert words([yes, yes]) == HOLDS
    assert words([no, no]) == DOES_NOT_HOLD
    assert words([yes, no]) == IN_PART
    assert judge(CLAIM, [yes, no]).reason == "not: b"


def test_numbers_without_a_bound_answer_a_question_and_change_no_verdict():
    assert words([told("a", "1")]) == ANSWERED
    assert words([told("a", "1"), below("b", 2.0, 1.0)]) == DOES_NOT_HOLD


def test_a_claim_without_checks_is_an_error_and_not_a_number_meets_no_bound():
    with pytest.raises(ValueError, match="X1"):
        judge(CLAIM, [])
    assert not below("a", float("nan"), 1.0).holds and not above("a", float("nan"), 1.0).holds


def test_every_claim_of_the_papers_is_in_the_book_once():
    names = [claim.name for claim in book.CLAIMS]
    assert len(set(names)) == len(names)
    expected = {"R": 15, "J": 17, "W": 7, "F": 12 + 5}  # F11 is five open questions
    assert {letter: sum(name[0] == letter for name in names) for letter in expected} == expected
    assert all(bool(claim.missing) != bool(claim.measure is not Claim.measure) for claim in book.CLAIMS)


@pytest.mark.skipif(not CLAIMS.exists(), reason="the list of claims does not lie beside the repository")
def test_every_claim_and_every_open_question_of_the_list_is_in_the_book():
    listed = re.findall(r"^\| ([RJWF]\d+) \| [^|]+ \| (.+) \|$", CLAIMS.read_text(), re.MULTILINE)
    assert len(listed) > 40
    for name, text in listed:
        of_name = [claim for claim in book.CLAIMS if re.fullmatch(rf"{name}[a-z]?", claim.name)]
        questions = text.split(": ", 1)[1].split(";") if text.startswith("Open questions") else [text]
        assert len(of_name) == len(questions), name
        assert len(questions) == 1 or all(claim.text.startswith("Open question: ") for claim in of_name)


def test_a_claim_whose_part_is_missing_says_so_without_running_anything():
    found = book.verdict(dataclasses.replace(CLAIM, missing="the other part"), records=None)
    assert found.word == NOT_YET and "the other part" in found.reason


def test_a_claim_whose_scene_is_not_here_says_so():
    def absent():
        raise FileNotFoundError("sponza: tried here and there")

    found = book.verdict(dataclasses.replace(CLAIM, studies=absent), records=None)
    assert found.word == NOT_YET and "tried here" in found.reason


def test_the_book_is_a_table_with_a_row_per_claim():
    verdicts = [judge(CLAIM, [below("less | more", 1.0, 2.0)]), book.verdict(dataclasses.replace(CLAIM, missing="that"))]
    lines = as_markdown(verdicts).splitlines()
    rows = [line for line in lines if line.startswith("| **X1**")]
    assert len(rows) == 2 and "*holds*" in rows[0] and "\\|" in rows[0] and NOT_YET in rows[1]
    assert "HOLDS" in as_text(verdicts[0]) and "yes: " in as_text(verdicts[0])


def test_the_table_and_the_page_say_what_the_book_says_and_which_command_measures_it():
    checked = judge(CLAIM_W, [below("a < b, surely", 1.0, 2.0), above("c", 1.0, 2.0), told("d", "3")])
    verdicts = [checked, book.verdict(dataclasses.replace(CLAIM_W, name="W9", missing="that"))]
    rows = list(csv.DictReader(io.StringIO(as_csv(verdicts))))
    assert list(rows[0]) == ["claim", "paper", "place", "text", "verdict", "check", "measured", "holds", "reason", "command"]
    assert [(row["claim"], row["check"], row["holds"]) for row in rows] == [
        ("W8", "a < b, surely", "yes"), ("W8", "c", "no"), ("W8", "d", ""), ("W9", "", ""),
    ]  # fmt: skip
    assert rows[0]["command"] == "./run figures ledger/W8" and "Weinzierl-Heigl" in rows[0]["paper"]
    assert rows[3]["reason"] == "missing: that"
    page = as_html(verdicts)
    assert "a &lt; b, surely" in page and "./run figures ledger/W9" in page and "1 holds in part, 1 not yet testable" in page


def test_a_ledger_of_what_is_recorded_measures_nothing_and_says_what_is_lacking(tmp_path, monkeypatch):
    method = ir.methods.ConstantAmbient()
    study = ir.Study(name="X: a box", scenes=[ir.scenes.cornell_box()], methods=[method], size=(8, 6), reference=NONE, repeats=1)
    claim = dataclasses.replace(CLAIM_W, studies=lambda: [study], measure=lambda found: [told("cells", str(len(found)))])
    monkeypatch.setattr(book, "CLAIMS", (claim,))
    page = book.write(tmp_path, measuring=False)
    assert "no records yet: ./run figures ledger/W8 (X: a box: never measured here)" in page.read_text()
    assert not (tmp_path / "records").exists() and RECORDED in page.read_text()
    assert RECORDED not in book.write(tmp_path).read_text()
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "records").rglob("*.json")}
    assert "answered" in book.write(tmp_path, measuring=False).read_text()
    assert (tmp_path / "ledger.csv").read_text().count("cells") == 1 and "*answered*" in (tmp_path / "ledger.md").read_text()
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "records").rglob("*.json")} == kept
    with pytest.raises(NotRecorded, match="1 of 2 cells are not measured"):
        recorded(dataclasses.replace(study, methods=[method, method.replace({"ambient": 0.5})]), tmp_path)


@pytest.mark.parametrize(("times", "word"), [((1.3, 1.2, 1.1), HOLDS), ((0.7, 0.8, 0.9), DOES_NOT_HOLD), ((0.7, 1.3, 1.3), IN_PART)])
def test_tessellation_is_slightly_slower(times, word):
    rows = [
        record(f"{way}{n}", {"voxelize": {"milliseconds": 10.0 * ratio}}, knobs={"grid.resolution": n})
        for way, ratios in (("rasterized", (1, 1, 1)), ("as printed", times), ("no holes", (3, 3, 3)))
        for n, ratio in zip((64, 128, 256), ratios, strict=True)
    ]
    assert words(freed.f2(records(*rows))) == word


def passes(voxelize, light, filtering, shading):
    """Records of table 5.1 as functions of (area of the picture, resolution), both 1 for the smallest."""
    sizes = ((1280, 720), (1600, 900), (1920, 1080))
    tables = []
    for size in sizes:
        area = size[0] * size[1] / (1280 * 720)
        rows = []
        for n in (64, 128, 256):
            made = {"voxelize": voxelize, "light_voxels": light, "prefilter": filtering, "march": shading}
            stages = {name: {"milliseconds": cost(area, n / 64)} for name, cost in made.items()} | {"gbuffer": {}}
            rows.append(record(f"{size}{n}", stages, knobs={"grid.resolution": n}, size=size, milliseconds=100.0))
        tables.append(records(*rows))
    return tables


def test_times_that_depend_on_what_the_paper_says_hold_and_others_do_not():
    right = passes(lambda a, n: n, lambda a, n: 5.0, lambda a, n: n**3, lambda a, n: a * (10 + n))
    assert words(freed.f1(*right)) == HOLDS
    wrong = passes(lambda a, n: a, lambda a, n: a * n, lambda a, n: a, lambda a, n: 5.0)
    assert words(freed.f1(*wrong)) == DOES_NOT_HOLD


def cracked(*shares, voxels=(100, 100, 100, 110)):
    return counted(
        "compare",
        *(
            {"seen": 10000, "cracked": round(10000 * share), "voxels": n, "extra": 0, "missing": 0, "faces": 3 * n}
            for share, n in zip(shares, voxels, strict=False)
        ),
    )


def test_cracks_are_closed_by_samples_and_conservative_rasterization_adds_voxels():
    assert words(freed.f4(cracked(0.02, 0.004, 0.001, 0.0))) == HOLDS
    assert words(freed.f4(cracked(0.0, 0.0, 0.0, 0.0))) == IN_PART  # what is not open is not closed, but voxels are added
    assert words(freed.f4(cracked(0.004, 0.004, 0.004, 0.0, voxels=(100, 100, 100, 100)))) == DOES_NOT_HOLD


def test_a_warp_cracks_unless_the_viewport_grows():
    assert words(freed.f9(cracked(0.03, 0.001, 0.0))) == HOLDS
    assert words(freed.f9(cracked(0.001, 0.001, 0.001))) == DOES_NOT_HOLD


def test_gaps_are_judged_by_the_texels_of_a_voxel():
    def lit(*numbers):
        return counted("light_voxels", *({"lit": n} for n in numbers))

    assert words(freed.f13(lit(300, 700, 960, 990, 1000, 1000))) == HOLDS
    assert words(freed.f13(lit(1000, 1000, 1000, 1000, 900, 1000))) == DOES_NOT_HOLD


def test_flicker_is_judged_against_a_grid_that_stands_still():
    def flicker(*means):
        return counted("flicker", *({"mean": round(1e6 * mean)} for mean in means))

    others = (0.02,) * 10  # unsnapped and nested grids, and all of them turning
    assert words(freed.f8(flicker(0.01, 0.011, 0.05, 0.04, 0.08, 0.02, *others))) == HOLDS
    assert words(freed.f8(flicker(0.01, 0.05, 0.05, 0.01, 0.015, 0.02, *others))) == DOES_NOT_HOLD
    assert words(freed.f10(flicker(0.05, 0.03, 0.01))) == HOLDS
    assert words(freed.f10(flicker(0.05, 0.05, 0.06))) == DOES_NOT_HOLD


def test_light_spreads_where_the_truth_is_dark(tmp_path):
    truth = np.linspace(0.1, 1, 64 * 64, dtype=np.float32).reshape(64, 64)[..., None].repeat(3, 2)
    spread = [(truth, np.maximum(truth, least).astype(np.float32)) for least in (0.5, 0.4, 0.1)]
    made = pictured(tmp_path, spread, truth)
    assert words(freed.f5(made)) == HOLDS
    (tmp_path / "other").mkdir()
    assert words(freed.f5(pictured(tmp_path / "other", spread[::-1], truth))) == DOES_NOT_HOLD


@pytest.mark.parametrize(("mixed", "word"), [(0.1, HOLDS), (0.9, DOES_NOT_HOLD)])
def test_a_small_change_is_a_third_of_what_half_the_resolution_makes(tmp_path, mixed, word):
    rng = np.random.default_rng(1)
    plain, coarse = (rng.random((32, 32, 3)).astype(np.float32) for _ in range(2))
    warped = plain + np.float32(mixed) * (coarse - plain)
    made = pictured(tmp_path, [(image, image) for image in (plain, warped, coarse)])
    made = dataclasses.replace(made, records=tuple(dataclasses.replace(one, metrics={"indirect_relmse": 0.1}) for one in made))
    assert words(freed.f6(made)) == word
    assert picture(made, 2) == pytest.approx(coarse)


def test_walls_are_judged_by_their_opacity_in_coarse_levels():
    def opacity(volume, surface):
        ways = {"VolumeCoverage": volume, "SurfaceCoverage": surface}
        return records(
            *(
                record(
                    name, {"prefilter": {"counts": {f"level_{k}": round(1e6 * a) for k, a in enumerate(levels)}}}, knobs={"prefilter": name}
                )
                for name, levels in ways.items()
            )
        )

    assert surface_coverage.LEVELS == 5
    assert words(rehfeld.r8(opacity((1, 0.5, 0.25, 0.12, 0.06), (1, 1, 1, 1, 1)))) == HOLDS
    assert words(rehfeld.r8(opacity((1, 0.9, 0.9, 0.9, 0.9), (1, 0.9, 0.5, 0.2, 0.1)))) == DOES_NOT_HOLD


def test_resolution_is_judged_by_the_gain_above_128():
    def errors(at_128, at_256):
        values = {32: 1.0, 64: 0.5, 128: at_128, 256: at_256}
        return records(
            *(
                record(n, metrics={"indirect_relmse": e + 0.01}, knobs={"grid.resolution": n}, indirect_noise=0.01)
                for n, e in values.items()
            )
        )

    assert len(resolution.EXPONENTS) == 3
    assert words(rehfeld.r6(errors(0.3, 0.3), errors(0.3, 0.29), errors(0.3, 0.2))) == HOLDS
    assert words(rehfeld.r6(errors(0.3, 0.1), errors(0.3, 0.1), errors(0.3, 0.3))) == DOES_NOT_HOLD


def test_a_ray_start_is_judged_by_steps_and_error():
    def started(rays, error):
        work = {"compromise": (1.0, 0.1), "rays": (rays, error), "immediate": (0.9, 0.11)}
        return records(
            *(
                record(
                    f"{angle}{start}",
                    {"glossy": {"counts": {"cone_steps": round(1e6 * steps)}}},
                    {"indirect_relmse": e},
                    {"glossy.half_angle": angle},
                )
                for angle in (2.0, 5.0, 15.0)
                for start, (steps, e) in work.items()
            )
        )

    assert words(rehfeld.r13(started(2.0, 0.1))) == HOLDS
    assert words(rehfeld.r13(started(1.0, 0.05))) == DOES_NOT_HOLD


def test_layers_are_judged_by_what_stays_open(tmp_path):
    def seen(folder, *opened):
        folder.mkdir()
        return pictured(folder, [(np.full((4, 4, 3), share, np.float32), np.zeros((4, 4, 3), np.float32)) for share in opened * 2])

    assert words(rehfeld.r7(seen(tmp_path / "a", 0.0, 0.01, 0.25))) == HOLDS
    assert words(rehfeld.r7(seen(tmp_path / "b", 0.0, 0.3, 0.01))) == DOES_NOT_HOLD


def test_shadows_are_judged_by_pixels_that_are_off(tmp_path):
    sun = np.ones((10, 10, 3), np.float32)
    dark = np.zeros_like(sun)

    def shadowed(folder, *wrong):
        folder.mkdir()
        images = [sun]
        for share in wrong:
            image = sun.copy()
            image.reshape(-1, 3)[: round(100 * share)] = 0
            images.append(image)
        return pictured(folder, [(image, dark) for image in images])

    assert words(rehfeld.r15(shadowed(tmp_path / "a", 0.2, 0.1, 0.05))) == HOLDS
    assert words(rehfeld.r15(shadowed(tmp_path / "b", 0.01, 0.01, 0.01))) == DOES_NOT_HOLD


def test_the_opacity_of_columns_multiplies_what_passes():
    from experiments.shared.wall_opacity import opacity_along_z

    half = np.full((2, 4, 4), 0.5)
    assert opacity_along_z(half) == pytest.approx(0.75)


def test_a_crack_is_a_ray_that_passes_by_two_diagonals():
    from experiments.shared.voxel_picture import cracks

    surface, voxels = np.array([[1.0, 1.0, np.inf]]), np.array([[1.9, 3.1, np.inf]])
    assert cracks(surface, voxels, np.full((1, 3), 1.0)).tolist() == [[False, True, False]]


def test_voxels_of_the_surface_itself_have_no_cracks_and_missing_ones_are_counted():
    from experiments.shared.voxel_picture import VoxelPicture

    box = ir.scenes.cornell_box()
    frame = VoxelPicture(grid=ir.Grid(resolution=16), voxelize=ir.ExactOverlap()).render(box, size=(32, 32))
    counts = frame.profile.stages["compare"].counts
    assert counts["cracked"] == counts["missing"] == counts["extra"] == 0 < counts["seen"]
    sparse = VoxelPicture(grid=ir.Grid(resolution=16), voxelize=ir.SurfaceSampling(spacing=1.0)).render(box, size=(32, 32))
    counts = sparse.profile.stages["compare"].counts
    assert counts["missing"] == counts["exact"] - counts["voxels"] > 0 and counts["cracked"] > 0
