"""Checks of what users hand to scene values: every refusal is a ValueError that names the argument and the value."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.mapped import MappedFile

Vector = tuple[float, float, float]

MAX_INDICES = 2**32  # the core numbers corners with 32 bits
FLOAT_MAX = float(np.finfo(np.float32).max)


def nearest_name(name: str, known: Iterable[str]) -> str:
    """'; did you mean X?' for the known name that resembles `name` most, or the list of the known ones."""
    names = list(known)
    near = difflib.get_close_matches(name[:100], names, n=1, cutoff=0.5)
    if near:
        return f"; did you mean {near[0]!r}?"
    return f"; known: {', '.join(names[:12])}" + (", ..." if len(names) > 12 else "")


def shorten(value: object, limit: int = 80) -> str:
    """repr of a refused value, cut so that a message stays readable."""
    long = isinstance(value, (list, tuple, str)) and len(value) > 1000
    text = f"{type(value).__name__} of {len(value)}" if long else repr(value)  # type: ignore[arg-type]
    return text if len(text) <= limit else text[: limit - 3] + "..."


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, (bool, np.bool_))


def number(argument: str, value: Any, low: float = -FLOAT_MAX, high: float = FLOAT_MAX, *, open_low: bool = False) -> float:
    """A finite number in [low, high], or (low, high] where `open_low`."""
    if _is_number(value) and (low < value if open_low else low <= value) and value <= high:
        return float(value)
    if low == -FLOAT_MAX and high == FLOAT_MAX:
        wanted = "be a finite number"
    elif high == FLOAT_MAX:
        wanted = f"be a finite number {'above' if open_low else 'of at least'} {low:g}"
    else:
        wanted = f"lie in {'(' if open_low else '['}{low:g}, {high:g}]"
    raise ValueError(f"{argument} must {wanted}, got {shorten(value)}")


def vector(argument: str, value: Any, low: float = -FLOAT_MAX, high: float = FLOAT_MAX) -> Vector:
    """Three finite numbers, each in [low, high]."""
    items = value.tolist() if isinstance(value, np.ndarray) and value.size <= 16 else value
    if not isinstance(items, Sequence) or isinstance(items, str) or len(items) != 3 or not all(map(_is_number, items)):
        raise ValueError(f"{argument} must be three finite numbers, got {shorten(value)}")
    if not all(-FLOAT_MAX <= x <= FLOAT_MAX for x in items):
        raise ValueError(f"{argument} must be three finite numbers, got {shorten(list(items))}")
    if not all(low <= x <= high for x in items):
        bound = f"of at least {low:g}" if high == FLOAT_MAX else f"in [{low:g}, {high:g}]"
        raise ValueError(f"{argument} must be three numbers {bound}, got {shorten(list(items))}")
    return float(items[0]), float(items[1]), float(items[2])


def direction(argument: str, value: Any) -> Vector:
    """Three finite numbers that are not all zero, as a unit vector."""
    x, y, z = vector(argument, value)
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0:
        raise ValueError(f"{argument} must not have zero length, got {shorten(value)}")
    x, y, z = x / largest, y / largest, z / largest
    length = math.sqrt(x * x + y * y + z * z)
    if length == 1:
        return x, y, z
    return x / length, y / length, z / length


def boolean(argument: str, value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise ValueError(f"{argument} must be true or false, got {shorten(value)}")


def text(argument: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    raise ValueError(f"{argument} must be a string, got {shorten(value)}")


def choice(argument: str, value: Any, choices: Sequence[str]) -> str:
    if isinstance(value, str) and value in choices:
        return value
    raise ValueError(f"{argument} must be one of {', '.join(map(repr, choices))}, got {shorten(value)}")


def raw_array(argument: str, value: ArrayLike, columns: int) -> NDArray[Any]:
    """`value` as a numpy array of shape (n, columns) and any dtype, without a copy where it is one already."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError) as error:
        raise ValueError(f"{argument} must be an array of shape (n, {columns}): {error}") from None
    if array.size == 0 and array.ndim == 1:
        array = array.reshape(0, columns)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{argument} must have shape (n, {columns}), got {array.shape}")
    if array.size > MAX_INDICES:
        raise ValueError(f"{argument} must have at most 2^32 numbers, got {array.size}")
    return array


