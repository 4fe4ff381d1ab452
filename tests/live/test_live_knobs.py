"""A page's knobs are those of the descriptions, with range, unit and the papers' values; what is exported makes an equal method."""

import math

import pytest

import interreflect as ir
from interreflect import methods
from interreflect.live.export import camera_code, method_code, program
from interreflect.live.knobs import knobs_of, method_of, walk, with_technique
from interreflect.live.widgets import marks, slider_step

CLASSES = [getattr(methods, name) for name in dir(methods)]
CONFIGURATIONS = [(cls, preset) for cls in CLASSES for preset in (None, *cls.presets)]


def made(cls, preset):
    return cls() if preset is None else cls.preset(preset)


def knob(method, path):
    return next(one for one in walk(knobs_of(type(method), method.knobs())) if one.path == path)


@pytest.mark.parametrize(("cls", "preset"), CONFIGURATIONS)
def test_a_page_shows_every_knob_and_makes_the_method_back_from_them(cls, preset):
    method = made(cls, preset)
    shown = {one.path: one.value for one in walk(knobs_of(cls, method.knobs()))}
    assert {path: str(value) for path, value in shown.items()} == {path: str(value) for path, value in method.knobs().items()}
    assert method_of(cls, method.knobs()) == method


def test_a_knob_says_its_unit_range_and_what_papers_set_it_to():
    one = knob(ir.methods.VoxelConeTracing(), "grid.resolution")
    assert (one.kind, one.value, one.unit, one.minimum, one.maximum) == ("integer", 128, "voxels", 2, 1024)
    assert one.papers == (("Freed 2018", 256), ("Rehfeld 2014 voxels", 128))
    assert "[2, 1024], voxels" in one.hint and "Freed 2018: 256" in one.hint


def test_a_papers_value_stands_only_at_the_technique_that_the_paper_uses():
    one = knob(ir.methods.VoxelConeTracing(), "share.width")  # the papers share nothing between pixels
    assert one.papers == ()
    assert knob(ir.methods.VoxelConeTracing(), "share").papers[0] == ("Freed 2018", "EveryPixel")
    freed = ir.methods.VoxelConeTracing.preset("Freed 2018")  # ShadowMap has samples too, but those are not the ones of TracedShadows
    assert "Freed 2018" in dict(knob(freed, "shadow.samples").papers)
    assert "Freed 2018" not in dict(knob(ir.methods.VoxelConeTracing(shadow=ir.TracedShadows()), "shadow.samples").papers)


def test_another_technique_brings_its_own_knobs():
    cls = ir.methods.VoxelConeTracing
    values = with_technique(cls, cls().knobs(), "voxelize", "Tessellation")
    assert method_of(cls, values) == cls(voxelize=ir.Tessellation())
    nested = with_technique(cls, values, "grid.warp", "CubicSpline")
    assert method_of(cls, nested) == cls(voxelize=ir.Tessellation(), grid=ir.Grid(warp=ir.CubicSpline()))
    assert method_of(cls, with_technique(cls, nested, "glossy", "None")).glossy is None
    # Back to what the method has by default, as the method has it and not as the technique alone would be.
    again = with_technique(cls, with_technique(cls, values, "light_voxels", "ConeLighting"), "light_voxels", "TracedLighting")
    assert method_of(cls, again).light_voxels == cls().light_voxels != ir.TracedLighting()


def test_values_that_do_not_go_together_can_be_shown_but_make_no_method():
    cls = ir.methods.VirtualAreaLights
    values = with_technique(cls, cls().knobs(), "sky", "ConeSky")
    assert next(one for one in knobs_of(cls, values) if one.path == "sky").value == "ConeSky"
    with pytest.raises(ValueError, match="virtual lights have none"):
        method_of(cls, values)
    with pytest.raises(ValueError, match=r"resolution.*1024.*4096"):
        method_of(ir.methods.VoxelConeTracing, {**ir.methods.VoxelConeTracing().knobs(), "grid.resolution": 4096})


@pytest.mark.parametrize("cls", CLASSES)
def test_sliders_reach_both_ends_and_the_value_they_start_at(cls):
    sliders = 0
    for one in walk(knobs_of(cls, cls().knobs())):
        if one.kind in ("number", "integer") and (step := slider_step(one)) is not None:
            sliders += 1
            assert step > 0 and 1 <= (one.maximum - one.minimum) / step <= 1001  # at most ten times a hundredth of the range
            assert math.isclose(one.value / step, round(one.value / step), abs_tol=1e-6)
    assert sliders or cls in (ir.methods.PathTracingDenoised, ir.methods.ConstantAmbient, ir.methods.AmbientOcclusion)


@pytest.mark.parametrize(("cls", "preset"), CONFIGURATIONS)
def test_exported_code_makes_an_equal_method(cls, preset):
    method = made(cls, preset)
    assert eval(method_code(method), {"ir": ir}) == method
    assert eval(method_code(method, preset), {"ir": ir}) == method


def test_exported_code_holds_what_was_turned_and_nothing_else():
    cls = ir.methods.VoxelConeTracing
    turned = cls(grid=ir.Grid(resolution=64, warp=ir.CubicSpline(alpha=0.5)), glossy=None, bodies="apart")
    text = method_code(turned)
    assert eval(text, {"ir": ir}) == turned
    assert "march" not in text and "cascades" not in text
    paper = cls.preset("Freed 2018").replace({"grid.resolution": 64})
    text = method_code(paper, "Freed 2018")
    assert eval(text, {"ir": ir}) == paper
    assert "march" not in text


def test_an_exported_program_runs_and_writes_the_picture(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=8))
    camera = ir.Camera(position=(0.1234567, 1.0, 3.9), target=(0.0, 1.0, 0.0), fov_x=39.0)
    names = {}
    exec(program("ir.scenes.cornell_box()", method, None, camera, (16, 12)), names)
    assert names["method"] == method
    assert names["frame"].image.shape == (12, 16, 3)
    assert (tmp_path / "frame.exr").exists()
    found = eval(camera_code(camera), {"ir": ir})
    assert found.position == pytest.approx(camera.position, abs=1e-5)  # six digits


def test_an_exported_camera_holds_six_digits_and_no_dust():
    camera = ir.Camera(position=(-1200.123456, 200.0, -1e-14), target=(0.0, 0.0, 0.0), up=(-1.8e-16, 1.0, 0.0), fov_x=47.26189)
    assert camera_code(camera) == "ir.Camera(position=(-1200.12, 200.0, 0.0), target=(0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), fov_x=47.2619)"


def test_a_papers_value_is_a_mark_on_the_slider_that_hides_no_other():
    shown = marks(knob(ir.methods.VoxelConeTracing(), "march.step"))
    assert shown == ((0.1, "0.1"), (2.0, "2"), (0.5, "0.5"))
    shown = marks(knob(ir.methods.VoxelConeTracing(), "march.first_diameter"))  # .75 of [.25, 8] lies beside the end
    assert shown == ((0.25, "0.25"), (8.0, "8"), 0.75)
