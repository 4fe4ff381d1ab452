"""Contenders in motion: each plays the same frames on a machine of its own, and every frame is compared with its own truth."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import orjson
import pandas as pd

import interreflect as ir
from interreflect import metrics
from interreflect.stability.temporal import compare
from interreflect.study.contention import Watch
from interreflect.study.files import replacing
from interreflect.study.locks import machine
from interreflect.study.sources import source_digest
from interreflect.study.uncertainty import mean_interval, median_interval

SEED = 0


def in_motion(
    ways: Mapping[str, Any],
    scene: ir.Scene,
    motion: ir.Motion,
    size: tuple[int, int],
    bounces: int | None,
    truth: ir.Reference,
    folder: Path,
) -> pd.DataFrame:
    """A row per way: median milliseconds of the frames after the first, their mean relMSE and FLIP, and their temporal error, each with
    its 95 % interval over the frames; pops a thousand surface points; what failed, in words. What `folder` holds is not played again."""
    rows = {}
    for name, method in ways.items():
        identity = repr((source_digest(type(method)), repr(method), scene.hash, motion, size, bounces, truth))
        path = folder / f"{hashlib.blake2b(identity.encode(), digest_size=12).hexdigest()}.json"
        if not path.exists():
            kept = {"setting": name, "method": method.name, **_played(method, scene, motion, size, bounces, truth)}
            with replacing(path) as file:
                file.write(orjson.dumps(kept, option=orjson.OPT_SERIALIZE_NUMPY | orjson.OPT_INDENT_2))
        rows[name] = orjson.loads(path.read_bytes())
    return summary(rows)


def _played(
    method: Any, scene: ir.Scene, motion: ir.Motion, size: tuple[int, int], bounces: int | None, truth: ir.Reference
) -> dict[str, Any]:
    """Numbers of every frame after the first, which has no history; or how it failed."""
    try:
        with machine(alone=True):
            prepared = method.prepare(scene)
            watch = Watch()
            frames = list(prepared.play(motion, size, SEED))
            contention = watch.contention()
        played = compare(frames, method, scene, motion, size, truth, bounces=bounces)
    except (ValueError, RuntimeError, MemoryError, ImportError) as error:
        return {"failure": f"{type(error).__name__}: {error}"}
    later = list(zip(played.images, played.truths, strict=True))[1:]
    table = played.table.iloc[1:]
    return {
        "failure": "",
        "milliseconds": list(played.milliseconds[1:]),
        "relmse": (table["relmse"] - table["noise"]).tolist(),
        "flip": [metrics.flip(image, target) for image, target in later],
        "temporal": table["temporal_mean"].tolist(),
        "pops": 1e3 * played.pops / max(played.points, 1),
        "truth_noise": float(np.mean(played.noises[1:])),
        "truth_temporal": played.truth_jumps.mean,
        "contended": contention.contended,
    }


def summary(rows: Mapping[str, Mapping[str, Any]]) -> pd.DataFrame:
    """The kept numbers as a table: a mean, or the median of times, with its interval."""
    found = []
    for name, kept in rows.items():
        row: dict[str, Any] = {"setting": name, "method": kept["method"], "failure": kept["failure"]}
        if not kept["failure"]:
            row |= {key: kept[key] for key in ("pops", "truth_noise", "truth_temporal", "contended")}
            row["milliseconds"] = float(np.median(kept["milliseconds"]))
            row["milliseconds_low"], row["milliseconds_high"] = median_interval(kept["milliseconds"])
            for error in ("relmse", "flip", "temporal"):
                row[error] = float(np.mean(kept[error]))
                row[f"{error}_low"], row[f"{error}_high"] = mean_interval(kept[error])
        found.append(row)
    return pd.DataFrame(found)
