"""One self-contained page of a study: fronts, charts, pictures beside truth, every number, the machine. Reads records only."""

from __future__ import annotations

import base64
import io
import math
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from interreflect import charts, metrics
from interreflect.study.configurations import VIEW, configurations
from interreflect.study.files import replacing
from interreflect.study.page import PAGE
from interreflect.study.pareto import equal_error, hypervolume, pareto
from interreflect.study.records import OK, Record, Records

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MEASURED = (
    "milliseconds", "milliseconds_p95", "precompute_milliseconds", "relmse", "trimmed_relmse", "indirect_relmse",
    "energy_ratio", "indirect_energy_ratio", "flip", "ssim", "hue_shift", "noise", "seeds",
)  # fmt: skip
ERROR_BOUNDS = (0.1, 0.03, 0.01, 0.003)  # relMSE at which methods are compared for time


def report(records: Records, path: str | Path) -> Path:
    """Write the study's page: one HTML file with everything inside, light or dark as the reader's system is. Returns its path.

    What cannot be drawn, as every cell failed or no pictures were kept, is said on the page.
    """
    sections = [
        _section("What was measured", _summary(records)),
        _section("Speed against accuracy", _chart(charts.speed_accuracy, records)),
        _section("On the front", _front(records)),
        _section("Time to equal error", _equal_error(records)),
        _section("Pictures beside the truth", _pictures(records)),
        _section("Where the time goes", _chart(charts.stages, records)),
        _section("Every configuration", _configurations(records)),
        _section("Cells that failed", _failures(records)),
        _section("The machine", _machines(records)),
    ]
    page = PAGE.replace("{title}", escape(records.study)).replace("{body}", "".join(sections))
    target = Path(path)
    with replacing(target) as file:
        file.write(page.encode())
    return target


def _section(title: str, body: str) -> str:
    return f"<section><h2>{escape(title)}</h2>{body}</section>" if body else ""


def _summary(records: Records) -> str:
    failed = sum(record.status != OK for record in records)
    lines = [f"{len(records)} cells, {failed} of them without a measured picture."]
    if records.missing:
        lines.append(f"{records.missing} cells are not measured yet.")
    warnings = [f"Damaged and left out: {text}" for text in records.damaged]
    warnings += dict.fromkeys(f"{record.scene}, {record.method}: {text}" for record in records for text in record.warnings)
    listed = "".join(f"<li>{escape(text)}</li>" for text in warnings)
    return "".join(f"<p>{escape(line)}</p>" for line in lines) + (f'<ul class="warnings">{listed}</ul>' if listed else "")


def _chart(draw: Any, records: Records) -> str:
    """A chart for light and for dark pages; or why there is none."""
    try:
        light, dark = (_png_of(draw(records, dark=dark)) for dark in (False, True))
    except ValueError as error:
        return f"<p>{escape(str(error))}</p>"
    source = f'<source media="(prefers-color-scheme: dark)" srcset="{dark}">'
    return f'<picture>{source}<img src="{light}" alt="chart: {draw.__name__}"></picture>'


def _front(records: Records) -> str:
    front = pareto(records)
    if front.empty:
        return ""
    front["configuration"] = [charts.label(records, row) for _, row in front.iterrows()]
    return _table(front[[*VIEW, "configuration", "milliseconds", "relmse", "note"]])


def _equal_error(records: Records) -> str:
    """Method -> time to each bound of relMSE; a dash where no configuration reaches it."""
    import pandas as pd

    parts = []
    for bound in ERROR_BOUNDS:
        fastest = equal_error(records, relmse=bound)
        parts.append(fastest.assign(bound=f"relMSE at most {bound:g}, ms"))
    area = hypervolume(records)
    if area.empty:
        return ""
    joined = pd.concat(parts, ignore_index=True)
    wide = joined.pivot_table(index=[*VIEW, "method"], columns="bound", values="milliseconds", sort=False).reset_index()
    words = "Hypervolume: area of the front in log-log below 10 s and relMSE 1, in decades of time x decades of error."
    return _table(area.merge(wide, how="left", on=[*VIEW, "method"])) + f"<p>{words}</p>"


def _configurations(records: Records) -> str:
    table = configurations(records)
    if table.empty:
        return ""
    told_apart = dict.fromkeys(name for names in charts.varied(records).values() for name in names)
    return _table(table[[*VIEW, "method", *told_apart, *MEASURED]])


