"""The folder of a study: one file per cell, its pictures, the truths, and the list of cells.

    study.json         name and cells of the study that ran here last, in order
    cells/<key>.json   a record, with format version and checksum
    images/<key>.npz   image and indirect light of a cell (the archive checks itself when read)
    truths/<key>.npz   the truths of the cells
    calibrations/<key>.json   what the machines that timed them can do

Cells are keyed by everything that determines them, so a changed study finds again what it shares with an earlier one.
"""

from __future__ import annotations

import dataclasses
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from interreflect.study.calibration import Calibration
from interreflect.study.files import DamagedFile, read_checked, remove_parts, replacing, set_aside, write_checked
from interreflect.study.memory import without_collection
from interreflect.study.messages import Pair, Pictures
from interreflect.study.records import Record, Records

FORMAT = 2


class Store:
    """Where the cells of a study live."""

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)

    def begin(self, name: str, cells: list[dict[str, str]]) -> None:
        """List the study's cells, so that a killed study can be read; clear away what killed writers left."""
        self.folder.mkdir(parents=True, exist_ok=True)
        remove_parts(self.folder)
        write_checked(self.folder / "study.json", {"name": name, "cells": cells}, FORMAT)

    def read(self, key: str) -> Record | None:
        """The record of a cell; None where it is absent, or damaged: then it is set aside."""
        path = self._cell(key)
        try:
            record = Record.from_content(read_checked(path, FORMAT))
        except FileNotFoundError:
            return None
        except (ValueError, TypeError, KeyError):  # damaged, or of another format
            set_aside(path)
            return None
        if record.images and not (self._whole(self._image(key)) and self._whole(self._truth(record.truth))):
            path.unlink(missing_ok=True)
            return None
        return record

    def write_pictures(self, key: str, pictures: Pictures) -> None:
        """Keep a cell's pictures. They go before its record, which says that they are there."""
        _save_pair(self._image(key), pictures.cell)
        if pictures.truth is not None:
            _save_pair(self._truth(pictures.truth[0]), pictures.truth[1])

    def write(self, record: Record) -> None:
        """Keep a cell's record; pictures that it does not speak of go."""
        if not record.images:
            self._image(record.key).unlink(missing_ok=True)
        write_checked(self._cell(record.key), record.as_content(), FORMAT)

    def has_truth(self, key: str) -> bool:
        return self._truth(key).exists()

    def write_calibration(self, calibration: Calibration) -> None:
        path = self.folder / "calibrations" / f"{calibration.key}.json"
        if not path.exists():
            write_checked(path, dataclasses.asdict(calibration), FORMAT)

    def calibrations(self) -> dict[str, Calibration]:
        """By key; damaged ones are left out."""
        found = {}
        for path in (self.folder / "calibrations").glob("*.json"):
            with suppress(ValueError, TypeError):
                found[path.stem] = Calibration(**read_checked(path, FORMAT))
        return found

    def load(self) -> Records:
        """The records of the study that ran here last. FileNotFoundError where none did."""
        listed = self.folder / "study.json"
        if not listed.exists():
            raise FileNotFoundError(f"{self.folder}: no study (study.json is not there)")
        study = read_checked(listed, FORMAT)
        records, damaged, missing = [], [], 0
        folder = str(self.folder / "cells")
        with without_collection():  # ten thousand records are a million new objects, and none is garbage
            for cell in study["cells"]:
                try:
                    content: dict[str, Any] = read_checked(f"{folder}/{cell['key']}.json", FORMAT)
                    content |= {"scene": cell["scene"], "camera": cell["camera"]}
                    records.append(Record.from_content(content))
                except FileNotFoundError:
                    missing += 1
                except DamagedFile as error:
                    damaged.append(str(error))
        return Records(study["name"], tuple(records), self.folder, missing, tuple(damaged), self.calibrations())

    def _cell(self, key: str) -> Path:
        return self.folder / "cells" / f"{key}.json"

    def _image(self, key: str) -> Path:
        return self.folder / "images" / f"{key}.npz"

    def _truth(self, key: str) -> Path:
        return self.folder / "truths" / f"{key}.npz"

    @staticmethod
    def _whole(path: Path) -> bool:
        """Is this archive there and undamaged? A damaged one is set aside."""
        try:
            with zipfile.ZipFile(path) as archive:
                if archive.testzip() is None:
                    return True
        except FileNotFoundError:
            return False
        except (zipfile.BadZipFile, EOFError, OSError):
            pass
        set_aside(path)
        return False


def _save_pair(path: Path, pair: Pair) -> None:
    with replacing(path) as file:
        np.savez(file, allow_pickle=False, image=pair[0], indirect=pair[1])


def load_records(folder: str | Path) -> Records:
    """The records in a study's folder, without rendering. FileNotFoundError where no study ran."""
    return Store(folder).load()
