"""An environment as a few suns: regions of equal energy, a directional light for each [Debevec 2005, A median cut algorithm]."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.metrics import LUMINANCE
from interreflect.scenes.checks import boolean, direction, whole
from interreflect.scenes.compile import environment_rotation
from interreflect.scenes.lights import DirectionalLight, EnvironmentLight

Floats = NDArray[np.float64]
MOST = 4096
LEAST_ROWS = 128  # smaller images are cut within their texels
SPREAD = 1e-6  # of a region's energy: a net flux below it has no direction


def directional_lights(
    environment: EnvironmentLight, count: int, *, hemisphere: bool = True, up: ArrayLike = (0.0, 1.0, 0.0)
) -> tuple[DirectionalLight, ...]:
    """At most `count` directional lights that light a scene as `environment` does, the strongest first.

    The image is cut where it halves a region's energy (luminance times solid angle), across the longer side, the region of most energy
    next, until there are `count` [Debevec 2005, with counts other than powers of two]. A light stands for a region: its direction is the
    mean one of the region's luminance, its irradiance, W/m^2, what the region brings to a surface that faces it. So a surface that sees
    all of the lights and all of the environment gets the environment's luminance, at any count, if every region lies within 90 degrees
    of its light; colours converge. Debevec's lights carry a region's flux instead, which makes that surface too bright, twice under one
    light for a constant hemisphere.

    hemisphere: only what comes from above the horizon, as most scenes stand on something; False: all around. up: the scene's.
    A texel counts as constant over its area. The same lights every time; fewer than `count` where fewer texels are lit, none under black.
    ValueError names the argument, its bound and its value.
    """
    if not isinstance(environment, EnvironmentLight):
        raise ValueError(f"environment must be an EnvironmentLight, got {type(environment).__name__}")
    wanted = whole("count", count, 1, MOST)
    sky = _sky(environment, boolean("hemisphere", hemisphere))
    world_from_light = environment_rotation(direction("up", up), environment.rotation)
    return tuple(_light(sky, region, world_from_light) for region in _regions(sky, wanted))


@dataclass(frozen=True)
class _Sky:
    """Texels in the frame of the image. Integrals over a texel at (row, column): solid angle[row]; of the direction, (level[row] * east
    [column], rise[row], level[row] * north[column]), with (east, up, north) along (+x, +y, +z)."""

    radiance: NDArray[np.floating[Any]]  # (rows, columns, 3)
    energy: Floats  # (rows, columns): luminance times solid angle
    latitude: Floats  # (rows + 1,): of the rows' edges
    rise: Floats  # (rows,)
    level: Floats  # (rows,)
    east: Floats  # (columns,)
    north: Floats  # (columns,)


class _Region(NamedTuple):
    top: int
    bottom: int
    left: int
    right: int

    @property
    def place(self) -> tuple[slice, slice]:
        return slice(self.top, self.bottom), slice(self.left, self.right)


def _sky(environment: EnvironmentLight, hemisphere: bool) -> _Sky:
    given = np.ones((1, 1, 3)) if environment.image is None else environment.image
    times = -(-LEAST_ROWS // len(given))
    image = np.repeat(np.repeat(given, times, 0), 2 * times if environment.image is None else times, 1)
    polar = np.linspace(0, np.pi, len(image) + 1)
    if hemisphere:
        rows = -(-len(image) // 2)
        image, polar = image[:rows], np.minimum(polar[: rows + 1], np.pi / 2)
    azimuth = np.linspace(-np.pi, np.pi, image.shape[1] + 1)
    width = 2 * np.pi / image.shape[1]
    solid_angle = width * -np.diff(np.cos(polar))
    luminance = image @ (LUMINANCE * environment.radiance)
    return _Sky(
        radiance=image * np.asarray(environment.radiance),
        energy=luminance * solid_angle[:, None],
        latitude=np.pi / 2 - polar,
        rise=width * np.diff(np.sin(polar) ** 2) / 2,
        level=np.diff(polar / 2 - np.sin(2 * polar) / 4),
        east=-np.diff(np.cos(azimuth)),
        north=-np.diff(np.sin(azimuth)),
    )


def _regions(sky: _Sky, count: int) -> list[_Region]:
    """Lit regions, that of most energy first."""
    whole_sky = _Region(0, sky.energy.shape[0], 0, sky.energy.shape[1])
    open_ones = [(-_energy(sky, whole_sky), whole_sky)] if sky.energy.any() else []
    final: list[tuple[float, _Region]] = []
    while open_ones and len(open_ones) + len(final) < count:
        weight, region = heapq.heappop(open_ones)
        parts = _halves(sky, region)
        if parts is None:
            final.append((weight, region))
            continue
        for part in parts:
            heapq.heappush(open_ones, (-_energy(sky, part), part))
    return [region for _, region in sorted([*open_ones, *final])]


def _energy(sky: _Sky, region: _Region) -> float:
    return float(sky.energy[region.place].sum())


def _halves(sky: _Sky, region: _Region) -> tuple[_Region, _Region] | None:
    """Both lit, by a cut across the longer side or, where that has light in one row of texels only, the other; None: one texel is lit."""
    height = sky.latitude[region.top] - sky.latitude[region.bottom]
    middle = (sky.latitude[region.top] + sky.latitude[region.bottom]) / 2
    width = (region.right - region.left) * 2 * np.pi / len(sky.east) * np.cos(middle)
    for vertical in (width >= height, width < height):
        cut = _median(sky.energy[region.place].sum(0 if vertical else 1))
        if cut is None:
            continue
        if vertical:
            return region._replace(right=region.left + cut), region._replace(left=region.left + cut)
        return region._replace(bottom=region.top + cut), region._replace(top=region.top + cut)
    return None


def _median(energies: Floats) -> int | None:
    """Where to cut so that both sides are lit and most alike; None where one alone is lit."""
    lit = np.flatnonzero(energies)
    if len(lit) < 2:
        return None
    before = np.cumsum(energies)
    places = np.arange(lit[0] + 1, lit[-1] + 1)
    return int(places[np.argmin(np.abs(before[places - 1] - before[-1] / 2))])


def _light(sky: _Sky, region: _Region, world_from_light: Floats) -> DirectionalLight:
    rows, columns = region.place
    luminance = sky.radiance[region.place] @ LUMINANCE
    level, east, north = sky.level[rows], sky.east[columns], sky.north[columns]
    net = np.array([level @ luminance @ east, sky.rise[rows] @ luminance.sum(1), level @ luminance @ north])
    length = float(np.linalg.norm(net))
    towards = net / length if length > SPREAD * _energy(sky, region) else np.array([0.0, 1.0, 0.0])
    facing = level[:, None] * (east * towards[0] + north * towards[2]) + (sky.rise[rows] * towards[1])[:, None]
    irradiance = np.einsum("ijc,ij->c", sky.radiance[region.place], np.maximum(facing, 0))
    x, y, z = (float(v) for v in world_from_light @ -towards)
    red, green, blue = (float(v) for v in irradiance)
    return DirectionalLight(direction=(x, y, z), irradiance=(red, green, blue))
