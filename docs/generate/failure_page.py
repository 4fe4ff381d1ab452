"""The page of all failures: what is swept, what counts as broken and why, and whose failure it is."""

from __future__ import annotations

import interreflect as ir
from docs.generate.technique_pages import cell, number, stage_link

HEAD = """# Failures

Each failure is a scene with one knob, a quantity that is measured, a truth, and a tolerance beyond which a method counts as broken. The
atlas sweeps the knob from easy to hard and reports where the error crosses the tolerance.

```python
import interreflect as ir

for failure in ir.stability.failures:
    print(f"{failure.name}: {failure.knob}, {failure.easy:g} to {failure.hard:g} {failure.unit}")
```

| Failure | Swept | From easy to hard | What is measured | Tolerance | Whose |
|---|---|---|---|---|---|
"""


def failure_page() -> str:
    rows = []
    for row in ir.stability.failures:
        unit = f" ({row.unit})" if row.unit else ""
        whose = ", ".join(stage_link(stage).replace("../", "") for stage in row.stages) or "every stage"
        cells = (row.name, row.knob + unit, f"{number(row.easy)} to {number(row.hard)}", row.quantity, f"{row.tolerance:g}: {row.reason}")
        rows.append("| " + " | ".join(cell(text) for text in cells) + f" | {whose} |")
    return HEAD + "\n".join(rows) + "\n"
