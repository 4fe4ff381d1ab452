"""A lit patch over a floor that gets no other light, with plates between them: shadows of light that was reflected once."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.measured import facing_camera
from interreflect.scenes.builtin.shapes import Shape, mesh, quad
from interreflect.scenes.values import Light, Material, Scene, SpotLight

ALBEDO = 0.5  # of the floor
PATCH_HEIGHT, PATCH_SIDE = 0.6, 0.2  # extents
PLATE_HALF, REACH = 0.2, 0.3  # half side of the plate; half length of edges
LOW = 0.05  # height of the lower of two edges
SEEN = {"none": 0.27, "plate": 0.27, "edge": 0.3, "edges": 0.3, "slit": 0.25}  # half widths of the picture


@built_in
def lit_patch(
    blocker: Annotated[str, Knob("what hangs over the floor", choices=tuple(SEEN))] = "plate",
    height: Annotated[float, Knob("of the blocker, of the upper one of two", 0, 0.4, open_minimum=True, unit="extents")] = 0.3,
    gap: Annotated[float, Knob("width of the slit", 0, 0.4, unit="extents")] = 0.1,
) -> Scene:
    """A white patch of side .2 at height .6 faces a floor of side 1; a spot from beside the floor lights the patch and nothing else.

    Blockers are black: `plate` a square of side .4, `edge` the half plane x < 0, `edges` two of them, the lower at height .05, `slit`
    two half planes a `gap` apart. Camera "floor" sees the middle of the floor: behind the plate umbra alone (`umbra`), behind an
    edge the penumbra (`penumbra_width`), as much umbra and as much lit floor.
    """
    s, white = PATCH_SIDE / 2, Material(name="patch", albedo=(0.8, 0.8, 0.8))
    patch = quad((-s, PATCH_HEIGHT, -s), (2 * s, 0, 0), (0, 0, 2 * s))
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    half = SEEN[blocker] if blocker != "edge" else 1.5 * penumbra_width(height) / 2
    camera = facing_camera((0, 0, 0), (0, 1, 0), half_width=half, distance=0.5 * min(height, LOW if blocker == "edges" else height))
    black = Material(name="blocker", albedo=(0, 0, 0))
    meshes = [mesh(floor, Material(name="floor", albedo=(ALBEDO,) * 3)), mesh(patch, white)]
    meshes += [mesh(plate, black) for plate in _plates(blocker, height, gap)]
    return Scene(meshes=meshes, lights=[_spot()], cameras={"floor": camera})


def umbra(height: float) -> float:
    """Half side of the square of floor from which the plate hides all of the patch."""
    share = height / PATCH_HEIGHT
    return (PLATE_HALF - PATCH_SIDE / 2 * share) / (1 - share)


def penumbra_width(height: float) -> float:
    """Of an edge, by similar triangles: the patch's side times distance behind the blocker over distance before it."""
    return PATCH_SIDE * height / (PATCH_HEIGHT - height)


def _plates(blocker: str, height: float, gap: float) -> list[Shape]:
    def plate(low: float, high: float, half: float, y: float) -> Shape:
        return quad((low, y, half), (high - low, 0, 0), (0, 0, -2 * half))

    return {
        "none": [],
        "plate": [plate(-PLATE_HALF, PLATE_HALF, PLATE_HALF, height)],
        "edge": [plate(-0.5, 0, REACH, height)],
        "edges": [plate(-0.5, 0, REACH, height), plate(-0.5, 0, REACH, LOW)],
        "slit": [plate(-0.5, -gap / 2, REACH, height), plate(gap / 2, 0.5, REACH, height)],
    }[blocker]


def _spot() -> Light:
    """From below the floor's plane, 2 m beside its middle: its light reaches the patch above all blockers."""
    place = (0.0, PATCH_HEIGHT - 2 * float(np.tan(np.radians(20))), 2.0)
    direction = (0.0, PATCH_HEIGHT - place[1], -place[2])
    return SpotLight(position=place, direction=direction, intensity=(26, 26, 26), inner=4, outer=5)
