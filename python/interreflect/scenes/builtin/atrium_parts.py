"""What the atrium is built of: each part at the origin, as fine as it is asked to be. Lengths in metres."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.builtin.shapes import Shape, box, join, moved, revolved, sheet

Floats = NDArray[np.float64]


def simplified(line: Floats, points: int) -> Floats:
    """The `points` of a (n, 2) line that keep its form best: again and again the one farthest from what is kept so far."""
    kept = [0, len(line) - 1]
    while len(kept) < min(points, len(line)):
        distance = np.concatenate([_from_chord(line[a : b + 1])[:-1] for a, b in pairwise(kept)] + [np.zeros(1)])
        kept = sorted([*kept, int(distance.argmax())])
    return line[kept]


def _from_chord(line: Floats) -> Floats:
    """Distance of each point from the straight line between the first and the last."""
    chord = line[-1] - line[0]
    away = line - line[0]
    return np.asarray(np.abs(chord[0] * away[:, 1] - chord[1] * away[:, 0]) / np.linalg.norm(chord))


def _torus(radius: float, low: float, high: float) -> Floats:
    """Profile of a half-round moulding that bulges out from `radius`."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, 13)
    half = (high - low) / 2
    return np.stack([radius + half * np.cos(angle), low + half + half * np.sin(angle)], 1)


def column(height: float, radius: float, sides: int, rings: int) -> Shape:
    """Plinth, base, tapered shaft, capital and abacus; its abacus ends at `height`."""
    r = radius
    plinth, abacus = 0.6 * r, 0.55 * r
    neck = height - abacus - 1.5 * r
    t = np.linspace(0, 1, 15)
    shaft = np.stack([r * (1 - 0.16 * t**2), plinth + 0.95 * r + t * (neck - plinth - 0.95 * r)], 1)
    bell = np.stack([0.84 * r + 0.62 * r * t**2.5, neck + 0.25 * r + t * 1.25 * r], 1)
    base = [_torus(1.12 * r, plinth, plinth + 0.42 * r), _torus(1.0 * r, plinth + 0.55 * r, plinth + 0.85 * r)]
    sunk = 0.01  # both open ends, into plinth and abacus
    ends = [(1.12 * r, plinth - sunk)], [(1.4 * r, height - abacus + sunk)]
    line = np.concatenate([ends[0], *base, shaft, _torus(0.84 * r, neck, neck + 0.25 * r), bell, ends[1]])
    round_part = revolved(simplified(line, rings), sides)
    wide = 1.48 * r
    square = [box((-wide, 0, -wide), (wide, plinth, wide)), box((-wide, height - abacus, -wide), (wide, height, wide))]
    return join([round_part, *square])


def baluster(height: float, sides: int, rings: int) -> Shape:
    """A turned post that swells below its middle."""
    t = np.linspace(0, 1, 41)
    radius = 0.035 + 0.045 * np.exp(-(((t - 0.3) / 0.16) ** 2)) + 0.025 * (np.exp(-((t / 0.06) ** 2)) + np.exp(-(((1 - t) / 0.06) ** 2)))
    return revolved(simplified(np.stack([radius, t * height], 1), rings), sides)


def urn(sides: int, rings: int) -> Shape:
    """A foot, a belly and a lip, 0.9 high, closed by soil a little below the lip."""
    t = np.linspace(0, 1, 33)
    belly = np.stack([0.14 + 0.27 * np.sin(np.pi * (0.15 + 0.68 * t)) ** 1.5, 0.12 + 0.68 * t], 1)
    line = np.concatenate([[(0.24, 0), (0.24, 0.06), (0.14, 0.12)], belly, [(0.36, 0.84), (0.36, 0.9), (0.29, 0.9), (0.27, 0.8)]])
    kept = simplified(line, rings)
    return revolved(np.concatenate([[(0, 0)], kept, [(0, kept[-1, 1])]]), sides)


def fountain(sides: int, rings: int) -> Shape:
    """A round basin with a rim, and a bowl on a stem in it."""
    basin = [(0, 0), (1.5, 0), (1.5, 0.1), (1.38, 0.16), (1.38, 0.42), (1.5, 0.5), (1.5, 0.58), (1.2, 0.58), (1.2, 0.25)]
    t = np.linspace(0, 1, 25)
    stem = np.stack([0.16 + 0.12 * (1 - t) ** 4 - 0.05 * np.sin(np.pi * t), 0.25 + 0.85 * t], 1)
    bowl = np.stack([0.16 + 0.5 * np.sin(np.pi / 2 * t), 1.1 + 0.25 * (1 - np.cos(np.pi / 2 * t))], 1)
    upper = simplified(np.concatenate([stem, bowl]), rings)
    inside = [(0.6, 1.37), (0.5, 1.24), (0.0, 1.2)]
    return join([revolved([*basin, (0, 0.25)], 2 * sides), revolved([(0, 0.24), (0.28, 0.24), *upper, (0.66, 1.38), *inside], sides)])


def plant(leaves: int, pieces: int) -> Shape:
    """Long leaves that rise from the origin and bend outward and down; thin, both sides alike."""
    t = np.linspace(0, 1, pieces + 1)
    width = 0.055 * np.sin(np.pi * (0.08 + 0.9 * t))
    made = []
    for k in range(leaves):
        level = (k * 0.618034) % 1  # golden ratio: neighbours differ, and no random numbers are needed
        reach, rise = 0.25 + 0.35 * (1 - level), 0.55 + 0.55 * level
        out, up = 0.05 + reach * t**1.4, rise * t - 0.45 * t**3 * (1.2 - level)
        leaf = np.stack([np.stack([out, up, side * width], 1) for side in (-1, 1)], 1)
        made.append(moved(sheet(leaf), turn=k * 360 * 0.381966))
    return join(made)


def cloth(width: float, height: float, folds: float, depth: float, rows: int, columns: int) -> tuple[Shape, Floats]:
    """A hanging sheet in the plane z = 0, x from 0 to `width`, y from 0 down to -`height`, with texture coordinates in metres.

    It is gathered at the top: folds are `depth` deep at the hem and half as deep at the rod.
    """
    u, v = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    phase = 2 * np.pi * folds * (u + 0.03 * np.sin(3.1 * v + 5 * u))
    z = depth * (0.5 + 0.5 * v) * (np.sin(phase) + 0.3 * np.sin(2.3 * phase + 2 * v + 1))
    x = width * u + 0.25 * depth * np.sin(phase + 1.2) * (0.3 + 0.7 * v)
    y = -height * v - 0.02 * height * v * np.sin(2 * np.pi * u)
    shape = sheet(np.stack([x, y, z], -1))
    # Folds take up cloth: about a third more than the width they hang in.
    return shape, np.stack([1.35 * width * u, -height * v], -1).reshape(-1, 2)


def repeated(shape: Shape, places: ArrayLike, turns: ArrayLike = 0) -> Shape:
    """`shape` at every one of (n, 3) `places`, each turned about +y by its own of `turns`, degrees."""
    at = np.asarray(places, float).reshape(-1, 3)
    return join(moved(shape, place, turn=turn) for place, turn in zip(at, np.broadcast_to(turns, len(at)), strict=True))
