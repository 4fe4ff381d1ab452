"""Every experiment is a question, a study and a chart of its records; each runs at a small size."""

import dataclasses
import runpy
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import interreflect as ir

FOLDER = Path(__file__).parents[2] / "experiments"
EXPERIMENTS = sorted(path for path in FOLDER.glob("*.py") if path.stem not in ("__init__", "figures"))


def smaller(study):
    """The same question of one scene, with few pixels, seeds and samples, and grids that take no time."""
    less = {"grid.resolution": lambda n: 8 + n // 16, "march.cones": lambda n: 3 + n // 8, "march.samples": lambda n: 1 + n // 16}
    methods = []
    for method in study.methods:
        knobs = method.knobs()
        changed = method.replace({name: shrink(knobs[name]) for name, shrink in less.items() if name in knobs})
        if changed not in methods and knobs.get("spp", 0) <= 16:
            methods.append(changed)
    return dataclasses.replace(
        study,
        scenes=study.scenes[:1],
        methods=methods,
        size=(48, 32),
        seeds=study.seeds[:2],
        repeats=1,
        max_repeats=1,
        reference=ir.Reference(max_spp=16),
    )


@pytest.mark.parametrize("path", EXPERIMENTS, ids=lambda path: path.stem)
def test_an_experiment_is_a_question_whose_records_make_its_chart(path, tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    experiment = runpy.run_path(str(path))
    assert "?" in experiment["__doc__"].splitlines()[0]
    records = ir.run(smaller(experiment["study"]), tmp_path / "r")
    assert len(records) >= 4
    assert set(records.table["status"]) == {"ok"}
    figure = experiment["chart"](records)
    assert isinstance(figure, Figure)
    figure.canvas.draw()
    assert all(axes.get_xlabel() and axes.get_ylabel() and axes.has_data() for axes in figure.axes)
