"""Two corridors, one above the other, of which only the lower is lit: clusters that join both leak."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, box, flipped, join, mesh
from interreflect.scenes.values import Camera, Material, Mesh, PointLight, Scene

HEIGHT, HALF_WIDTH, SKIN = 2.4, 1.0, 0.3  # metres
BAY = 2.0  # metres from pilaster to pilaster
WALL = Material(name="wall", albedo=(0.7, 0.66, 0.58))
FLOOR = Material(name="floor", albedo=(0.45, 0.2, 0.12))
PILASTER = Material(name="pilaster", albedo=(0.25, 0.4, 0.55))


@built_in
def corridors(
    thickness: Annotated[float, Knob("of the slab between the corridors", 0, 2, open_minimum=True, unit="m")] = 0.3,
    length: Annotated[float, Knob("of both corridors", 4, 100, unit="m")] = 12.0,
) -> Scene:
    """Two closed corridors, stacked; point lights in the lower one. The truth of the upper one is 0.

    Cameras "lit" (lower) and "dark" (upper) look along them from the same place.
    """
    half = length / 2
    upper = HEIGHT + thickness
    hull = box((-half - SKIN, -SKIN, -HALF_WIDTH - SKIN), (half + SKIN, upper + HEIGHT + SKIN, HALF_WIDTH + SKIN))
    rooms = [flipped(box((-half, y, -HALF_WIDTH), (half, y + HEIGHT, HALF_WIDTH))) for y in (0, upper)]
    meshes = [mesh(join([hull, *rooms]), WALL), *(part for y in (0, upper) for part in _furniture(y, half))]
    lamps = [PointLight(position=(x, HEIGHT - 0.3, 0), intensity=(2.4, 2.1, 1.7)) for x in (-0.6 * half, 0, 0.6 * half)]
    cameras = {name: _camera(y, half) for name, y in (("lit", 0), ("dark", upper))}
    return Scene(meshes=meshes, lights=lamps, cameras=cameras)


def _furniture(y: float, half: float) -> list[Mesh]:
    """A carpet and a pilaster at every bay on both sides, a little sunk into floor and wall."""
    carpet = box((-half + 0.2, y - 0.01, -0.6), (half - 0.2, y + 0.02, 0.6))
    bays = int(2 * half / BAY)
    places = [(k - (bays - 1) / 2) * BAY for k in range(bays)]
    return [mesh(carpet, FLOOR), mesh(join(_pilaster(x, y, side) for x in places for side in (-1, 1)), PILASTER)]


def _pilaster(x: float, y: float, side: int) -> Shape:
    near, far = side * (HALF_WIDTH - 0.18), side * (HALF_WIDTH + 0.05)
    return box((x - 0.15, y - 0.01, min(near, far)), (x + 0.15, y + HEIGHT + 0.01, max(near, far)))


def _camera(y: float, half: float) -> Camera:
    return Camera(position=(-half + 0.4, y + 1.5, 0.3), target=(half, y + 1.1, -0.1), fov_x=75)
