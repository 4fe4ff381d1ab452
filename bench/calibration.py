"""What this machine can do: bandwidths, arithmetic, rays. Every limit divides by these."""

from __future__ import annotations

import dataclasses
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from bench.timing import least
from interreflect import _core

if TYPE_CHECKING:
    from bench.sponza import Sponza

WIDTHS = {"single": 1, "8-wide": 8, "16-wide": 16, "stream of 256": 256}
Rays = tuple[NDArray[np.float32], NDArray[np.float32]]


@dataclasses.dataclass(frozen=True)
class Calibration:
    """rays: kind of ray -> call -> million rays a second, empty without the scene they are measured on."""

    read: float  # GB/s
    triad: float  # GB/s, three arrays
    multiply_add: float  # GFLOP/s, single precision
    cone_steps: float  # million a second of a plain march: two trilinear look-ups of half floats each
    vector_bytes: int
    threads: int
    load: float  # processes that wanted a core in the minute before
    rays: dict[str, dict[str, float]] = dataclasses.field(default_factory=dict)

    def best(self, kind: str) -> float:
        """Million rays a second of a kind, by the fastest call."""
        return max(self.rays[kind].values())

    def asdict(self) -> dict[str, Any]:
        return dataclasses.asdict(self)


# The machine that the table of targets was written for: two cores of an AMD EPYC with AVX-512 and 32 MiB of last-level cache.
# cone_steps: the prototype behind the cones' target took 73 ms there (1.5 cones a pixel, 128^3), and 73.1 ms of processor time on the
# machine where our loop makes 97 million steps a second. That one multiplies and adds 1.6 times as fast: loads bound a march.
TARGETS_MACHINE = Calibration(
    read=38, triad=42, multiply_add=465, cone_steps=97, vector_bytes=64, threads=2, load=0,
    rays={
        "primary": {"single": 9.8, "8-wide": 27.5, "16-wide": 42, "stream of 256": 40},
        "sun shadow": {"single": 17.6, "8-wide": 35, "16-wide": 50, "stream of 256": 47},
        "bounce": {"single": 5.7, "8-wide": 6.2, "16-wide": 6.0, "stream of 256": 5.9},
        "bounce, shared in a tile": {"single": 8.7, "8-wide": 15, "16-wide": 20, "stream of 256": 18},
        "occlusion": {"single": 19, "8-wide": 22, "16-wide": 25, "stream of 256": 34},
    },
)  # fmt: skip


def calibrate(sponza: Sponza | None) -> Calibration:
    """Measures the machine; rays only where Sponza is there."""
    load = os.getloadavg()[0]
    return Calibration(
        read=_core.read_bandwidth(8),
        triad=_core.triad_bandwidth(8),
        multiply_add=_core.multiply_add_rate(20),
        cone_steps=_core.cone_step_rate(20),
        vector_bytes=_core.vector_bytes(),
        threads=len(os.sched_getaffinity(0)),
        load=load,
        rays={} if sponza is None else _ray_rates(sponza),
    )


def _ray_rates(sponza: Sponza) -> dict[str, dict[str, float]]:
    lists = ray_lists(sponza)
    rates = {}
    for kind, (origins, directions) in lists.items():
        any_hit, coherent = kind in ("sun shadow", "occlusion"), kind in ("primary", "sun shadow")
        works = [lambda w=w, o=origins, d=directions, a=any_hit, c=coherent: sponza.peer.trace(o, d, w, a, c) for w in WIDTHS.values()]
        times = least(*works, repeats=3)
        rates[kind] = {name: len(origins) / (1e3 * milliseconds) for name, milliseconds in zip(WIDTHS, times, strict=True)}
    return rates


def ray_lists(sponza: Sponza) -> dict[str, Rays]:
    """Origins and directions (n, 3) of each kind, in tiles of 16 x 16 pixels and packets of 4 x 4."""
    position, normal = (tiled(a) for a in (sponza.gbuffer.position, sponza.gbuffer.geometric_normal))
    seen = np.isfinite(tiled(sponza.gbuffer.depth[..., None])[:, 0])
    eye = np.broadcast_to(np.float32(sponza.camera.position), position.shape)
    away = np.where(seen[:, None], position - eye, np.float32([0, 1, 0])).astype(np.float32)
    # A thousandth of the scene's size off the surface: enough for single precision, too little to skip a wall.
    origins = (position + 1e-3 * float(np.ptp(sponza.scene.bounds, 0).max()) * normal).astype(np.float32)[seen]
    random = np.random.default_rng(1)
    pixel = random.random((len(position), 2))
    tile = np.repeat(random.random((len(position) // 256, 2)), 256, 0)
    bounce, shared = (cosine_directions(normal, u)[seen] for u in (pixel, tile))
    towards_sun = np.broadcast_to(-np.float32(sponza.sun.direction), origins.shape)
    return {
        "primary": (np.ascontiguousarray(eye), away / np.linalg.norm(away, axis=1, keepdims=True)),
        "sun shadow": (origins, np.ascontiguousarray(towards_sun)),
        "bounce": (origins, bounce),
        "bounce, shared in a tile": (origins, shared),
        "occlusion": (origins, bounce),
    }


def tiled(image: NDArray[Any]) -> NDArray[Any]:
    """(height, width, c) -> (n, c): tiles of 16 x 16, in them packets of 4 x 4; borders that fill no tile are left out."""
    rows, columns = image.shape[0] // 16, image.shape[1] // 16
    blocks = image[: 16 * rows, : 16 * columns].reshape(rows, 4, 4, columns, 4, 4, -1)
    return np.ascontiguousarray(blocks.transpose(0, 3, 1, 4, 2, 5, 6)).reshape(rows * columns * 256, -1)


def cosine_directions(normals: NDArray[np.float32], u: NDArray[np.float64]) -> NDArray[np.float32]:
    """Directions about the normals with density cos / pi: the normal plus a point on the unit sphere."""
    z, angle = 1 - 2 * u[:, 0], 2 * np.pi * u[:, 1]
    radius = np.sqrt(1 - z * z)
    sphere = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], 1)
    directions = normals + 0.9999 * sphere  # never zero
    return (directions / np.linalg.norm(directions, axis=1, keepdims=True)).astype(np.float32)
