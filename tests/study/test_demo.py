"""What `./run demo` prints can be read where it is printed."""

from __future__ import annotations

import io
from pathlib import Path

from rich.console import Console

from interreflect import demo
from interreflect.study.records import METRICS, Record, Records


def test_the_demos_tables_fit_a_terminal_of_80_columns():
    records = []
    for k, method in enumerate(demo.methods()):
        for scene in ("cornell_box", "atrium"):
            metrics = dict.fromkeys(METRICS, 0.00123456) | {"energy_ratio": 12.345 * k}
            knobs = {name: value if isinstance(value, int | float | str) else repr(value) for name, value in method.knobs().items()}
            records.append(
                Record(
                    key=f"{scene}{k}",
                    scene=scene,
                    scene_hash=scene,
                    camera="front",
                    camera_values={},
                    method=method.name,
                    knobs=knobs,
                    seed=0,
                    size=(320, 180),
                    bounces=1,
                    threads=2,
                    machine={},
                    milliseconds=12345.6789 / 3**k,
                    metrics=metrics,
                )
            )
    out = io.StringIO()
    for table in demo.tables(Records("demo", tuple(records), Path("."))):
        Console(file=out, width=80).print(table)
    text = out.getvalue()
    print(text)
    assert max(map(len, text.splitlines())) <= 80
    assert "…" not in text and text.count("0.00123") == 2 * len(records)
    for method in demo.methods():
        assert sum(line.startswith(method.name + " ") for line in text.splitlines()) == 2 * sum(
            other.name == method.name for other in demo.methods()
        )
    for setting in ("resolution 32", "EveryPixel", "spp 16"):
        assert setting in text
