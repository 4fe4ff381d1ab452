"""The penumbra of a half plane under a square light: irradiance on the floor is known point by point."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.measured import facing_camera
from interreflect.scenes.builtin.shapes import mesh, quad
from interreflect.scenes.builtin.squares import emitter_material
from interreflect.scenes.values import Material, Scene

ALBEDO = 0.5  # of the floor
LIGHT_HEIGHT, LIGHT_SIDE = 0.6, 0.2  # extents
SEEN = 1.5  # half width of the picture over the penumbra's


@built_in
def penumbra(
    height: Annotated[float, Knob("of the blocker above the floor", 0, 0.4, open_minimum=True, unit="extents")] = 0.2,
) -> Scene:
    """A black half plane x < 0 hangs between a floor of side 1 and a square light of side .2 at height .6, exitance 1.

    By similar triangles the penumbra is 0.2 height / (.6 - height) wide. Camera "edge" sees it, as much umbra and as much lit
    floor; `irradiance` gives the truth along x.
    """
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    blocker = quad((-0.5, height, 0.5), (0.5, 0, 0), (0, 0, -1))
    s = LIGHT_SIDE / 2
    light = quad((-s, LIGHT_HEIGHT, -s), (2 * s, 0, 0), (0, 0, 2 * s))
    half = SEEN * penumbra_width(height) / 2
    camera = facing_camera((0, 0, 0), (0, 1, 0), half_width=half, distance=0.5 * height)
    grey, black = Material(name="floor", albedo=(ALBEDO,) * 3), Material(name="blocker", albedo=(0, 0, 0))
    return Scene(meshes=[mesh(floor, grey), mesh(blocker, black), mesh(light, emitter_material())], cameras={"edge": camera})


def penumbra_width(height: float) -> float:
    """Light side times distance behind the blocker over distance before it."""
    return LIGHT_SIDE * height / (LIGHT_HEIGHT - height)


def irradiance(height: float, x: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.float64]:
    """At points of the floor: the form factor to the part of the light right of the line through the blocker's edge (Howell B-4)."""
    s, h = LIGHT_SIDE / 2, LIGHT_HEIGHT
    edge = np.clip(x * (1 - h / height), -s, s)  # where the line from (x, 0) through (0, height) meets the light's plane

    def corner(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
        """Form factor to the rectangle between the foot of the normal and (u, v), signed."""
        a, b = np.sqrt(h * h + u * u), np.sqrt(h * h + v * v)
        return np.asarray((u / a * np.arctan(v / a) + v / b * np.arctan(u / b)) / (2 * np.pi))

    parts = [(s - x, s - z, 1), (edge - x, s - z, -1), (s - x, -s - z, -1), (edge - x, -s - z, 1)]
    return np.asarray(sum(sign * corner(u, v) for u, v, sign in parts))
