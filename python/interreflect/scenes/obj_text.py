"""Numbers out of the text of an .obj, a kind of line at a time, vectorised: bounded time and memory for any bytes."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.checks import shorten

Integers = NDArray[np.int64]

_SPACE, _NEWLINE, _SLASH = ord(" "), ord("\n"), ord("/")


def normalised(data: bytes) -> bytes:
    """Lines that end in a newline and begin with their keyword; no comments, no continuations."""
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if b"\\\n" in data:
        data = data.replace(b"\\\n", b"  ")
    if b"#" in data:
        data = _without_comments(data)
    if b"\t" in data:
        data = data.replace(b"\t", b" ")
    if data.startswith(b" ") or b"\n " in data:
        data = re.sub(rb"(?m)^ +", b"", data)
    return data + b"\n"


def _without_comments(data: bytes) -> bytes:
    """`data` without what stands between a # at the beginning of a word and the end of its line."""
    pieces, begin, at = [], 0, data.find(b"#")
    while at >= 0:
        if at and data[at - 1] not in b" \t\n":
            at = data.find(b"#", at + 1)
            continue
        pieces.append(data[begin:at])
        begin = data.find(b"\n", at)
        if begin < 0:
            return b"".join(pieces)
        at = data.find(b"#", begin)
    return b"".join([*pieces, data[begin:]])


@dataclass
class Lines:
    """A text and where its lines begin and end (the newline excluded). letters: the text and some newlines more."""

    file: str
    data: bytes
    letters: NDArray[np.uint8]
    starts: Integers
    ends: Integers

    @staticmethod
    def of(file: str, data: bytes) -> Lines:
        letters = np.frombuffer(data + b"\n\n\n\n", np.uint8)
        ends = np.flatnonzero(letters[: len(data)] == _NEWLINE)
        return Lines(file, data, letters, np.concatenate([[0], ends[:-1] + 1]), ends)

    def beginning_with(self, keyword: bytes) -> Integers:
        """Numbers of the lines whose first word is `keyword`, of at most three letters."""
        matches = np.ones(len(self.starts), bool)
        for k, letter in enumerate(keyword):
            matches &= self.letters[self.starts + k] == letter
        after = self.letters[self.starts + len(keyword)]
        return np.flatnonzero(matches & ((after == _SPACE) | (after == _NEWLINE)))

    def words(self, line: int) -> bytes:
        return self.data[self.starts[line] : self.ends[line]]

    def payload(self, lines: Integers, skip: int) -> bytes:
        """The text of `lines`, their first `skip` letters blank, each ended by a newline."""
        if not len(lines):
            return b""
        view = memoryview(self.data)
        breaks = np.flatnonzero(np.diff(lines) != 1)
        firsts, lasts = lines[np.append(0, breaks + 1)], lines[np.append(breaks, -1)]
        runs = zip(self.starts[firsts].tolist(), (self.ends[lasts] + 1).tolist(), strict=True)
        text = bytearray().join([view[start:end] for start, end in runs])
        lengths = self.ends[lines] + 1 - self.starts[lines]
        letters, begins = np.frombuffer(text, np.uint8), np.cumsum(lengths) - lengths
        for k in range(skip):
            letters[begins + k] = _SPACE
        return bytes(text)

    def error(self, line: int, message: str) -> SceneError:
        text = self.data[self.starts[line] : min(self.ends[line], self.starts[line] + 100)].decode("utf-8", "replace")
        return SceneError(f"{self.file}:{int(line) + 1}: {message}, got {shorten(text)}")


def word_begins(solid: NDArray[np.bool_]) -> Integers:
    """Where a letter is solid and the one before is not."""
    begins = solid.copy()
    begins[1:] &= ~solid[:-1]
    return np.flatnonzero(begins)


@dataclass
class Words:
    """Where the words of a payload begin, and how many each line has."""

    text: NDArray[np.uint8]
    starts: Integers
    per_line: Integers

    @staticmethod
    def of(payload: bytes) -> Words:
        text = np.frombuffer(payload, np.uint8)
        starts = word_begins(text > _SPACE)
        line_ends = np.flatnonzero(text == _NEWLINE)
        return Words(text, starts, np.diff(np.searchsorted(starts, line_ends), prepend=0))