def _is_locked(array: NDArray[Any]) -> bool:
    """Whether nobody can write to the memory of `array`."""
    base: Any = array
    while isinstance(base, (np.ndarray, memoryview)):
        if isinstance(base, np.ndarray) and base.flags.writeable:
            return False
        base = base.base if isinstance(base, np.ndarray) else base.obj
    return base is None or isinstance(base, (bytes, MappedFile))


def locked(array: NDArray[Any], dtype: type[np.generic]) -> NDArray[Any]:
    """`array` as a read-only C-contiguous array of `dtype`; a copy unless it is exactly that and nobody else can write to it."""
    if array.dtype == dtype and array.flags.c_contiguous and _is_locked(array):
        return array
    with np.errstate(over="ignore"):  # what does not fit becomes infinite, and infinite is refused
        copy = np.array(array, dtype=dtype, order="C", copy=True)
    copy.flags.writeable = False
    return copy


def finite_rows(argument: str, value: ArrayLike, columns: int) -> NDArray[np.float32]:
    """(n, columns) float32, read-only, every number finite."""
    given = raw_array(argument, value, columns)
    if given.dtype.kind not in "fiu":
        raise ValueError(f"{argument} must hold real numbers, got dtype {given.dtype}")
    array: NDArray[np.float32] = locked(given, np.float32)
    finite = np.isfinite(array)
    if not finite.all():
        row, column = np.argwhere(~finite)[0]
        raise ValueError(f"{argument}[{row}, {column}] must be finite in float32, got {given[row, column]}")
    return array


def index_rows(argument: str, value: ArrayLike, bound: int) -> NDArray[np.uint32]:
    """(n, 3) uint32, read-only, every index below `bound`."""
    given = raw_array(argument, value, 3)
    if given.size == 0:
        given = given.astype(np.uint32)
    if given.dtype.kind not in "iu":
        raise ValueError(f"{argument} must hold integers, got dtype {given.dtype}")
    if given.size and (given.min() < 0 or given.max() >= bound):
        row, column = np.argwhere((given < 0) | (given >= bound))[0]
        raise ValueError(f"{argument}[{row}, {column}] must lie in [0, {bound}), got {given[row, column]}")
    array: NDArray[np.uint32] = locked(given, np.uint32)
    return array


def matrix(argument: str, value: ArrayLike) -> NDArray[np.float64]:
    """(4, 4) float64, read-only, finite, bottom row 0 0 0 1, invertible."""
    given = raw_array(argument, value, 4)
    if given.shape != (4, 4) or given.dtype.kind not in "fiu":
        raise ValueError(f"{argument} must be a (4, 4) matrix of real numbers, got shape {given.shape}, dtype {given.dtype}")
    array: NDArray[np.float64] = locked(given, np.float64)
    if not (np.abs(array) <= FLOAT_MAX).all():
        raise ValueError(f"{argument} must be finite, got {shorten(array.tolist())}")
    if not np.array_equal(array[3], (0, 0, 0, 1)):
        raise ValueError(f"{argument} must end in the row 0, 0, 0, 1, got {array[3].tolist()}")
    axes = array[:3, :3] / max(float(np.abs(array[:3, :3]).max()), 1e-300)
    if abs(float(np.linalg.det(axes))) < 1e-12:
        raise ValueError(f"{argument} must be invertible, got {shorten(array.tolist())}")
    return array


def rigid_matrix(argument: str, value: ArrayLike) -> NDArray[np.float64]:
    """(4, 4) float64 of a rotation and a translation."""
    array = matrix(argument, value)
    axes = array[:3, :3]
    # 1e-5: matrices that were composed in float32
    if float(np.abs(axes @ axes.T - np.eye(3)).max()) > 1e-5 or float(np.linalg.det(axes)) < 0:
        raise ValueError(f"{argument} must be rigid (a rotation and a translation), got {shorten(array.tolist())}")
    return array


def whole(argument: str, value: Any, low: int, high: int) -> int:
    """A whole number in [low, high]."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and low <= value <= high:
        return int(value)
    raise ValueError(f"{argument} must be a whole number in [{low}, {high}], got {shorten(value)}")
