"""How evenly surfels lie: their distances to the nearest others, beside those of points by chance and of blue noise."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from interreflect import _core

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.floating]

# In roots of an area a point. Disks dropped at random where they fit fill .547 of the plane [Hinrichsen et al. 1986]: no two are nearer.
BLUE = 2 * float(np.sqrt(0.547 / np.pi))
# The densest packing: all are that far.
HEXAGONAL = float(np.sqrt(2 / np.sqrt(3)))


def by_chance(distance: Floats) -> Floats:
    """The density of distances to the nearest of points at random, one an area of 1 [Clark and Evans 1954]."""
    density: Floats = 2 * np.pi * distance * np.exp(-np.pi * distance**2)
    return density


@dataclass(frozen=True, eq=False)
class SurfelSpacing:
    """Distances to the nearest other surfel on the same side, over the root of the own area.

    By chance they have mean .5 and deviation .261, and .888 are nearer than those of blue noise ever are."""

    distance: Floats
    """(n,), ascending: of those that have a neighbour."""
    alone: int
    """Surfels without."""

    @property
    def mean(self) -> float:
        return float(self.distance.mean())

    @property
    def deviation(self) -> float:
        return float(self.distance.std())

    @cached_property
    def too_near(self) -> float:
        """The share nearer than any two of blue noise."""
        return float(np.searchsorted(self.distance, BLUE) / len(self.distance))

    def histogram(self, bins: int = 40) -> tuple[Floats, Floats]:
        """(bins + 1,): borders from 0 to 1.5 times the densest packing's distance; (bins,): density, what lies beyond left out."""
        count, borders = np.histogram(self.distance, bins, (0, 1.5 * HEXAGONAL))
        return borders, count / (len(self.distance) * np.diff(borders))

    def chart(self, dark: bool = False) -> Figure:
        """The histogram, the density by chance, and where blue noise begins and all of the densest packing lie."""
        from interreflect.charts.spacing import histogram

        return histogram(self, dark)

    def __repr__(self) -> str:
        apart = f"{self.mean:.3f} apart (deviation {self.deviation:.3f})"
        return f"<{len(self.distance)} surfels {apart}, {self.too_near:.1%} nearer than blue noise>"


def surfel_spacing(surfels: _core.Surfels) -> SurfelSpacing:
    """Of surfels as `place_surfels` makes them. ValueError where none has a neighbour."""
    distance = np.sort(_core.surfel_spacing(surfels))
    near = distance[np.isfinite(distance)]
    if len(near) == 0:
        raise ValueError(f"surfel_spacing: none of {len(distance)} surfels has another one on its side")
    return SurfelSpacing(near, len(distance) - len(near))
