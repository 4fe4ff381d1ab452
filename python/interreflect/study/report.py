"""One self-contained page of a study: charts, fronts, pictures beside truth, every number, the machine. Reads records only."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

from interreflect import charts
from interreflect.study.configurations import VIEW, configurations
from interreflect.study.files import replacing
from interreflect.study.page import PAGE
from interreflect.study.page.charts import interactive
from interreflect.study.page.parts import card, drawn, section, table
from interreflect.study.page.pictures import comparison
from interreflect.study.pareto import equal_error, hypervolume, pareto
from interreflect.study.records import OK, Records

MEASURED = (
    "milliseconds", "milliseconds_p95", "precompute_milliseconds", "bytes", "relmse", "trimmed_relmse", "indirect_relmse",
    "energy_ratio", "indirect_energy_ratio", "flip", "ssim", "hue_shift", "noise", "seeds",
)  # fmt: skip
ERROR_BOUNDS = (0.1, 0.03, 0.01, 0.003)  # relMSE at which methods are compared for time
LARGEST = 10_000_000  # bytes of a page


def report(records: Records, path: str | Path, *findings: Any) -> Path:
    """Write the study's page and return its path: one HTML file of at most 10 MB with everything inside, light or dark as the system is.

    findings: results with `_repr_html_()` and maybe `.chart(dark=...)` and `.images(dark=...)`, each in a section of its own: an
    attribution, an atlas, a ladder, advice, ...
    What cannot be drawn, as every cell failed or no pictures were kept, is said on the page. ImportError without the extra `view`;
    ValueError where tables and findings alone exceed the size.
    """
    before = [section("What was measured", _summary(records)), section("Charts", _charts(records))]
    after = [
        section("On the front", _front(records)),
        section("Time to equal error", _equal_error(records)),
        section("Every configuration", _configurations(records)),
        *(_finding(finding) for finding in findings),
        section("Cells that failed", _failures(records)),
        section("The machine", _machines(records)),
    ]
    room = LARGEST - sum(len(part.encode()) for part in (*before, *after, PAGE)) - 2000
    if room < 0:
        raise ValueError(f"{path}: tables, charts and findings take {LARGEST - room} bytes, more than the {LARGEST} of a page")
    body = "".join([*before, section("Pictures beside the truth", comparison(records, room)), *after])
    target = Path(path)
    with replacing(target) as file:
        file.write(PAGE.replace("{title}", escape(records.study)).replace("{body}", body).encode())
    return target


def _summary(records: Records) -> str:
    failed = sum(record.status != OK for record in records)
    lines = [f"{len(records)} cells, {failed} of them without a measured picture."]
    if records.missing:
        lines.append(f"{records.missing} cells are not measured yet.")
    warnings = [f"Damaged and left out: {text}" for text in records.damaged]
    contended = sum(record.contended for record in records)
    if contended:
        warnings.append(f"{contended} cells were timed while other work ran on the machine.")
    warnings += dict.fromkeys(f"{record.scene}, {record.method}: {text}" for record in records for text in record.warnings)
    listed = "".join(f"<li>{escape(text)}</li>" for text in warnings)
    return "".join(f"<p>{escape(line)}</p>" for line in lines) + (f'<ul class="warnings">{listed}</ul>' if listed else "")


def _charts(records: Records) -> str:
    return "<p>No cell was measured: no charts.</p>" if configurations(records).empty else interactive(records)


def _front(records: Records) -> str:
    front = pareto(records)
    if front.empty:
        return ""
    front["configuration"] = [charts.label(records, row) for _, row in front.iterrows()]
    return table(front[[*VIEW, "configuration", "milliseconds", "relmse", "note"]])


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
    return table(area.merge(wide, how="left", on=[*VIEW, "method"])) + f'<p class="words">{words}</p>'


def _configurations(records: Records) -> str:
    rows = configurations(records)
    if rows.empty:
        return ""
    told_apart = dict.fromkeys(name for names in charts.varied(records).values() for name in names)
    words = '<p class="words">The filters of the charts apply here too.</p>'
    return words + table(rows[[*VIEW, "method", *told_apart, *MEASURED]], points=list(rows.index))


def _finding(finding: Any) -> str:
    charts_of = [(name, what) for name, what in (("chart", "chart"), ("images", "pictures")) if hasattr(finding, name)]
    figures = "".join(drawn(getattr(finding, name), what) for name, what in charts_of)
    return section(type(finding).__name__, f'{figures}<div class="wide">{finding._repr_html_()}</div>')


def _failures(records: Records) -> str:
    rows = records.table
    failed = rows[rows["status"] != OK].assign(configuration=[r.configuration for r in records if r.status != OK])
    return table(failed[[*VIEW, "configuration", "seed", "status", "failure"]]) if len(failed) else ""


def _machines(records: Records) -> str:
    """A table per machine that measured; usually one."""
    cards = {str(sorted(_flat(record.machine))): dict(_flat(record.machine)) for record in records}
    return "".join(card(machine.items()) for machine in cards.values())


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
