"""A board before a room: one straight edge in depth, beside which light differs."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import box, mesh, quad
from interreflect.scenes.values import Camera, Material, Scene, SpotLight


@built_in
def depth_edge(gap: Annotated[float, Knob("from the board to the wall behind", 0.05, 3, unit="m")] = 2.0) -> Scene:
    """A white board that covers the left half of the picture, a wall and a floor behind it; a spot on the red side wall lights both.

    The camera looks along the wall's normal past the board's upright edge. Camera "front".
    """
    white, red = Material(name="white", albedo=(0.7, 0.7, 0.7)), Material(name="red", albedo=(0.65, 0.12, 0.08))
    wall = quad((-2, 0, -1.5), (4, 0, 0), (0, 2.6, 0))
    floor = quad((-2, 0, 2), (4, 0, 0), (0, 0, -3.5))
    side = quad((2, 0, -1.5), (0, 0, 3.5), (0, 2.6, 0))
    front = gap - 1.5
    board = box((-1.6, 0, front - 0.04), (0, 2.2, front))
    spot = SpotLight(position=(0.5, 2.4, 1.6), direction=(1.5, -1.2, -0.6), intensity=(60, 60, 60), inner=18, outer=24)
    camera = Camera(position=(0.05, 1.2, 3.2), target=(0.05, 1.1, 0), fov_x=44)
    meshes = [mesh(wall, white), mesh(floor, white), mesh(side, red), mesh(board, Material(name="board", albedo=(0.75, 0.75, 0.75)))]
    return Scene(meshes=meshes, lights=[spot], cameras={"front": camera})
