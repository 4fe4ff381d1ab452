"""Parts of a page: tables that sort, pictures and figures inlined, data for scripts."""

from __future__ import annotations

import base64
import io
import json
import math
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


def section(title: str, body: str) -> str:
    """Nothing where there is no body."""
    return f"<section><h2>{escape(title)}</h2>{body}</section>" if body else ""


def table(rows: pd.DataFrame, points: Sequence[int] | None = None) -> str:
    """A table that sorts when its heads are pressed; numbers carry their full value for that. points: what each row shows, for filters."""
    head = "".join(f'<th><button type="button">{escape(str(name))}</button></th>' for name in rows.columns)
    marks = [""] * len(rows) if points is None else [f' data-point="{point}"' for point in points]
    lines = zip(rows.itertuples(index=False), marks, strict=True)
    body = "".join(f"<tr{mark}>" + "".join(_cell(value) for value in row) + "</tr>" for row, mark in lines)
    return f'<div class="wide"><table class="sortable"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def card(rows: Iterable[tuple[str, str]]) -> str:
    """Names and values."""
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows)
    return f'<div class="wide"><table class="card">{cells}</table></div>'


def drawn(draw: Callable[..., Figure], alt: str) -> str:
    """A figure for light and for dark pages; or why there is none."""
    try:
        light, dark = (png_of_figure(draw(dark=dark)) for dark in (False, True))
    except ValueError as error:
        return f"<p>{escape(str(error))}</p>"
    source = f'<source media="(prefers-color-scheme: dark)" srcset="{dark}">'
    return f'<picture>{source}<img src="{light}" alt="{escape(alt)}"></picture>'


def png_of_figure(figure: Figure) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", facecolor=figure.get_facecolor())
    return inline(buffer.getvalue(), "image/png")


def png_of_image(image: npt.NDArray[np.floating]) -> str:
    """(height, width, 3) in [0, 1]."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray((np.clip(image, 0, 1) * 255 + 0.5).astype(np.uint8)).save(buffer, format="png")
    return inline(buffer.getvalue(), "image/png")


def inline(content: bytes, kind: str) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def script_data(name: str, content: Any) -> str:
    """JSON that scripts of the page read; nothing in it can end the element."""
    text = json.dumps(content, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{text}</script>'


def _cell(value: Any) -> str:
    if isinstance(value, int | float | np.number) and not isinstance(value, bool):
        number = float(value)
        text = "–" if math.isnan(number) else f"{number:.4g}"
        return f'<td class="number" data-value="{number!r}">{text}</td>'
    return f"<td>{escape('' if value is None else str(value))}</td>"
