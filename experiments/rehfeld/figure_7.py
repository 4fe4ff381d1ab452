"""Figure 7: Indirect light with different Phong exponents."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import Image, caching, difference, indirect, own
from experiments.rehfeld.sites import by_site, everywhere, tables
from experiments.shared.panels import as_light, groups

EXPONENTS = (10.0, 50.0, 150.0, 500.0, 1000.0)
SIZE = (436, 286)
SPP = 64  # of each half of the truth
BLOCK = 2  # pixels along a side of what is compared: its mean has four times the samples


def studies() -> Sequence[ir.Study]:
    """An exponent after the other, each a scene of its own: the light, and the truth in two halves."""
    found: list[ir.Study] = []
    halves = [ir.methods.PathTracing(spp=SPP, bounces=1, pixel="centre")]
    for exponent in EXPONENTS:
        found += everywhere("exponents", [caching(), own()], exponent, size=SIZE)
        found += everywhere("exponents, truth in halves", halves, exponent, size=SIZE, seeds=(0, 1))
    return found


def table(*records: ir.Records) -> pd.DataFrame:
    """A row per site and exponent, of the indirect light in means of 2 x 2 pixels against one-bounce truth: FLIP, relative difference
    and the energy's ratio; `own`, FLIP of a cache of 32 x 32 at every pixel, where neither sharing nor 16 x 16 texels cost anything;
    `halves`, FLIP between the truth's halves, twice as far from each other as the truth from what is right; and `shared`, the relative
    difference between the caches and those at every pixel, in which is no noise."""
    return tables(_table, records)


def _table(*records: ir.Records) -> pd.DataFrame:
    return pd.DataFrame({e: _row(*pair) for e, pair in _by_exponent(records).items()}).T


def _by_exponent(records: Sequence[ir.Records]) -> dict[float, tuple[ir.Records, ir.Records]]:
    return dict(zip(EXPONENTS, zip(records[::2], records[1::2], strict=True), strict=True))


def _row(light: ir.Records, halves: ir.Records) -> dict[str, float]:
    ours, apart, *both = map(blocks, (indirect(light, 0), indirect(light, 1), indirect(halves, 0), indirect(halves, 1)))
    truth = (both[0] + both[1]) / 2
    return {
        "flip": float(ir.metrics.flip(ours, truth)),
        "own": float(ir.metrics.flip(apart, truth)),
        "halves": float(ir.metrics.flip(*both)),
        "difference": difference(ours, truth),
        "energy": float(ir.metrics.energy_ratio(ours, truth)),
        "shared": difference(ours, apart),
    }


def blocks(image: Image) -> Image:
    """Means of blocks of pixels; what is left over at the right and below is cut off."""
    height, width = (side // BLOCK for side in image.shape[:2])
    cut = image[: height * BLOCK, : width * BLOCK]
    return np.asarray(cut.reshape(height, BLOCK, width, BLOCK, 3).mean((1, 3)))


def chart(*records: ir.Records) -> Figure:
    found = table(*records)
    return groups({site: _shown(its, found.loc[site]) for site, its in by_site(records).items()}, columns=len(EXPONENTS), width=3.2)


def _shown(records: Sequence[ir.Records], found: pd.DataFrame) -> list[tuple[str, Image]]:
    rows: tuple[list[tuple[str, Image]], ...] = ([], [], [])
    for exponent, (light, halves) in _by_exponent(records).items():
        row = found.loc[exponent]
        truth = (indirect(halves, 0) + indirect(halves, 1)) / 2
        named = (
            (f"exponent {exponent:g}: FLIP {row['flip']:.3f}", indirect(light, 0)),
            (f"a cache of 32 x 32 a pixel: FLIP {row['own']:.3f}", indirect(light, 1)),
            (f"path-traced truth: its halves' FLIP {row['halves']:.3f}", truth),
        )
        for shown, (name, image) in zip(rows, named, strict=True):
            shown.append((name, as_light(blocks(image), blocks(truth))))
    return [picture for row in rows for picture in row]
