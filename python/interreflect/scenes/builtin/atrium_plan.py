"""Where everything in the atrium stands. Lengths in metres, y up, the court's middle at the origin."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.builtin.atrium_parts import baluster, column, fountain, plant, repeated, urn
from interreflect.scenes.builtin.shapes import Shape, arcade, box, join, moved, ring, tube

HALF_X, HALF_Z = 8.0, 3.2  # of the court, to the columns' axes
BAY = 3.2  # from lower column to lower column; upper arches are half as wide
AISLE = 2.8  # from the columns' axes to the outer walls
WALL = 0.5  # thickness of the outer walls
FLOOR, SPRING = 0.12, 3.1  # of the aisles; of the lower arches
SLAB, GALLERY = 4.8, 5.1  # underside of the gallery's slab and its floor
UPPER_SPRING, ROOF = 7.55, 8.9
TURNS = (0.0, 90.0, 180.0, 270.0)  # of the sides +z, +x, -z, -x
SIDES = (0, 1, 2, 3)


class Part(NamedTuple):
    """One shape, repeated."""

    material: str
    tile: float  # metres that one texture covers
    unit: Shape
    places: NDArray[np.float64]  # (copies, 3)
    turns: NDArray[np.float64]  # (copies,)

    @property
    def triangles(self) -> int:
        """Of all copies."""
        return len(self.unit.triangles) * len(self.places)

    def shape(self) -> Shape:
        """All copies as one."""
        return repeated(self.unit, self.places, self.turns)


def part(material: str, tile: float, unit: Shape, places: ArrayLike = (0, 0, 0), turns: ArrayLike = 0) -> Part:
    """A Part from loosely given places and turns."""
    at = np.asarray(places, float).reshape(-1, 3)
    return Part(material, tile, unit, at, np.broadcast_to(np.asarray(turns, float), len(at)))


def distance(side: int) -> float:
    """From the court's middle to the columns' axes of a side."""
    return HALF_X if side % 2 else HALF_Z


def on_sides(shape: Shape, sides: tuple[int, ...] | list[int] = SIDES) -> list[Shape]:
    """`shape`, made with x along a side and z outward from its columns, on each of `sides`."""
    return [moved(moved(shape, (0, 0, distance(side))), turn=TURNS[side]) for side in sides]


def structure(fineness: float) -> list[Part]:
    """Everything but the cloth. `fineness` from 0 to 1 sets how many sides round things have."""

    def count(coarse: float, fine: float) -> int:
        return round(coarse * float((fine / coarse) ** fineness))

    return [
        *_shell(),
        *_arches(count(3, 40)),
        *_columns(count(5, 36), count(3, 44)),
        *_balustrade(count(3, 16), count(2, 26), count(3, 6)),
        *_furniture(count(6, 40), count(4, 40), count(6, 60), count(2, 12)),
    ]


def _shell() -> list[Part]:
    """Floors, outer walls, the gallery's slab, roof: each a closed solid that ends inside its neighbours."""
    inside, outside = AISLE + 0.25, AISLE + WALL
    court = box((-HALF_X - 1, -0.25, -HALF_Z - 1), (HALF_X + 1, 0, HALF_Z + 1))
    walk = ring(HALF_X, HALF_Z, [(-0.5, -0.3), (inside, -0.3), (inside, FLOOR), (-0.5, FLOOR)])
    wall = ring(HALF_X, HALF_Z, [(AISLE, -0.35), (outside, -0.35), (outside, 10.4), (AISLE, 10.4)])
    dado = ring(HALF_X, HALF_Z, [(AISLE - 0.05, 0), (AISLE + 0.05, 0), (AISLE + 0.05, FLOOR + 1.15), (AISLE - 0.05, FLOOR + 1.1)])
    edge = [(-0.3, SLAB), (-0.34, SLAB + 0.08), (-0.44, SLAB + 0.14), (-0.48, SLAB + 0.26), (-0.4, GALLERY - 0.02)]
    slab = ring(HALF_X, HALF_Z, [(inside, SLAB), (inside, GALLERY - 0.02), *edge[::-1]])
    upper_floor = ring(HALF_X, HALF_Z, [(-0.38, GALLERY - 0.04), (inside, GALLERY - 0.04), (inside, GALLERY), (-0.38, GALLERY)])
    eaves = [(-0.32, ROOF), (-0.36, ROOF + 0.1), (-0.55, ROOF + 0.18), (-0.55, ROOF + 0.28)]
    roof = ring(HALF_X, HALF_Z, [(inside, ROOF), (inside, ROOF + 0.28), *eaves[::-1]])
    tiles = ring(HALF_X, HALF_Z, [(-0.7, ROOF + 0.26), (inside, ROOF + 0.26), (inside, ROOF + 1.3), (-0.7, ROOF + 0.34)])
    return [
        part("flagstones", 2.4, court),
        part("tiles", 2.4, join([walk, upper_floor])),
        part("plaster", 3.0, wall),
        part("bricks", 1.6, dado),
        part("ashlar", 2.0, join([slab, roof])),
        part("roof", 1.6, tiles),
    ]


def _arches(segments: int) -> list[Part]:
    """Arcades on all sides and storeys, and arches across the aisles; all end in piers or walls."""
    walls = []
    for side in SIDES:
        span = 2 * (HALF_Z if side % 2 else HALF_X)
        bays = round(span / BAY)
        lower = arcade(span, bays, (BAY - 0.66) / 2, SLAB + 0.05 - SPRING, 0.5, segments)
        upper = arcade(span, 2 * bays, (BAY / 2 - 0.44) / 2, ROOF + 0.05 - UPPER_SPRING, 0.36, segments)
        walls += on_sides(join([moved(lower, (0, SPRING, 0)), moved(upper, (0, UPPER_SPRING, 0))]), [side])
    rib = moved(arcade(AISLE + 0.1, 1, 1.1, SLAB + 0.05 - SPRING, 0.36, segments), (0, SPRING, AISLE / 2 + 0.05), turn=90)
    ribs = on_sides(join(moved(rib, (x, 0, 0)) for x in _axes(2 * HALF_X, 5)), [0, 2])
    return [part("ashlar", 2.0, join([*walls, *ribs]))]


