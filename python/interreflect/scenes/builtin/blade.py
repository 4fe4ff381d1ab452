"""An upright blade in slanting sun: the edge of its shadow on the floor, where maps of depth have holes and leaks."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.measured import facing_camera
from interreflect.scenes.builtin.shapes import mesh, quad
from interreflect.scenes.values import DirectionalLight, Material, Scene

ALBEDO = 0.5  # of the floor
SEEN = 0.8  # half width of the picture over the blade's height


@built_in
def blade(
    height: Annotated[float, Knob("of the blade, and of its shadow", 0, 0.2, open_minimum=True, unit="extents")] = 0.1,
) -> Scene:
    """A black blade stands on a floor of side 1 in a sun of 45 degrees that lights it by pi: radiance is .5, and 0 in the umbra.

    Camera "edge" sees a square of the floor whose left half lies in the umbra; the blade itself is outside the picture.
    """
    h = height
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    wall = quad((0, 0, 0.4), (0, 0, -0.8), (0, h, 0))
    irradiance = (float(np.pi * np.sqrt(2)),) * 3
    sun = DirectionalLight(direction=(1, -1, 0), irradiance=irradiance)
    camera = facing_camera((h, 0, 0), (0, 1, 0), half_width=SEEN * h, distance=0.5 * h)
    meshes = [mesh(floor, Material(name="floor", albedo=(ALBEDO,) * 3)), mesh(wall, Material(name="blade", albedo=(0, 0, 0)))]
    return Scene(meshes=meshes, lights=[sun], cameras={"edge": camera})
