"""Ratios over many views: their geometric mean with its interval, drawn beside every view's own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from interreflect.charts.style import COLOURS, dress, new_figure
from interreflect.study.uncertainty import mean_interval


@dataclass(frozen=True)
class Ratio:
    """Geometric mean over views with its 95 % interval (Student's t or bootstrap of the logarithms), and of how many views."""

    mean: float
    low: float
    high: float
    views: int

    def __str__(self) -> str:
        if self.views == 1:
            return f"{self.mean:.2f} in one view"
        return f"{self.mean:.2f} [{self.low:.2f}, {self.high:.2f}] over {self.views} views"

    @property
    def verdict(self) -> str:
        """Below 1, above 1, or not told apart from it."""
        if self.views == 1:
            return "no interval"
        return "less" if self.high < 1 else "more" if self.low > 1 else "no different within the interval"


def ratio(values: Sequence[float]) -> Ratio:
    """Of positive finite ratios. ValueError for others: a view that cannot be compared is to be left out by name, not silently."""
    given = np.asarray(values, float)
    if not (np.isfinite(given) & (given > 0)).all():
        raise ValueError(f"ratios must be positive and finite, got {list(values)}")
    logs = np.log(given)
    low, high = mean_interval(logs)
    return Ratio(float(np.exp(logs.mean())), float(np.exp(low)), float(np.exp(high)), len(logs))


def over(table: pd.DataFrame, value: str, way: str, base: str, views: Sequence[str]) -> pd.DataFrame:
    """Each way's `value` over that of `base` in the same view; rows that have no positive pair are left out."""
    wide = table.pivot_table(index=list(views), columns=way, values=value, sort=False)
    divided = wide.div(wide[base], axis=0).where((wide > 0) & (wide[[base]] > 0).to_numpy())
    return divided.drop(columns=base).melt(ignore_index=False, value_name="ratio").dropna().reset_index()


def strips(panels: Mapping[str, Mapping[str, Sequence[float]]], label: str) -> Figure:
    """A panel each: a strip per name, a dot per view, and the mean with its interval. Beyond the line at 1 it is more."""
    figure = new_figure((4.4 * len(panels), 1.2 + 0.42 * max(map(len, panels.values()))), dark=False)
    for axes, (title, groups) in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels.items(), strict=True):
        for y, (values, colour) in enumerate(zip(groups.values(), COLOURS, strict=False)):
            _strip(axes, y, values, colour)
        axes.axvline(1, color="grey", linewidth=0.8)
        axes.set(title=title, xscale="log", xlabel=label, ylabel="")
        axes.set_yticks(range(len(groups)), [f"{name} ({len(values)})" for name, values in groups.items()])
        axes.invert_yaxis()
        dress(axes, dark=False)
    return figure


def _strip(axes: Any, y: int, values: Sequence[float], colour: str) -> None:
    spread = np.linspace(-0.22, 0.22, len(values)) if len(values) > 1 else [0.0]
    axes.plot(sorted(values), np.add(y, spread), ".", color=colour, markersize=4, alpha=0.6)
    if len(values) > 1:
        mean = ratio(values)
        reach = [[mean.mean - mean.low], [mean.high - mean.mean]]
        axes.errorbar([mean.mean], [y], xerr=reach, fmt="o", color="black", markersize=4, capsize=3)
