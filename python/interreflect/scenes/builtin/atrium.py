"""The atrium: a court with two storeys of arches around it, open to the sky, with sunlit curtains."""

from __future__ import annotations

from collections import defaultdict
from functools import cache
from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.atrium_parts import cloth
from interreflect.scenes.builtin.atrium_plan import BAY, FLOOR, HALF_X, SLAB, Part, on_sides, structure
from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.patterns import brocade, chequers, encoded, masonry, plain, planks
from interreflect.scenes.builtin.shapes import Shape, join, mesh, moved
from interreflect.scenes.values import Camera, DirectionalLight, EnvironmentLight, Material, Mesh, Scene, Texture

CLOTH_SHARE = 0.22  # of the triangles, more or less: it takes what the structure leaves
TEXELS = 512
CLOTHS = {
    "red cloth": ((0.5, 0.03, 0.025), (0.6, 0.2, 0.07)),
    "green cloth": ((0.06, 0.24, 0.1), (0.2, 0.36, 0.14)),
    "blue cloth": ((0.04, 0.1, 0.4), (0.16, 0.26, 0.5)),
    "gold cloth": ((0.58, 0.34, 0.07), (0.5, 0.18, 0.05)),
}


@built_in
def atrium(
    detail: Annotated[int, Knob("aimed at and met within 10 %", 5_000, 300_000, unit="triangles")] = 60_000,
) -> Scene:
    """A court of 16 x 6.4 metres between two storeys of arcades, with curtains, banners, urns and a fountain; sun and blue sky.

    More triangles make rounder columns, arches and balusters and finer cloth; nothing moves. All is diffuse with procedural
    textures, flat normals and albedo below 0.8. Cameras "court" and "gallery".
    """
    parts = _fitted((1 - CLOTH_SHARE) * detail)
    materials = _materials()
    meshes = [*_built(parts, materials), *_hangings(detail - sum(part.triangles for part in parts), materials)]
    sun = DirectionalLight(direction=(-0.42, -1, -0.3), irradiance=(17, 15, 11.8))
    sky = EnvironmentLight(radiance=(0.95, 1.2, 1.6))
    cameras = {
        "court": Camera(position=(7.1, 1.75, 2.0), target=(-3.0, 2.75, -1.35), fov_x=72),
        "gallery": Camera(position=(4.3, 6.9, 3.0), target=(-2.4, 3.0, -2.9), fov_x=74),
    }
    return Scene(meshes=meshes, lights=[sun, sky], cameras=cameras)


def _fitted(triangles: float) -> list[Part]:
    """The finest structure of at most so many triangles, or the coarsest."""
    low, high = 0.0, 1.0
    for _ in range(12):
        middle = (low + high) / 2
        if sum(part.triangles for part in structure(middle)) <= triangles:
            low = middle
        else:
            high = middle
    return structure(low)


def _built(parts: list[Part], materials: dict[str, Material]) -> list[Mesh]:
    """One mesh for each material."""
    shapes: dict[tuple[str, float], list[Shape]] = defaultdict(list)
    for part in parts:
        shapes[part.material, part.tile].append(part.shape())
    return [mesh(join(group), materials[name], tile=tile) for (name, tile), group in shapes.items()]


def _hangings(triangles: int, materials: dict[str, Material]) -> list[Mesh]:
    """Curtains between the lower columns and banners before the gallery, of about so many triangles in all."""
    pieces = _curtains() + _banners()
    areas = np.array([width * height for _, _, width, height, _ in pieces])
    groups: dict[str, list[tuple[Shape, np.ndarray[tuple[int, ...], np.dtype[np.float64]]]]] = defaultdict(list)
    for k, (material, side, width, height, place) in enumerate(pieces):
        quads = max(triangles * areas[k] / areas.sum() / 2, 8)
        columns = max(int(np.sqrt(quads * width / height * 2.5)), 4)  # folds bend the cloth across, much less along
        rows = max(round(quads / columns), 1)
        shape, texcoords = cloth(width, height, folds=width * 3.1, depth=0.075, rows=rows + 1, columns=columns + 1)
        groups[material].append((on_sides(moved(shape, place), [side])[0], texcoords / 0.8))
    return [
        mesh(join(shape for shape, _ in group), materials[name], texcoords=np.concatenate([uv for _, uv in group]))
        for name, group in groups.items()
    ]


Piece = tuple[str, int, float, float, tuple[float, float, float]]  # material, side, width, height, top left corner


def _curtains() -> list[Piece]:
    """Between the columns of both long sides: some drawn, some half open, so that light reaches the aisles."""
    colours = ("red cloth", "green cloth", "blue cloth", "gold cloth", "red cloth")
    clear = BAY - 0.62
    top = FLOOR + 2.98
    pieces: list[Piece] = []
    for side, openings in ((0, (0.45, 1, 0.5, 0.45, 1)), (2, (0.5, 0.92, 0.45, 0.8, 0.4))):
        for bay, (colour, share) in enumerate(zip(colours, openings, strict=True)):
            left = -HALF_X + BAY * bay + 0.31
            x = left if bay % 2 == 0 else left + (1 - share) * clear
            pieces.append((colour, side, share * clear, 2.62, (x, top, 0.05)))
    return pieces


def _banners() -> list[Piece]:
    """Before the slab of the gallery, above the columns."""
    colours = ("blue cloth", "gold cloth", "red cloth", "green cloth")
    places = [-HALF_X + BAY * k for k in range(1, 5)]
    return [(c, side, 0.95, 1.75, (x - 0.475, SLAB + 0.1, -0.62)) for side in (0, 2) for c, x in zip(colours, places, strict=True)]


@cache
def _materials() -> dict[str, Material]:
    """Everything by name; colours are linear."""
    n = TEXELS
    stone, joint = (0.56, 0.47, 0.36), (0.34, 0.3, 0.25)
    images = {
        "ashlar": masonry(n, 6, 3, 0.008, stone, joint, 0.1, seed=1),
        "bricks": masonry(n, 16, 8, 0.009, (0.52, 0.31, 0.21), (0.56, 0.5, 0.42), 0.18, seed=2),
        "plaster": plain(n, 3, (0.68, 0.61, 0.5), 0.1, seed=15),
        "flagstones": masonry(n, 4, 3, 0.01, (0.44, 0.4, 0.34), (0.2, 0.18, 0.15), 0.14, seed=3),
        "tiles": chequers(n, 8, (0.6, 0.54, 0.44), (0.3, 0.1, 0.06), 0.006, seed=4),
        "marble": plain(n, 4, (0.64, 0.59, 0.52), 0.16, seed=5),
        "roof": masonry(n, 8, 8, 0.02, (0.46, 0.19, 0.1), (0.16, 0.07, 0.05), 0.2, seed=6),
        "wood": planks(n, 6, (0.24, 0.13, 0.06), seed=7),
        "clay": plain(n, 4, (0.5, 0.24, 0.13), 0.2, seed=8),
        "leaves": plain(n // 4, 4, (0.1, 0.3, 0.06), 0.35, seed=9),
        "iron": plain(n // 4, 4, (0.06, 0.06, 0.065), 0.2, seed=10),
        **{name: brocade(n, colour, thread, seed=11 + k) for k, (name, (colour, thread)) in enumerate(CLOTHS.items())},
    }
    return {name: Material(name=name, albedo_map=Texture(encoded(image))) for name, image in images.items()}
