"""A board before a room: one straight edge in depth, beside which light differs."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import box, mesh, quad
from interreflect.scenes.values import Camera, Material, PointLight, Scene


@built_in
def depth_edge(gap: Annotated[float, Knob("from the board to the wall behind", 0.5, 3, unit="m")] = 2.0) -> Scene:
    """A white board that covers the left half of the picture before a lit room with a red side wall; only indirect light reaches the board.

    The camera looks along the wall's normal past the board's upright edge. Camera "front".
    """
    white, red = Material(name="white", albedo=(0.7, 0.7, 0.7)), Material(name="red", albedo=(0.65, 0.12, 0.08))
    wall = quad((-2, 0, -1.5), (4, 0, 0), (0, 2.6, 0))
    floor = quad((-2, 0, 2), (4, 0, 0), (0, 0, -3.5))
    side = quad((2, 0, -1.5), (0, 0, 3.5), (0, 2.6, 0))
    front = gap - 1.5
    board = box((-1.6, 0, front - 0.04), (0, 2.2, front))
    lamp = PointLight(position=(1.2, 2.2, front - 0.3), intensity=(4, 4, 4))
    camera = Camera(position=(0.05, 1.2, 3.2), target=(0.05, 1.1, 0), fov_x=44)
    meshes = [mesh(wall, white), mesh(floor, white), mesh(side, red), mesh(board, Material(name="board", albedo=(0.75, 0.75, 0.75)))]
    return Scene(meshes=meshes, lights=[lamp], cameras={"front": camera})
