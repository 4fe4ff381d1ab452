"""Run a study: measure every cell that its folder does not hold yet."""

from __future__ import annotations

import functools
import time
from pathlib import Path
from typing import Any

from interreflect.scenes.checks import number
from interreflect.study.dask import check_client, measure_on
from interreflect.study.messages import Phase, Pictures
from interreflect.study.plan import Plan
from interreflect.study.records import Records
from interreflect.study.store import load_records
from interreflect.study.study import Study
from interreflect.study.workers import GO, Crew, Limits

PATIENCE = 0.2  # seconds before cells that another run has claimed are looked at again


def run(study: Study, folder: str | Path, timeout: float | None = None, memory: float | None = None, client: Any = None) -> Records:
    """Measure a study into a folder, one file per cell, and return its records.

    What the folder holds already is not measured again: a study that was interrupted or killed resumes, and runs on one folder
    share the work. Cells are measured in a worker process, one after the other; with a `distributed.Client` on the hosts of its
    cluster, timed ones alone on a host, untimed ones (`repeats=0`) side by side. A method that raises, crashes, takes longer than
    `timeout` seconds (its truth apart) or more than `memory` bytes, and a picture with numbers that are not finite, are rows of
    the table that say so; a cell that failed for a limit is tried again under a wider one.

    ValueError for limits that are not above 0, TypeError for a client that is none; OSError for a folder that cannot be written or
    a full disk; RuntimeError where no worker process starts.
    """
    if client is not None:
        check_client(client)
    with Plan(study, Path(folder), _limits(timeout, memory)) as plan:
        _measure_here(plan) if client is None else measure_on(client, plan)
    return load_records(folder)


def _limits(timeout: float | None, memory: float | None) -> Limits:
    given = {"timeout": timeout, "memory": memory}
    return Limits(**{name: None if value is None else number(name, value, 0, open_low=True) for name, value in given.items()})


def _measure_here(plan: Plan) -> None:
    with Crew() as crew, plan.progress() as progress:
        for index in plan.open_cells():
            progress.update(plan.settled - progress.n)
            if index is None:
                progress.set_postfix_str("waiting for cells of another run")
                time.sleep(PATIENCE)
                continue
            follow = functools.partial(_follow, plan, progress, index)
            plan.keep(index, crew.measure(plan.request(index), plan.scene_of(index), plan.limits, follow))
        progress.update(plan.settled - progress.n)


def _follow(plan: Plan, progress: Any, index: int, message: Phase | Pictures) -> None:
    if isinstance(message, Pictures):
        plan.keep_pictures(index, message)
    elif message.name == GO:
        plan.writer.settle()
    else:
        progress.set_postfix_str(", ".join(filter(None, (plan.title(index), message.name, message.detail))))