def _failures(records: Records) -> str:
    table = records.table
    failed = table[table["status"] != OK].assign(configuration=[r.configuration for r in records if r.status != OK])
    return _table(failed[[*VIEW, "configuration", "seed", "status", "failure"]]) if len(failed) else ""


def _pictures(records: Records) -> str:
    rows = []
    for view, picked in charts.pictured(records, limit=8):
        if not picked:
            continue
        truth = records.truth(picked[0])[0]
        shown = [_figure(_png(metrics.tone_map(truth, truth)), f"truth, its own relMSE {picked[0].noise:.1e}", "")]
        shown += [_picture(records, record, truth) for record in picked]
        rows.append(f"<h3>{escape(charts.view_title(view))}</h3><div class='pictures'>{''.join(shown)}</div>")
    low, high = charts.ERROR_RANGE
    words = f"Pictures share the truth's exposure. Below each: the relative squared error of its pixels, black {low:g} to white {high:g}."
    return f"<p>{words}</p>{''.join(rows)}" if rows else "<p>No pictures were kept.</p>"


def _picture(records: Records, record: Record, truth: Any) -> str:
    image = records.images(record)[0]
    figures = f"{record.milliseconds:.4g} ms, relMSE {record.metrics['relmse']:.2e}, FLIP {record.metrics['flip']:.3f}"
    caption = f"{escape(charts.label(records, record.row()))}<br>{escape(figures)}"
    return _figure(_png(metrics.tone_map(image, truth)), caption, _png(_error_colours(image, truth)))


def _error_colours(image: Any, truth: Any) -> npt.NDArray[np.float64]:
    from matplotlib import colormaps

    low, high = (math.log(bound) for bound in charts.ERROR_RANGE)
    level = (np.log(np.maximum(metrics.error_map(image, truth), 1e-30)) - low) / (high - low)
    return np.asarray(colormaps["magma"](np.clip(level, 0, 1)))[..., :3]


def _figure(picture: str, caption: str, below: str) -> str:
    second = f'<img src="{below}" alt="error map">' if below else ""
    return f'<figure><img src="{picture}" alt="picture">{second}<figcaption>{caption}</figcaption></figure>'


def _machines(records: Records) -> str:
    """A table per machine that measured; usually one."""
    cards = {str(sorted(_flat(record.machine))): dict(_flat(record.machine)) for record in records}
    return "".join(_plain_table(card.items()) for card in cards.values())


def _flat(machine: Any) -> list[tuple[str, str]]:
    pairs: list[tuple[str, str]] = []
    for name, value in machine.items():
        if isinstance(value, dict):
            pairs.append((name, ", ".join(f"{key} {item}" for key, item in value.items())))
        elif name == "memory_bytes":
            pairs.append(("memory", f"{value / 2**30:.1f} GiB"))
        else:
            pairs.append((name, str(value)))
    return pairs


def _plain_table(rows: Iterable[tuple[str, str]]) -> str:
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows)
    return f'<div class="wide"><table class="card">{cells}</table></div>'


def _table(table: pd.DataFrame) -> str:
    """A table that sorts when its heads are clicked; numbers carry their full value for that."""
    head = "".join(f"<th>{escape(str(name))}</th>" for name in table.columns)
    body = "".join("<tr>" + "".join(_cell(value) for value in row) + "</tr>" for row in table.itertuples(index=False))
    return f'<div class="wide"><table class="sortable"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _cell(value: Any) -> str:
    if isinstance(value, int | float | np.number) and not isinstance(value, bool):
        number = float(value)
        text = "–" if math.isnan(number) else f"{number:.4g}"
        return f'<td class="number" data-value="{number!r}">{text}</td>'
    return f"<td>{escape('' if value is None else str(value))}</td>"


def _png_of(figure: Figure) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", facecolor=figure.get_facecolor())
    return _inline(buffer.getvalue())


def _png(image: npt.NDArray[np.float64]) -> str:
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray((np.clip(image, 0, 1) * 255 + 0.5).astype(np.uint8)).save(buffer, format="png")
    return _inline(buffer.getvalue())


def _inline(png: bytes) -> str:
    return f"data:image/png;base64,{base64.b64encode(png).decode()}"
