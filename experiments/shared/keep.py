"""Where the records of the papers' experiments lie: a folder per study, so that figures and ledger share what they have in common."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import interreflect as ir
from interreflect.study.files import canonical
from interreflect.study.plan import plain

FOLDER = Path("results") / "figures"
QUALITY = ir.Reference(noise=1e-2, max_spp=128)  # of a picture that errors are read from: relMSE of .02 or so at 640 x 360
NONE = ir.Reference(noise=1e6, max_spp=2)  # of a picture that is not compared with light: all but free
SIZE = (640, 360)


class NotRecorded(LookupError):
    """A study's records are not all there."""


def folder_of(study: ir.Study, folder: Path = FOLDER) -> Path:
    return folder / "records" / re.sub(r"[^a-z0-9]+", "_", study.name.lower()).strip("_")


def recorded(study: ir.Study, folder: Path = FOLDER) -> ir.Records:
    """The study's records, as they lie there and whichever commit measured them; nothing is measured. NotRecorded where one is lacking."""
    try:
        kept = ir.load_records(folder_of(study, folder))
    except FileNotFoundError:
        raise NotRecorded(f"{study.name}: never measured here") from None
    found = {_of_record(record): record for record in kept if record.status == "ok"}
    wanted = [_of_cell(study, cell) for cell in study.cells()]
    lacking = sum(what not in found for what in wanted)
    if lacking:
        raise NotRecorded(f"{study.name}: {lacking} of {len(wanted)} cells are not measured")
    return dataclasses.replace(kept, records=tuple(found[what] for what in wanted))


def records_of(study: ir.Study, folder: Path = FOLDER) -> ir.Records:
    """The study's records; what is missing is measured now. RuntimeError names the first cell that failed."""
    records = ir.run(study, folder_of(study, folder))
    failed = [record for record in records if record.status != "ok"]
    if failed:
        raise RuntimeError(f"{study.name}: {failed[0].configuration}: {failed[0].status}, {failed[0].failure}")
    return records


def _of_cell(study: ir.Study, cell: Any) -> str:
    """What is rendered, in words that a record has too."""
    knobs = {name: plain(value) for name, value in cell.method.knobs().items()}
    camera = dataclasses.asdict(cell.scene.cameras[cell.camera])
    return canonical([cell.scene.hash, camera, cell.method.name, knobs, cell.seed, list(study.size), cell.bounces])


def _of_record(record: Any) -> str:
    what = [record.scene_hash, dict(record.camera_values), record.method, dict(record.knobs), record.seed, list(record.size)]
    return canonical([*what, record.bounces])
