"""Do two sets of renderings have the same mean? Per tile for place, over the picture for a small bias everywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Comparison:
    """p_values: of Welch's t-test for every tile and channel. mean: relative difference of the pictures' means and its standard error."""

    p_values: NDArray[np.float64]
    mean_difference: float
    mean_error: float

    def share_below(self, p: float) -> float:
        return float((self.p_values < p).mean())


def compare(a: NDArray[np.float32], b: NDArray[np.float32], tile: int = 8) -> Comparison:
    """a, b: (renderings, height, width, 3), independent seeds. Tiles that do not fill the picture's border are left out."""
    from scipy import stats

    def tiles(x: NDArray[np.float32]) -> NDArray[np.float64]:
        n, h, w, _ = x.shape
        h, w = h // tile * tile, w // tile * tile
        cut = x[:, :h, :w].astype(np.float64)
        return cut.reshape(n, h // tile, tile, w // tile, tile, 3).mean((2, 4))

    ta, tb = tiles(a), tiles(b)
    # Noise at the size of rounding: tiles that are exactly equal in all renderings, black ones above all, get a p-value as well.
    rng, floor = np.random.default_rng(0), 1e-7 * float(ta.mean())
    ta, tb = (x + floor * rng.standard_normal(x.shape) for x in (ta, tb))
    p = stats.ttest_ind(ta, tb, axis=0, equal_var=False).pvalue
    ma, mb = a.mean((1, 2, 3), dtype=np.float64), b.mean((1, 2, 3), dtype=np.float64)
    error = np.sqrt(ma.var(ddof=1) / len(ma) + mb.var(ddof=1) / len(mb)) / ma.mean()
    return Comparison(np.asarray(p), float(mb.mean() / ma.mean() - 1), float(error))
