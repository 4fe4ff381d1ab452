"""The page of an atlas: failures by methods. Each cell: the break point, the error over the knob, pictures just before and after."""

from __future__ import annotations

import math
from collections.abc import Callable
from html import escape
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from interreflect import metrics
from interreflect.frame import Image
from interreflect.stability.crossing import Crossing, Point
from interreflect.stability.failure import Failure
from interreflect.study.page import PAGE
from interreflect.study.page.parts import png_of_figure, png_of_image

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from interreflect.stability.break_points import Atlas, Cell

STYLE = """<style>
.atlas td, .atlas th { vertical-align: top; white-space: normal; }
.atlas td { min-width: 150px; } .atlas th.row { min-width: 190px; max-width: 260px; font-weight: normal; text-align: left; }
.atlas small { color: var(--faint); display: block; }
.atlas .shots { display: flex; gap: 4px; margin-top: 4px; }
.atlas .shots figure { width: 72px; } .atlas .shots img { width: 72px; image-rendering: pixelated; }
.atlas svg { display: block; margin-top: 4px; }
.breaks { color: #d55e00; font-weight: 600; } .never { color: #009e73; font-weight: 600; } .always { color: #b3004b; font-weight: 600; }
.waiting th.row { max-width: none; }
.waits, .failed { color: var(--faint); }
</style>"""
WIDTH, HEIGHT = 150, 56


def page(atlas: Atlas) -> str:
    """The whole page as HTML, without anything from elsewhere."""
    words = (
        "<p>Each failure sweeps one knob from its easy to its hard end; a method breaks where the error crosses the tolerance. Brackets "
        "hold the 95 % interval, from seeds and from the truth's own noise. Small charts: error over the knob, easy end left, both axes by "
        "decades; dashed: the tolerance. Pictures: just before the break point, just after it, and what the latter should be.</p>"
    )
    charts = "".join(
        f'<h2>{title}</h2><div class="wide"><img src="{png_of_figure(figure)}" alt="{title}"></div>'
        for title, draw in (("Break points", atlas.chart), ("Leak against over-occlusion", atlas.leak_against_occlusion))
        if (figure := _drawn(draw)) is not None
    )
    body = f"{STYLE}{words}{_grid(atlas)}{_waiting(atlas)}{charts}"
    return PAGE.replace("{title}", "Where does it break?").replace("{body}", body)


def _drawn(draw: Callable[[], Figure]) -> Figure | None:
    try:
        return draw()
    except ValueError:  # an atlas of few failures has not both kinds
        return None


def _grid(atlas: Atlas) -> str:
    head = "".join(f"<th>{escape(name)}</th>" for name in atlas.methods)
    rows = []
    for name, row in atlas.failures.items():
        if row.waits:
            continue
        cells = "".join(f"<td>{_cell(atlas.cell(method, name))}</td>" for method in atlas.methods)
        rows.append(f'<tr><th class="row">{_about(row)}</th>{cells}</tr>')
    return (
        f'<div class="wide"><table class="atlas"><thead><tr><th>failure</th>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'
    )


def _waiting(atlas: Atlas) -> str:
    """Failures of stages that do not exist yet: what they will sweep, and what they wait for."""
    rows = [row for row in atlas.failures.values() if row.waits]
    lines = "".join(f'<tr><th class="row">{_about(row)}</th><td class="waits">{escape(row.waits)}</td></tr>' for row in rows)
    title = "<h2>Failures that wait for their stage</h2>"
    return f'{title}<div class="wide"><table class="atlas waiting">{lines}</table></div>' if rows else ""


def _about(row: Failure) -> str:
    unit = f" {row.unit}" if row.unit else ""
    lines = [
        f"{row.knob}, {row.easy:.3g} to {row.hard:.3g}{unit}",
        f"error: {row.quantity}",
        f"truth: {row.truth}",
        f"tolerance {row.tolerance:g}: {row.reason}",
    ]
    return f"<b>{escape(row.name)}</b>" + "".join(f"<small>{escape(line)}</small>" for line in lines)


def _cell(cell: Cell) -> str:
    text = f'<span class="{cell.outcome}">{escape(cell.text)}</span>'
    if cell.crossing is None:
        return text
    return text + _curve(cell.failure, cell.crossing) + _shots(cell.crossing)


def _shots(crossing: Crossing) -> str:
    """Before, after and truth; the hard end where it does not cross."""
    if crossing.before is not None and crossing.after is not None:
        shown = [("before", crossing.before, False), ("after", crossing.after, False), ("truth", crossing.after, True)]
    else:
        shown = [("hard end", crossing.points[-1], False), ("truth", crossing.points[-1], True)]
    figures = []
    for name, point, wants_truth in shown:
        image = point.truth if wants_truth else point.image
        if image is not None:
            source = png_of_image(_exposed(image, point))
            figures.append(f'<figure><img src="{source}" alt="{name}"><figcaption>{name}</figcaption></figure>')
    return f'<div class="shots">{"".join(figures)}</div>'


def _exposed(image: Image, point: Point) -> NDArray[np.float64]:
    reference = point.image if point.truth is None else point.truth
    return metrics.tone_map(image, reference)


def _curve(row: Failure, crossing: Crossing) -> str:
    """Error over the sweep as a small drawing."""
    errors = [p.error for p in crossing.points if math.isfinite(p.error) and p.error > 0]
    low = min([*errors, row.tolerance]) / 2
    low = max(low, row.tolerance * 1e-3)
    high = max([*errors, row.tolerance]) * 2

    def place(share: float, error: float) -> tuple[float, float]:
        level = (math.log(min(max(error, low), high)) - math.log(low)) / (math.log(high) - math.log(low))
        return 4 + (WIDTH - 8) * share, HEIGHT - 4 - (HEIGHT - 8) * level

    spots = [place(row.share(p.value), p.error) for p in crossing.points]
    faint = 'stroke="currentColor" opacity=".35"'
    bars = "".join(
        f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{place(0, p.low)[1]:.1f}" y2="{place(0, p.high)[1]:.1f}" {faint}/>'
        for p, (x, _) in zip(crossing.points, spots, strict=True)
    )
    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in spots)
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.8" fill="currentColor"/>' for x, y in spots)
    y = place(0, row.tolerance)[1]
    tolerance = f'<line x1="0" x2="{WIDTH}" y1="{y:.1f}" y2="{y:.1f}" stroke="#d55e00" stroke-dasharray="3 3"/>'
    head = f'<svg width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="error over the knob">'
    return f'{head}{tolerance}{bars}<polyline points="{line}" fill="none" stroke="currentColor"/>{dots}</svg>'
