"""Widgets of knobs on a page that only remembers: turning them makes the method, and techniques bring and take their folders."""

from types import SimpleNamespace

import pytest

import interreflect as ir
from interreflect.live.widgets import KnobPanel


class Widget:
    """A widget or folder; what is removed may neither be removed again nor be filled."""

    def __init__(self, gui, label, value=None, **_):
        self.gui, self.label, self.value, self.inner, self.there = gui, label, value, [], True
        if gui.open:
            gui.open[-1].inner.append(self)

    def on_update(self, turned):
        self.turned = turned

    def turn(self, value):
        self.value = value
        self.turned(SimpleNamespace(client="somebody", target=self))

    def remove(self):
        assert self.there, f"{self.label} was removed already"
        self.there = False
        for widget in self.inner:
            if widget.there:
                widget.remove()

    def __enter__(self):
        assert self.there
        self.gui.open.append(self)

    def __exit__(self, *_):
        self.gui.open.pop()


class Gui:
    def __init__(self):
        self.open = []

    def add_folder(self, label, **options):
        return Widget(self, label, **options)

    def add_dropdown(self, label, options, initial_value, hint):
        assert initial_value in options and hint
        return Widget(self, label, initial_value)

    def add_checkbox(self, label, value, hint):
        return Widget(self, label, value)

    def add_text(self, label, value, hint):
        return Widget(self, label, value)

    def add_number(self, label, value, step, hint):
        return Widget(self, label, value)

    def add_slider(self, label, low, high, step, value, marks, hint):
        assert low <= value <= high and step > 0
        return Widget(self, label, value)


def found(widget, label):
    """The widgets of that label that are there, in order."""
    here = [widget] if widget.label == label else []
    return here + [one for inner in widget.inner if inner.there for one in found(inner, label)]


@pytest.fixture
def panel():
    return open_panel(ir.methods.VoxelConeTracing())


def open_panel(method):
    gui = Gui()
    made = []
    root = gui.add_folder("root")
    panel = KnobPanel(gui, root, method, lambda: made.append(panel.method()))
    return SimpleNamespace(root=root, made=made, panel=panel)


@pytest.mark.parametrize("name", dir(ir.methods))
def test_every_method_has_its_widgets_and_they_make_it(name):
    cls = getattr(ir.methods, name)
    for method in (cls(), *map(cls.preset, cls.presets)):
        assert open_panel(method).panel.method() == method


def test_turning_widgets_makes_the_method(panel):
    found(panel.root, "resolution (voxels)")[0].turn(64)
    found(panel.root, "bodies")[0].turn("apart")
    found(panel.root, "step (diameters)")[0].turn(0.5)
    known = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=64), bodies="apart", march=ir.DiffuseCones(step=0.5))
    assert panel.made[-1] == known and len(panel.made) == 3


def test_techniques_bring_their_folders_and_take_those_of_others(panel):
    for _ in range(2):  # and once more over what was taken away
        found(panel.root, "light_voxels")[0].turn("BlendHistory")
        assert len(found(panel.root, "BlendHistory")) == 1 and found(panel.root, "weight")
        found(panel.root, "light_voxels")[1].turn("ConeLighting")  # the one inside
        assert panel.made[-1].light_voxels == ir.BlendHistory(light_voxels=ir.ConeLighting())
        found(panel.root, "light_voxels")[0].turn("TracedLighting")
        assert not found(panel.root, "BlendHistory") and not found(panel.root, "weight")
    found(panel.root, "glossy")[0].turn("None")
    assert panel.made[-1].glossy is None and not found(panel.root, "GlossyCone")


def test_a_wrong_value_can_be_cured_by_another_knob():
    panel = open_panel(ir.methods.VoxelConeTracing())
    found(panel.root, "light_voxels")[0].turn("Bounces")
    with pytest.raises(ValueError, match="Bounces gathers in one hierarchy"):
        found(panel.root, "bodies")[0].turn("apart")
    found(panel.root, "light_voxels")[0].turn("TracedLighting")
    assert panel.made[-1] == ir.methods.VoxelConeTracing(bodies="apart")


def test_numbers_that_may_be_none_are_typed():
    panel = open_panel(ir.methods.PathTracing())
    found(panel.root, "bounces")[0].turn("none")
    assert panel.made[-1] == ir.methods.PathTracing(bounces=None)
    found(panel.root, "bounces")[0].turn("3")
    assert panel.made[-1] == ir.methods.PathTracing(bounces=3)
    with pytest.raises(TypeError, match="many"):
        found(panel.root, "bounces")[0].turn("many")


def test_another_method_takes_all_widgets_with_it(panel):
    panel.panel.show(ir.methods.AmbientOcclusion())
    assert not found(panel.root, "voxelize") and found(panel.root, "strength")
    assert panel.panel.method() == ir.methods.AmbientOcclusion() and panel.made == []
