"""One number out of a table of records."""

from __future__ import annotations

from typing import Any

import pandas as pd

import interreflect as ir


def rows(records: ir.Records, **knobs: Any) -> pd.DataFrame:
    """The rows with these values; `grid__resolution=64` means the column grid.resolution. KeyError where there are none."""
    table = records.table
    for name, value in knobs.items():
        table = table[table[name.replace("__", ".")] == value]
    if table.empty:
        raise KeyError(f"{records.study}: no record with {knobs}")
    return table


def value(records: ir.Records, column: str, **knobs: Any) -> float:
    """The median of a column over the rows with these values."""
    return float(rows(records, **knobs)[column].median())


def number(records: ir.Records, **knobs: Any) -> int:
    """Place of the first record with these values among the records."""
    return int(rows(records, **knobs).index[0])


def image(records: ir.Records, **knobs: Any) -> Any:
    """(image, indirect) of the first record with these values."""
    return records.images(records[number(records, **knobs)])
