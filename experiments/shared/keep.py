"""Where the records of the papers' experiments lie: a folder per study, so that figures and ledger share what they have in common."""

from __future__ import annotations

import re
from pathlib import Path

import interreflect as ir

FOLDER = Path("results") / "figures"
QUALITY = ir.Reference(noise=1e-2, max_spp=128)  # of a picture that errors are read from: relMSE of .02 or so at 640 x 360
NONE = ir.Reference(noise=1e6, max_spp=2)  # of a picture that is not compared with light: all but free
SIZE = (640, 360)


def records_of(study: ir.Study, folder: Path = FOLDER) -> ir.Records:
    """The study's records; what is missing is measured now. RuntimeError names the first cell that failed."""
    records = ir.run(study, folder / "records" / re.sub(r"[^a-z0-9]+", "_", study.name.lower()).strip("_"))
    failed = [record for record in records if record.status != "ok"]
    if failed:
        raise RuntimeError(f"{study.name}: {failed[0].configuration}: {failed[0].status}, {failed[0].failure}")
    return records