def parsed(payload: bytes, dtype: type[np.generic], count: int) -> NDArray[Any] | None:
    """The `count` numbers, separated by white space, that are all the text holds; None where it holds anything else."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # numpy below 2.3 warns of unmatched text instead of raising
        try:
            values = np.fromstring(payload, dtype=dtype, sep=" ")
        except (ValueError, DeprecationWarning):
            return None
    return values if len(values) == count else None


def number_table(lines: Lines, keyword: bytes, columns: int, least: int) -> NDArray[np.float64]:
    """(n, columns) numbers of the lines of `keyword`: at least `least` a line, missing ones 0, further ones ignored."""
    chosen = lines.beginning_with(keyword)
    if not len(chosen):
        return np.zeros((0, columns))
    payload = lines.payload(chosen, len(keyword))
    words = Words.of(payload)
    if words.per_line.min() < least:
        raise lines.error(chosen[np.argmax(words.per_line < least)], f"{keyword.decode()} must have {least} numbers")
    values = parsed(payload, np.float64, len(words.starts))
    if values is None:
        raise _first_bad(lines, chosen, len(keyword), keyword.decode())
    if (words.per_line == words.per_line[0]).all():
        table = values.reshape(len(chosen), -1)[:, :columns]
    else:
        offsets = np.cumsum(words.per_line) - words.per_line
        inside = np.arange(columns) < words.per_line[:, None]
        table = np.where(inside, values[np.where(inside, offsets[:, None] + np.arange(columns), 0)], 0.0)
    if table.shape[1] < columns:
        table = np.pad(table, ((0, 0), (0, columns - table.shape[1])))
    with np.errstate(over="ignore"):
        finite = np.isfinite(table.astype(np.float32)).all(1)
    if not finite.all():
        raise lines.error(chosen[np.argmin(finite)], f"{keyword.decode()} must be finite in 32 bits")
    return table


def _first_bad(lines: Lines, chosen: Integers, skip: int, what: str) -> SceneError:
    for line in chosen:
        text = lines.words(line)[skip:]
        if parsed(text, np.float64, len(text.split())) is None:
            return lines.error(line, f"{what} must be numbers")
    return SceneError(f"{lines.file}: {what} must be numbers")


@dataclass
class Corners:
    """Corners of faces: raw (n, 3) indices of position, texcoord and normal as written, and which of them are given."""

    raw: Integers
    given: NDArray[np.bool_]
    per_face: Integers
    lines: Integers


def face_corners(lines: Lines) -> Corners:
    """All corners of all faces."""
    chosen = lines.beginning_with(b"f")
    payload = lines.payload(chosen, 1)
    words = Words.of(payload)
    if len(chosen) and words.per_line.min() < 3:
        raise lines.error(chosen[np.argmax(words.per_line < 3)], "a face must have at least three corners")
    slash = words.text == _SLASH
    slashes_before = np.cumsum(slash, dtype=np.int32) - slash
    per_corner = np.diff(slashes_before[words.starts], append=np.int32(slash.sum()))
    owner = np.repeat(chosen, words.per_line)
    if len(per_corner) and per_corner.max() > 2:
        raise lines.error(owner[np.argmax(per_corner > 2)], "a corner must have at most three indices")
    begins = word_begins((words.text > _SPACE) & ~slash)
    values = parsed(payload.replace(b"/", b" "), np.int64, len(begins))
    if values is None:
        raise _first_bad_face(lines, chosen)
    raw, given = np.zeros((len(words.starts), 3), np.int64), np.zeros((len(words.starts), 3), bool)
    columns = int(per_corner[0]) + 1 if len(per_corner) else 1
    if (per_corner == columns - 1).all() and len(begins) == columns * len(words.starts):
        raw[:, :columns], given[:, :columns] = values.reshape(-1, columns), True
    else:
        corner = np.searchsorted(words.starts, begins, "right") - 1
        column = slashes_before[begins] - slashes_before[words.starts][corner]
        raw[corner, column], given[corner, column] = values, True
    if not given[:, 0].all():
        raise lines.error(owner[np.argmin(given[:, 0])], "a corner must have a position")
    return Corners(raw, given, words.per_line, owner)


def _first_bad_face(lines: Lines, chosen: Integers) -> SceneError:
    for line in chosen:
        text = lines.words(line)[1:].replace(b"/", b" ")
        if parsed(text, np.int64, len(text.split())) is None:
            return lines.error(line, "a corner must be whole numbers")
    return SceneError(f"{lines.file}: corners must be whole numbers")
