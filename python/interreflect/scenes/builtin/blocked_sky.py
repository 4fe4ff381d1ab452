"""A floor under a white sky, and something black that hides part of it: how much of the sky is left, is known."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.measured import point_camera
from interreflect.scenes.builtin.shapes import Shape, mesh, quad, sphere
from interreflect.scenes.values import Camera, EnvironmentLight, Material, Scene

BLOCKERS = ("sphere", "wall")
ALBEDO = 0.5  # of the floor
WALL_LENGTH = 0.9  # extents


@built_in
def blocked_sky(
    blocker: Annotated[str, Knob("sphere: a ball straight above; wall: as far as it is high", choices=BLOCKERS)] = "sphere",
    distance: Annotated[float, Knob("of the ball's centre, or of the wall", 0, 0.3, open_minimum=True, unit="extents")] = 0.1,
) -> Scene:
    """The point at the origin of a floor of side 1 sees a white sky past a ball of radius distance / 2, or a wall of that height.

    What it sees of the sky, weighted by the cosine, does not change with the distance (for the wall but little): `sky_share`.
    Cameras "point", 1 degree wide about the origin, and "view".
    """
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    white, black = Material(name="floor", albedo=(ALBEDO,) * 3), Material(name="blocker", albedo=(0, 0, 0))
    camera = point_camera((0, 0, 0), distance=0.25 * distance)
    view = Camera(position=(0.4, 0.35, 0.8), target=(0, 0.05, 0), fov_x=60, size=(640, 480))
    meshes = [mesh(floor, white), mesh(_blocker(blocker, distance), black)]
    return Scene(meshes=meshes, lights=[EnvironmentLight()], cameras={"point": camera, "view": view})


def _blocker(kind: str, distance: float) -> Shape:
    if kind == "sphere":
        return sphere(distance / 2, centre=(0, distance, 0))
    return quad((-distance, 0, WALL_LENGTH / 2), (0, 0, -WALL_LENGTH), (0, distance, 0))


def sky_share(blocker: str, distance: float) -> float:
    """Share of the cosine-weighted sky that the origin sees: 1 - (r / h)^2 = 3/4 past the ball (row 9 of the closed forms).

    Past the wall, 1 - 2 F, F the form factor to a rectangle upright at distance a, as high and b long from the foot of the
    normal: (atan(b / a) - atan(b / (a sqrt 2)) / sqrt 2) / (2 pi) (Howell B-5); row 11 for b without end.
    """
    if blocker == "sphere":
        return 0.75
    b = WALL_LENGTH / 2 / distance
    return float(1 - (np.arctan(b) - np.arctan(b / np.sqrt(2)) / np.sqrt(2)) / np.pi)
