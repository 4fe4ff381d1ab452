"""What must not change a picture, over every method."""

from __future__ import annotations

import numpy as np
import pytest
from remembering import Remembering

import interreflect as ir
from interreflect.stability.invariants import _not_rising, brighter
from interreflect.stability.similar import similar

METHODS = [name for name in dir(ir.methods) if isinstance(getattr(ir.methods, name), type)]


def quick(name):
    """The method at a grid that a test can afford."""
    method = getattr(ir.methods, name)()
    return method.replace({"grid.resolution": 64}) if method.knobs().get("grid.resolution", 0) > 64 else method


@pytest.mark.parametrize("name", METHODS)
def test_every_method_keeps_its_pictures_and_gains_by_finer_settings(name):
    found = ir.stability.invariance(quick(name), seeds=range(3))
    assert found.holds, found.table.to_string()
    assert {"scene times 1e-3", "scene moved by 100 extents", "scene turned by 90 degrees", "one and two threads", "no light"} <= {
        *found.table.index
    }


def test_area_lights_and_skies_are_scaled_and_turned_along():
    scene = ir.Scene(
        meshes=ir.scenes.cornell_box("area").meshes,
        lights=[ir.EnvironmentLight(radiance=(0.1, 0.2, 0.3))],
        cameras=dict(ir.scenes.cornell_box().cameras),
    )
    found = ir.stability.invariance(ir.methods.ConstantAmbient(), scene, seeds=range(2))
    assert found.holds, found.table.to_string()


class Absolute(ir.methods.ConstantAmbient):
    """Ambient light that depends on what it must not: lengths in scene units, place, light to the power of two, seed and threads."""

    def compose(self, view, profile):
        from interreflect import _core

        direct, indirect, *_ = super().compose(view, profile)
        extent = np.ptp(view.scene.bounds, axis=0).max() + np.abs(view.scene.bounds).max()
        return direct, (indirect + direct**2) * np.float32(extent * (1 + 0.1 * _core.thread_limit())) + np.float32(1e-3)


def test_a_method_that_depends_on_what_it_must_not_is_told_where():
    broken = {check.name for check in ir.stability.invariance(Absolute(), seeds=range(2)).broken}
    wanted = {
        "scene times 1e-3",
        "scene times 1e3",
        "scene moved by 100 extents",
        "four times the light",
        "no light",
        "one and two threads",
    }
    assert broken == wanted


def test_an_error_that_rises_with_a_knob_is_told_unless_noise_explains_it():
    falling = [np.array([4.0, 4.1, 3.9]), np.array([2.0, 2.1, 1.9]), np.array([1.0, 1.1, 0.9])]
    assert _not_rising("k", (1, 2, 4), falling, 0.0).holds
    rising = _not_rising("k", (1, 2, 4), falling[::-1], 0.0)
    assert not rising.holds and rising.change == pytest.approx(0.5) and "1, 2, 4" in rising.reason
    noisy = [np.array([1.0, 2.0, 3.0]), np.array([1.5, 2.5, 3.5])]
    assert _not_rising("k", (1, 2), noisy, 0.0).holds
    assert _not_rising("k", (1, 2), [np.array([1.0, 1.0]), np.array([1.1, 1.1])], 0.2).holds  # within the truth's own noise


def test_methods_with_history_are_checked_too_and_one_seed_is_too_few():
    assert ir.stability.invariance(Remembering(share=0.5), seeds=range(2)).holds
    with pytest.raises(ValueError, match="at least two seeds"):
        ir.stability.invariance(Remembering(), seeds=(0,))


def test_a_similar_scene_has_its_lights_and_cameras_along():
    scene = ir.scenes.cornell_box("spot")
    other = similar(scene, scale=2, turn=90, shift=(5, 0, 0))
    assert np.ptp(other.bounds, axis=0) == pytest.approx(2 * np.ptp(scene.bounds, axis=0)[[2, 1, 0]], rel=1e-6)
    x, y, z = scene.camera.position
    assert other.camera.position == pytest.approx((2 * z + 5, 2 * y, -2 * x))
    assert other.lights[0].intensity == pytest.approx(np.multiply(4, scene.lights[0].intensity))
    double = brighter(ir.scenes.cornell_box("area"), 2)
    assert max(m.material.emission[0] for m in double.meshes) == 2 * max(
        m.material.emission[0] for m in ir.scenes.cornell_box("area").meshes
    )
