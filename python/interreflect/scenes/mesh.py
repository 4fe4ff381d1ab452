"""Triangles with one material, on one body."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.checks import MAX_INDICES, finite_rows, index_rows, matrix, raw_array, text
from interreflect.scenes.content import Content
from interreflect.scenes.digest import digest
from interreflect.scenes.material import Material

IDENTITY: NDArray[np.float64] = np.eye(4)
IDENTITY.flags.writeable = False


@dataclass(frozen=True, eq=False)
class Mesh(Content):
    """Triangles in a body's space. Copies made by `replace` share the arrays, so that a scene stores them once.

    positions: (n, 3), scene units. triangles: (m, 3) integers below n, counter-clockwise seen from the front.
    normals: (n, 3) of shading, made unit length, or None: flat. texcoords: (n, 2) or None.
    body: meshes of one body move together; "world" never moves. transform: (4, 4) from the mesh to its body, column vectors;
    where it mirrors, fronts stay in front.

    Arrays are kept read-only as float32 and uint32, copied where they are not that already. Raises ValueError that names the
    argument: wrong shape or dtype, non-finite numbers, an index out of range, a normal without length, a singular transform.
    """

    positions: NDArray[np.float32] = field(repr=False)
    triangles: NDArray[np.uint32] = field(repr=False)
    normals: NDArray[np.float32] | None = field(default=None, kw_only=True, repr=False)
    texcoords: NDArray[np.float32] | None = field(default=None, kw_only=True, repr=False)
    material: Material = field(default=Material(), kw_only=True)
    body: str = field(default="world", kw_only=True)
    name: str = field(default="", kw_only=True)
    transform: NDArray[np.float64] = field(default_factory=lambda: IDENTITY, kw_only=True, repr=False)

    def __post_init__(self) -> None:
        raw_array("triangles", self.triangles, 3)  # its size, before anything is copied
        positions = finite_rows("positions", self.positions, 3)
        self._set("positions", positions)
        self._set("triangles", index_rows("triangles", self.triangles, min(len(positions), MAX_INDICES)))
        if self.normals is not None:
            self._set("normals", _unit_normals(_per_vertex("normals", self.normals, 3, len(positions))))
        if self.texcoords is not None:
            self._set("texcoords", _per_vertex("texcoords", self.texcoords, 2, len(positions)))
        self._check_placement()

    def _check_placement(self) -> None:
        if not isinstance(self.material, Material):
            raise ValueError(f"material must be a Material, got {type(self.material).__name__}")
        if not text("body", self.body):
            raise ValueError("body must not be empty")
        text("name", self.name)
        if self.transform is not IDENTITY:
            self._set("transform", matrix("transform", self.transform))

    def _set(self, key: str, value: Any) -> None:
        object.__setattr__(self, key, value)

    def replace(
        self,
        *,
        material: Material | None = None,
        body: str | None = None,
        name: str | None = None,
        transform: ArrayLike | None = None,
    ) -> Mesh:
        """The same triangles elsewhere, on another body or of another material; the arrays are shared."""
        other = object.__new__(Mesh)
        shared = {field.name for field in fields(self)} | {"shape_hash", "_used"}
        other.__dict__.update({key: value for key, value in self.__dict__.items() if key in shared})
        for key, value in (("material", material), ("body", body), ("name", name), ("transform", transform)):
            if value is not None:
                other._set(key, value)
        other._check_placement()
        return other

    @cached_property
    def shape_hash(self) -> str:
        """Digest of the arrays alone: meshes with the same one are instances of each other."""
        return digest("shape", self.positions, self.triangles, self.normals, self.texcoords)

    def _digest(self) -> str:
        return digest("mesh", self.shape_hash, self.material.hash, self.body, self.transform)

    @cached_property
    def _used(self) -> NDArray[np.float32]:
        """Positions that triangles refer to."""
        used = np.zeros(len(self.positions), bool)
        used[self.triangles.ravel()] = True
        return self.positions if used.all() else self.positions[used]

    def bounds(self, placed: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """(2, 3) smallest and largest corner with the triangles placed by a (4, 4) matrix; None without triangles."""
        if len(self.triangles) == 0:
            return None
        points = self._used
        if np.array_equal(placed, IDENTITY):
            return np.stack([points.min(0), points.max(0)]).astype(np.float64)
        moved = points @ placed[:3, :3].T + placed[:3, 3]
        return np.stack([moved.min(0), moved.max(0)])


def _per_vertex(argument: str, value: ArrayLike, columns: int, count: int) -> NDArray[np.float32]:
    array = finite_rows(argument, value, columns)
    if len(array) != count:
        raise ValueError(f"{argument} must have one row for each of the {count} positions, got {len(array)}")
    return array


def _unit_normals(normals: NDArray[np.float32]) -> NDArray[np.float32]:
    squares = np.einsum("ij,ij->i", normals, normals)
    if bool((np.abs(squares - 1) < 1e-4).all()):
        return normals
    length = np.linalg.norm(normals.astype(np.float64), axis=1, keepdims=True)
    if not length.all():
        raise ValueError(f"normals[{int(np.argmin(length))}] must not have zero length")
    unit: NDArray[np.float32] = (normals / length).astype(np.float32)
    unit.flags.writeable = False
    return unit