def _axes(span: float, bays: int) -> list[float]:
    """Where columns stand between the piers at both ends."""
    return [span * k / bays - span / 2 for k in range(1, bays)]


def _stands(halving: int) -> list[tuple[float, float, float]]:
    """Places of all columns of a storey, whose bays are BAY / halving wide."""
    places = []
    for side in SIDES:
        span = 2 * (HALF_Z if side % 2 else HALF_X)
        for x in _axes(span, halving * round(span / BAY)):
            at = on_sides(Shape(np.array([[x, 0.0, 0.0]]), np.zeros((1, 3), np.uint32)), [side])[0].positions[0]
            places.append((float(at[0]), 0.0, float(at[2])))
    return places


def _columns(sides: int, rings: int) -> list[Part]:
    """Columns, piers at the corners, and pilasters where arches across the aisles meet the walls."""
    lower, upper = np.array(_stands(1)), np.array(_stands(2))
    big = column(SPRING + 0.02 - FLOOR + 0.02, 0.25, sides, rings)
    small = column(UPPER_SPRING + 0.02 - GALLERY + 0.02, 0.14, max(sides * 3 // 4, 4), max(rings * 3 // 4, 3))
    pier = join([box((-0.42, -0.2, -0.42), (0.42, SLAB + 0.05, 0.42)), box((-0.36, SLAB, -0.36), (0.36, ROOF + 0.05, 0.36))])
    corners = [(sx * HALF_X, 0, sz * HALF_Z) for sx in (-1, 1) for sz in (-1, 1)]
    pilaster = box((-0.25, 0.0, AISLE - 0.16), (0.25, SPRING + 0.02, AISLE + 0.1))
    along = [shape for x in _axes(2 * HALF_X, 5) for shape in on_sides(moved(pilaster, (x, 0, 0)), [0, 2])]
    return [
        part("marble", 1.2, big, lower + np.array((0, FLOOR - 0.02, 0))),
        part("marble", 1.2, small, upper + np.array((0, GALLERY - 0.02, 0))),
        part("ashlar", 2.0, pier, corners),
        part("ashlar", 2.0, join(along)),
    ]


def _balustrade(sides: int, rings: int, posts: int) -> list[Part]:
    """Rails around the gallery with turned posts between the upper columns."""
    foot = [(-0.09, GALLERY - 0.01), (0.09, GALLERY - 0.01), (0.09, GALLERY + 0.1), (-0.09, GALLERY + 0.1)]
    rail = [(-0.11, GALLERY + 0.85), (0.11, GALLERY + 0.85), (0.13, GALLERY + 0.97), (-0.13, GALLERY + 0.97)]
    rails = join([ring(HALF_X, HALF_Z, foot), ring(HALF_X, HALF_Z, rail)])
    bay, edge = BAY / 2, 0.24
    offsets = edge + (np.arange(posts) + 0.5) * ((bay - 2 * edge) / posts)
    places = []
    for side in SIDES:
        span = 2 * (HALF_Z if side % 2 else HALF_X)
        x = (np.arange(round(span / bay))[:, None] * bay + offsets - span / 2).ravel()
        row = np.stack([x, np.zeros_like(x), np.zeros_like(x)], 1)
        places.append(on_sides(Shape(row, np.zeros((1, 3), np.uint32)), [side])[0].positions)
    post = moved(baluster(0.79, sides, rings), (0, GALLERY + 0.08, 0))
    return [part("marble", 1.2, rails), part("marble", 1.2, post, np.concatenate(places))]


def _furniture(sides: int, rings: int, leaves: int, pieces: int) -> list[Part]:
    """A fountain in the sun, urns with plants before the piers, doors in the end walls, rods for the curtains."""
    spots = np.array([(sx * (HALF_X - 1.15), 0, sz * (HALF_Z - 0.95)) for sx in (-1, 1) for sz in (-1, 1)])
    end = HALF_X + AISLE
    leaf = [box((end - 0.06, FLOOR - 0.02, z - 0.78), (end + 0.05, FLOOR + 2.5, z + 0.78)) for z in (-0.8, 0.8)]
    doors = join(leaf + [moved(shape, turn=180) for shape in leaf])
    frame = box((end - 0.1, FLOOR - 0.02, -1.85), (end + 0.05, FLOOR + 2.75, -1.6))
    frames = [frame, moved(frame, (0, 0, 3.45)), box((end - 0.12, FLOOR + 2.52, -1.95), (end + 0.06, FLOOR + 2.85, 1.95))]
    rod = tube((-HALF_X, FLOOR + 3.0, 0.05), (HALF_X, FLOOR + 3.0, 0.05), 0.022, 6)
    return [
        part("marble", 1.2, fountain(sides, rings), (-1.6, -0.02, 0)),
        part("clay", 0.8, urn(sides, rings), spots + np.array((0, -0.01, 0))),
        part("leaves", 0.5, plant(leaves, pieces), spots + np.array((0, 0.78, 0)), (0, 100, 190, 280)),
        part("wood", 1.2, doors),
        part("ashlar", 2.0, join(frames + [moved(shape, turn=180) for shape in frames])),
        part("iron", 0.5, join(on_sides(rod, [0, 2]))),
    ]
