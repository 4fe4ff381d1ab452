"""Procedural textures: (size, size, 3) uint8 sRGB, repeating in both directions, of the same bits every time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
BRIGHTEST = 0.78  # linear: stays below the albedo that built-in scenes keep to


def encoded(linear: Floats) -> NDArray[np.uint8]:
    """Linear reflectance as 8-bit sRGB [IEC 61966-2-1]."""
    x = np.clip(linear, 0, BRIGHTEST)
    srgb = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return np.asarray(np.rint(255 * srgb).astype(np.uint8))


def noise(size: int, cells: int, seed: int, octaves: int = 4) -> Floats:
    """(size, size) smooth value noise in [0, 1], mean about 1/2; each octave has half the amplitude at twice the frequency."""
    total, weight = np.zeros((size, size)), 0.0
    for octave in range(octaves):
        n = cells << octave
        lattice = np.random.default_rng((seed, octave)).uniform(size=(n, n))
        at = np.arange(size) * (n / size)
        low = at.astype(int)
        t = at - low
        t = t * t * (3 - 2 * t)
        rows = lattice[low] * (1 - t)[:, None] + lattice[(low + 1) % n] * t[:, None]
        total += 0.5**octave * (rows[:, low] * (1 - t) + rows[:, (low + 1) % n] * t)
        weight += 0.5**octave
    return np.asarray(total / weight)


def masonry(size: int, courses: int, blocks: int, joint: float, colour: ArrayLike, mortar: ArrayLike, vary: float, seed: int) -> Floats:
    """Linear colours of blocks in running bond. `joint`: its width over the texture's; `vary`: how much blocks differ, 0 to 1."""
    y, x = np.meshgrid(*[(np.arange(size) + 0.5) / size] * 2, indexing="ij")
    row = np.floor(y * courses).astype(int)
    along = x * blocks + 0.5 * (row % 2)
    column = np.floor(along).astype(int) % blocks
    edge = np.minimum(_to_edge(y * courses) / courses, _to_edge(along) / blocks)
    worn = joint * (0.7 + 0.6 * noise(size, 16, seed + 1))
    solid = np.clip((edge - 0.5 * worn) * size / 1.5 + 0.5, 0, 1)[..., None]
    rng = np.random.default_rng(seed)
    tone = 1 + vary * rng.uniform(-1, 1, (courses, blocks, 1)) + 0.15 * vary * rng.uniform(-1, 1, (courses, blocks, 3))
    grain = 0.86 + 0.28 * noise(size, 8, seed + 2, octaves=6)[..., None]
    return np.asarray(grain * (solid * np.asarray(colour) * tone[row, column] + (1 - solid) * np.asarray(mortar)))


def _to_edge(x: Floats) -> Floats:
    """Distance to the next whole number."""
    return np.asarray(np.abs(x - np.rint(x)))


def chequers(size: int, fields: int, light: ArrayLike, dark: ArrayLike, joint: float, seed: int) -> Floats:
    """Linear colours of a chequered floor of worn tiles."""
    y, x = np.meshgrid(*[(np.arange(size) + 0.5) / size * fields] * 2, indexing="ij")
    row, column = np.floor(y).astype(int), np.floor(x).astype(int)
    base = np.where(((row + column) % 2 == 0)[..., None], light, dark)
    tone = np.random.default_rng(seed).uniform(0.85, 1.1, (fields, fields))[row, column]
    solid = np.clip((np.minimum(_to_edge(x), _to_edge(y)) / fields - 0.5 * joint) * size / 1.5 + 0.5, 0, 1)
    wear = 0.84 + 0.3 * noise(size, 4, seed + 1, octaves=6)
    return np.asarray(base * (tone * wear * (0.55 + 0.45 * solid))[..., None])


def plain(size: int, cells: int, colour: ArrayLike, vary: float, seed: int) -> Floats:
    """Linear colours of one material with clouds of light and dark, `vary` from 0 to 1."""
    return np.asarray(np.asarray(colour) * (1 - vary + 2 * vary * noise(size, cells, seed, octaves=6))[..., None])


def brocade(size: int, colour: ArrayLike, thread: ArrayLike, seed: int) -> Floats:
    """Linear colours of a cloth with a lattice of lozenges and dots in a second thread."""
    y, x = np.meshgrid(*[(np.arange(size) + 0.5) / size * 2 * np.pi] * 2, indexing="ij")
    lattice = np.abs(np.cos(2 * x) + np.cos(2 * y))
    pattern = np.clip((0.16 - lattice) * 8, 0, 1) + np.clip((lattice - 1.75) * 8, 0, 1)
    weave = 0.9 + 0.2 * noise(size, 32, seed, octaves=3)
    mixed: Floats = np.asarray(colour) + np.clip(pattern, 0, 1)[..., None] * np.subtract(thread, colour)
    return np.asarray(mixed * weave[..., None])


def planks(size: int, boards: int, colour: ArrayLike, seed: int) -> Floats:
    """Linear colours of upright boards with grain."""
    x = np.broadcast_to((np.arange(size) + 0.5) / size, (size, size))
    board = np.floor(x * boards).astype(int)
    tone = np.random.default_rng(seed).uniform(0.7, 1.2, boards)[board]
    bend = noise(size, 4, seed + 1)
    grain = 0.85 + 0.15 * np.sin(2 * np.pi * (24 * x + 6 * bend))
    gap = np.clip(_to_edge(x * boards) / boards * size / 2, 0.25, 1)
    return np.asarray(np.asarray(colour) * (tone * grain * gap)[..., None])
