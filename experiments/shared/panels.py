"""Pictures of records side by side, with one exposure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure, FigureBase
from numpy.typing import NDArray

import interreflect as ir
from interreflect.charts.style import new_figure
from interreflect.images import tone_map

Image = NDArray[np.floating]


def as_light(image: Image, reference: Image) -> Image:
    """Radiance as Freed shows it, c / (c + 1) and gamma 2.2 (algorithm 3), at the exposure of a reference."""
    return ir.metrics.tone_map(image, reference)


def as_colour(image: Image) -> Image:
    """Reflectances and shares in [0, 1], through the sRGB curve."""
    return tone_map(np.asarray(image, np.float32)) / 255.0


def as_share(image: Image) -> Image:
    """Shares in [0, 1] as they are."""
    return np.clip(image, 0, 1)


def panels(pictures: Sequence[tuple[str, Image]], columns: int = 2, width: float = 4.6, title: str = "") -> Figure:
    """Pictures of one size in rows of so many, each below its name."""
    return groups({title: pictures}, columns, width)


def groups(pictures: Mapping[str, Sequence[tuple[str, Image]]], columns: int = 2, width: float = 4.6) -> Figure:
    """Groups of pictures, one below the other, each below its title; within one all are of one size, in rows of so many."""
    columns = min(columns, max(map(len, pictures.values())))
    heights = [_height(title, group, columns, width) for title, group in pictures.items()]
    figure = new_figure((width * columns, sum(heights)), dark=False)
    parts = figure.subfigures(len(heights), 1, squeeze=False, height_ratios=heights)[:, 0]
    for part, (title, group) in zip(parts, pictures.items(), strict=True):
        _fill(part, title, group, columns)
    return figure


def _height(title: str, pictures: Sequence[tuple[str, Image]], columns: int, width: float) -> float:
    """Inches of a group: a line above each row for the names, one above all for the title."""
    height, across = pictures[0][1].shape[:2]
    return -(-len(pictures) // columns) * (width * height / across + 0.3) + (0.3 if title else 0)


def _fill(part: FigureBase, title: str, pictures: Sequence[tuple[str, Image]], columns: int) -> None:
    axes = part.subplots(-(-len(pictures) // columns), columns, squeeze=False).ravel()
    for ax in axes:
        ax.set_axis_off()
    for ax, (name, picture) in zip(axes, pictures, strict=False):
        ax.imshow(picture, interpolation="nearest" if picture.shape[1] < 200 else "antialiased")
        ax.set_title(name, fontsize=9)
    if title:
        part.suptitle(title, fontsize=10)


def picture(records: ir.Records, index: int = 0) -> Image:
    return records.images(records[index])[0]


def table_figure(table: pd.DataFrame, title: str) -> Figure:
    """A table of numbers, with two digits after the point; what there is not stays empty."""
    heads = ["\n".join(map(str, name)) if isinstance(name, tuple) else str(name) for name in table.columns]
    figure = new_figure((2.6 + 0.95 * len(heads), 0.9 + 0.3 * len(table)), dark=False)
    axes = figure.subplots()
    axes.set_axis_off()
    cells = [["" if np.isnan(value) else f"{value:.2f}" for value in row] for row in table.to_numpy()]
    drawn = axes.table(cellText=cells, rowLabels=[str(name) for name in table.index], colLabels=heads, loc="center", cellLoc="right")
    drawn.auto_set_font_size(False)
    drawn.set_fontsize(8)
    for (row, _), cell in drawn.get_celld().items():
        cell.set(linewidth=0.4, height=(1.7 if row == 0 and any("\n" in head for head in heads) else 1.0) / (len(table) + 3))
    axes.set_title(title, fontsize=9)
    return figure
