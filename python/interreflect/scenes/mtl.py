"""Materials of an .obj: the statements that SCENE_FORMAT.md names; the rest is ignored.

trimesh (5.2, measured) keeps 8 bits of a colour, reads a trailing comment as part of one, leaves Ke and map_d as text, and drops texture
paths and names it does not know without a word.
"""

from __future__ import annotations

import math
from typing import Any

from interreflect.errors import SceneError
from interreflect.scenes.checks import shorten
from interreflect.scenes.files import Folder, read_bytes, shown

MAX_MTL_BYTES = 2**23
_COLOURS = {"Kd": "albedo", "Ks": "specular", "Ke": "emission"}
_MAPS = {"map_Kd": "albedo_map", "map_d": "mask"}
# Options that may stand before a map's file name, and how many words follow each
_OPTIONS = {"-blendu": 1, "-blendv": 1, "-boost": 1, "-bm": 1, "-cc": 1, "-clamp": 1, "-imfchan": 1, "-mm": 2, "-texres": 1, "-type": 1}
_PLACING = ("-o", "-s", "-t")


def read_mtl(path: str, folder: Folder, warnings: list[str]) -> dict[str, dict[str, Any]]:
    """Material name -> keys of SCENE_FORMAT.md; maps are paths of files that exist."""
    file = shown(path)
    text = read_bytes(path, MAX_MTL_BYTES).decode("utf-8", "replace")
    materials: dict[str, dict[str, Any]] = {}
    current: dict[str, Any] | None = None
    for number, line in enumerate(text.splitlines(), 1):
        words = _without_comment(line).split()
        if not words:
            continue
        where = f"{file}:{number}: {words[0]}"
        if words[0] == "newmtl":
            current = materials.setdefault(" ".join(words[1:]), {})
        elif current is None:
            continue
        elif words[0] in _COLOURS:
            current[_COLOURS[words[0]]] = _colour(where, words[1:])
        elif words[0] == "Ns":
            current.update(_gloss(where, words[1:]))
        elif words[0] in _MAPS:
            current[_MAPS[words[0]]] = where, words[1:]  # looked up once all is read: the last one counts
    for keys in materials.values():
        for key in _MAPS.values():
            if key in keys:
                _locate_map(keys, key, path, folder, warnings)
    return materials


def _locate_map(keys: dict[str, Any], key: str, path: str, folder: Folder, warnings: list[str]) -> None:
    where, words = keys.pop(key)
    name = _file_name(where, words, warnings)
    found = folder.locate(name, where, path)
    if found is None:
        warnings.append(f"{where} {shorten(name)} does not exist; loaded as without it")
    else:
        keys[key] = found


def _without_comment(line: str) -> str:
    if line.lstrip().startswith("#"):
        return ""
    return line.split(" #")[0].split("\t#")[0]


def _numbers(where: str, words: list[str]) -> list[float]:
    try:
        values = [float(word) for word in words]
    except ValueError:
        raise SceneError(f"{where} must be numbers, got {shorten(' '.join(words))}") from None
    if not all(map(math.isfinite, values)):
        raise SceneError(f"{where} must be finite, got {shorten(' '.join(words))}")
    return values


def _colour(where: str, words: list[str]) -> list[float]:
    values = _numbers(where, words[:3])
    if len(values) == 1:
        values *= 3
    if len(values) != 3 or min(values) < 0:
        raise SceneError(f"{where} must be three numbers of at least 0, got {shorten(' '.join(words))}")
    return values


def _gloss(where: str, words: list[str]) -> dict[str, Any]:
    values = _numbers(where, words[:1])
    if not values or values[0] < 0:
        raise SceneError(f"{where} must be a number of at least 0, got {shorten(' '.join(words))}")
    if values[0] == 0:
        return {"roughness": 1.0, "exponent": None}  # alpha = sqrt(2 / (0 + 2))
    return {"exponent": values[0], "roughness": None}


def _file_name(where: str, words: list[str], warnings: list[str]) -> str:
    """The words after the options."""
    k = 0
    while k < len(words) and (words[k] in _OPTIONS or words[k] in _PLACING):
        if words[k] in _OPTIONS:
            k += 1 + _OPTIONS[words[k]]
            continue
        warnings.append(f"{where}: {words[k]} is ignored")
        k += 1
        while k < len(words) - 1 and _is_number(words[k]):
            k += 1
    return " ".join(words[k:]).replace("\\", "/")


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
