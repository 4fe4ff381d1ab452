"""Least milliseconds of each kernel: the fewest bytes it must move and operations it must do, over what the machine can do."""

from __future__ import annotations

from bench.calibration import Calibration

GBUFFER_BYTES = 6 * 12 + 2 * 4 + 3 * 4  # a pixel: six vectors, two floats, three numbers
MILLION, GIGA = 1e6, 1e9


def move(c: Calibration, count: float) -> float:
    """Bytes over the triad bandwidth, which both reads and writes."""
    return 1e3 * count / (c.triad * GIGA)


def trace(c: Calibration, kind: str, count: float) -> float:
    """Rays over the rate of Embree's fastest call for that kind, in this run."""
    return 1e3 * count / (c.best(kind) * MILLION)


def compute(c: Calibration, operations: float) -> float:
    """Operations over the rate of fused multiply-adds, two each."""
    return 1e3 * operations / (c.multiply_add * GIGA)


def hierarchy(c: Calibration, vertices: int, triangles: int) -> float:
    """Each vertex and index read once, a hierarchy of 64 bytes a triangle (Embree's 17 MiB for Sponza) written once."""
    return move(c, 12 * vertices + 12 * triangles + 64 * triangles)


def gbuffer(c: Calibration, pixels: int) -> float:
    """One primary ray a pixel, while the pictures stream out."""
    return max(trace(c, "primary", pixels), move(c, GBUFFER_BYTES * pixels))


def sun_shadows(c: Calibration, pixels: int) -> float:
    """One shadow ray a pixel, while position and normal stream in and radiance out."""
    return max(trace(c, "sun shadow", pixels), move(c, 3 * 12 * pixels))


def path_sample(c: Calibration, pixels: int, bounces: float) -> float:
    """One path a pixel: a primary ray; at each vertex a shadow ray to the sun and one to the sky; between vertices a nearest hit.

    The bounce rays share their directions within a tile (unbiased, as every tile has its own). Later vertices see the sun along parallel
    rays too, but from places that do not lie side by side: the rate of the any-hit rays.
    """
    first = trace(c, "primary", pixels) + trace(c, "sun shadow", pixels) + trace(c, "occlusion", pixels)
    later = trace(c, "bounce, shared in a tile", pixels) + 2 * trace(c, "occlusion", pixels)
    return first + bounces * later


def cone_march(c: Calibration, steps: float) -> float:
    """A step blends two trilinear look-ups of eight texels with four channels (64 multiply-adds) and adds the result (four)."""
    return compute(c, 2 * (64 + 4) * steps)


def around_cones(c: Calibration, pixels: int, samples: float, voxels: float) -> float:
    """G-buffer and sun shadows; each surface sample and voxel is written and read once (48 bytes), each voxel asks the sun once."""
    voxel_light = trace(c, "occlusion", voxels) + move(c, 2 * 48 * (samples + voxels))
    return gbuffer(c, pixels) + sun_shadows(c, pixels) + voxel_light


def voxel_frame(c: Calibration, pixels: int, steps: float, samples: float, voxels: float) -> float:
    """Cones, and all that is around them."""
    return around_cones(c, pixels, samples, voxels) + cone_march(c, steps)


VOXEL_BYTES = 4 + 5 * 12 + 4 + 2 * 32  # a voxel: its cell, four vectors and its point, opacity and area, points of both sides


def voxelize(c: Calibration, vertices: int, triangles: int, samples: float, voxels: float) -> float:
    """Vertices (with texture coordinates) and indices are read once, voxels written once; a triangle takes three corners to the grid
    and a normal (40 operations), a sample its place and its part of the sums (20)."""
    return max(move(c, 20 * vertices + 12 * triangles + VOXEL_BYTES * voxels), compute(c, 40 * triangles + 20 * samples))


def light_map(c: Calibration, texels: float) -> float:
    """One ray a texel, side by side, while the depths stream out."""
    return max(trace(c, "sun shadow", texels), move(c, 4 * texels))


def inject(c: Calibration, texels: float, voxels: float) -> float:
    """Each texel's hit goes to its cells (30 operations); of each voxel its cell, point, albedo and 3 x 3 texels are read and its
    radiance written (130 operations)."""
    return max(move(c, 4 * texels + (4 + 32 + 12 + 12) * voxels), compute(c, 30 * texels + 130 * voxels))


def trace_lights(c: Calibration, rays: float, voxels: float) -> float:
    """Each voxel asks the lights by rays; its cell, point and albedo are read and its radiance written."""
    return max(trace(c, "occlusion", rays), move(c, (4 + 32 + 12 + 12) * voxels))


def prefilter(c: Calibration, texels_bytes: float, voxels: float) -> float:
    """All levels written once; of each voxel cell and radiance are read."""
    return move(c, texels_bytes + 16 * voxels)


def distribute(c: Calibration, pixels: int) -> float:
    """Each pixel's depth, normal and position are read once, the number of its cluster is written."""
    return move(c, (4 + 12 + 12 + 4) * pixels)


def create(c: Calibration, steps: float, texels_bytes: float) -> float:
    """Cones, whose texels are written once, read once for what is made of them, and that written."""
    return cone_march(c, steps) + move(c, 3 * texels_bytes)


def evaluate(c: Calibration, pixels: int, evaluations: float) -> float:
    """A cache's weight for a pixel (20 operations), two bilinear looks of its chain and one of its table (12 texels of four channels, a
    multiply-add each); of each pixel nine vectors and numbers are read and its light written."""
    return max(compute(c, (20 + 2 * 48) * evaluations), move(c, (36 + 56) * pixels))


REFLECTIVE_BYTES = 5 * 12 + 3 * 4  # a texel: five vectors, three floats


def reflective_map(c: Calibration, texels: int) -> float:
    """One ray a texel, side by side, while the map streams out."""
    return max(trace(c, "primary", texels), move(c, REFLECTIVE_BYTES * texels))


def cluster(c: Calibration, texels: int, comparisons: float) -> float:
    """A texel and a centre by place, normal and flux (22 operations, two of them roots); position, normal, flux and area of each texel
    are read and its cluster written; where each cluster's texels lie is known only after all, so position and cluster are read again."""
    return max(compute(c, 22 * comparisons), move(c, (3 * 12 + 4 + 4 + 12 + 4) * texels))


def imperfect_maps(c: Calibration, points: int, maps_bytes: float) -> float:
    """Each point is read and projected (40 operations); the maps are cleared, read to pull and written by pushing."""
    return max(compute(c, 40 * points), move(c, (2 * 12 + 4) * points + 3 * maps_bytes))


def virtual_lights(c: Calibration, pixels: int, evaluations: float, lookups: float) -> float:
    """A light for a pixel (50 operations), a lookup of its map (20: the place on the disk, its texel, the comparison); of each pixel
    eight vectors and numbers are read and its light written, which merging and filtering does twice more."""
    return max(compute(c, 50 * evaluations + 20 * lookups), move(c, 3 * (36 + 24) * pixels))
