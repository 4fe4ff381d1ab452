"""Light propagation volumes: what is injected, what neighbours send, what is kept, against sums and integrals made here."""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np
import pytest
from tests.stability.faults import overwrite

import interreflect as ir
from interreflect import _core, stages

CELLS = (9, 8, 7)  # x, y, z
DOMAIN = _core.Domain(lower=(-1.0, 2.0, 0.5), voxel_size=0.25, cells=CELLS)
ISOTROPIC = 2 * np.sqrt(np.pi)  # times the mean coefficient: the integral over all directions


def lights(position, normal, flux):
    arrays = [np.ascontiguousarray(np.atleast_2d(values), np.float32) for values in (position, normal, flux)]
    n = len(arrays[0])
    return _core.VirtualLights(*arrays, np.ones(n, np.float32), np.zeros(n, np.float32))


def scattered(count, seed=0, margin=2.5):
    """Lights all over the grid, `margin` cells from its faces."""
    rng = np.random.default_rng(seed)
    normal = rng.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    at = rng.uniform(margin, np.array(CELLS) - margin, (count, 3))
    return lights(np.array(DOMAIN.lower) + DOMAIN.voxel_size * at, normal, rng.uniform(0, 5, (count, 3)))


def totals(volume):
    """Flux of every colour in all cells."""
    return ISOTROPIC * np.asarray(volume.coefficients, float)[..., 0].sum((0, 1, 2))


def harmonics(d):
    x, y, z = np.moveaxis(np.asarray(d, float), -1, 0)
    return np.stack([np.full_like(x, np.sqrt(0.25 / np.pi)), *(np.sqrt(0.75 / np.pi) * v for v in (y, z, x))], -1)


@cache
def directions(n=400):
    """Evenly spread over the sphere, and the solid angle of each."""
    z = (np.arange(n) + 0.5) / n * 2 - 1
    phi = (np.arange(2 * n) + 0.5) / n * np.pi
    z, phi = np.meshgrid(z, phi, indexing="ij")
    r = np.sqrt(1 - z**2)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), 4 * np.pi / z.size


def lobe(normal):
    """Coefficients of max(0, cos) / pi about it, by quadrature."""
    d, solid_angle = directions()
    return np.tensordot(np.maximum(d @ np.asarray(normal, float), 0) / np.pi, harmonics(d), 2) * solid_angle


FACES = [np.array(face, float) for face in itertools.chain(np.eye(3), -np.eye(3))]


@cache
def far_faces():
    """Way to a neighbour, face of it, and the solid angle of that from the middle of a cell: by rays that leave through it."""
    d, solid_angle = directions()
    rows = []
    for way in FACES:
        # Through the face to the neighbour, and out of that where its first far plane is met.
        forward = d @ way
        enters = (forward > 0) & (np.abs(d[..., way == 0]).max(-1) < forward)
        leaves = np.argmin((way + 0.5 * np.sign(d)) / np.where(d == 0, 1e-12, d), -1)
        for face in (face for face in FACES if (face != -way).any()):
            axis = int(np.argmax(np.abs(face)))
            seen = enters & (leaves == axis) & (np.sign(d[..., axis]) == face[axis])
            rows.append((way, face, seen.sum() * solid_angle))
    return rows


def step(volume, clamps):
    """What every cell gets of its neighbours through each face of its own."""
    out = np.zeros_like(volume)
    padded = np.pad(volume, ((1, 1), (1, 1), (1, 1), (0, 0), (0, 0)))
    for way, face, angle in far_faces():
        source = np.roll(padded, tuple(int(v) for v in way[::-1]), (0, 1, 2))[1:-1, 1:-1, 1:-1]
        middle = way + 0.5 * face
        flux = angle * (source @ harmonics(middle / np.linalg.norm(middle)))
        out += (np.maximum(flux, 0) if clamps else flux)[..., None] * lobe(face)
    return out


def test_the_far_faces_of_six_neighbours_are_all_directions():
    assert sum(angle for _, _, angle in far_faces()) == pytest.approx(4 * np.pi, rel=1e-3)
    # As the paper prints them.
    angles = sorted(angle for _, _, angle in far_faces())
    assert angles[:6] == pytest.approx([0.4006696846] * 6, rel=3e-3) and angles[6:] == pytest.approx([0.4234413544] * 24, rel=3e-3)


def test_what_is_injected_is_the_flux_of_the_lights_in_lobes_about_their_normals():
    given = scattered(40)
    injected = stages.inject(given, DOMAIN)
    assert totals(injected) == pytest.approx(np.asarray(given.flux).sum(0), rel=1e-5)
    summed = np.asarray(injected.coefficients, float).sum((0, 1, 2))
    expected = sum(np.outer(flux, lobe(normal)) for flux, normal in zip(given.flux, given.normal, strict=True))
    assert summed == pytest.approx(expected, abs=1e-4 * expected.max())
    assert injected.counts.asdict()["virtual_lights"] == 40 and injected.bytes == np.prod(CELLS) * 48


def test_light_stands_half_a_cell_before_its_surface():
    """In the middle of a cell it lights that cell alone; midway, two of them by halves."""
    at = np.array(DOMAIN.lower) + DOMAIN.voxel_size * np.array((4.5, 3.5, 2.0))
    alone = np.asarray(stages.inject(lights(at, (0, 0, 1), (1, 1, 1)), DOMAIN).coefficients)
    assert np.argwhere(np.abs(alone[..., 0, 0]) > 1e-6).tolist() == [[2, 3, 4]]
    halves = np.asarray(stages.inject(lights(at, (0, 1, 0), (1, 1, 1)), DOMAIN).coefficients)[..., 0, 0] * ISOTROPIC
    places = {tuple(int(v) for v in place): float(halves[tuple(place)]) for place in np.argwhere(halves > 1e-6)}
    assert places == pytest.approx({(1, 3, 4): 0.25, (1, 4, 4): 0.25, (2, 3, 4): 0.25, (2, 4, 4): 0.25}, rel=1e-4)


def test_lights_outside_are_left_out_and_those_at_the_faces_stay_in():
    inside, outside = (0.01, 3.0, 3.0), (-0.01, 3.0, 3.0)
    for place, expected in ((inside, 1), (outside, 0)):
        at = np.array(DOMAIN.lower) + DOMAIN.voxel_size * np.array(place)
        assert totals(stages.inject(lights(at, (-1, 0, 0), (1, 1, 1)), DOMAIN)) == pytest.approx([expected] * 3, abs=1e-6)


@pytest.mark.parametrize("negative", ["clamped", "kept"])
def test_a_step_sends_the_flux_through_every_face_of_every_neighbour(negative):
    injected = stages.inject(scattered(30, seed=1, margin=0), DOMAIN)
    before = np.asarray(injected.coefficients, float)
    once, twice = (spread(injected, n, negative) for n in (1, 2))
    first = step(before, negative == "clamped")
    # Solid angles and lobes by 3e5 directions.
    assert once == pytest.approx(first, abs=2e-3 * np.abs(first).max())
    second = first + step(first, negative == "clamped")
    assert twice == pytest.approx(second, abs=2e-3 * np.abs(second).max())


def spread(injected, iterations, negative="kept", blockers=None):
    technique = ir.LightPropagation(iterations=iterations, negative=negative)
    return np.asarray(stages.propagate(technique, injected, blockers).coefficients, float)


def fluxes(injected, iterations, negative):
    """Of red in the whole grid, after every step."""
    sums = [ISOTROPIC * spread(injected, n, negative)[..., 0, 0].sum() for n in range(iterations + 1)]
    return np.diff(sums)


def centred(cells=15, normal=(0, 0, 1)):
    """A light of flux 1 in the middle cell of a large grid."""
    domain = _core.Domain(lower=(0, 0, 0), voxel_size=1.0, cells=(cells, cells, cells))
    at = np.full(3, cells / 2) - 0.5 * np.asarray(normal, float)
    return stages.inject(lights(at, normal, (1, 1, 1)), domain)


def test_flux_is_conserved_until_it_leaves_the_grid_and_grows_once_by_what_is_clamped():
    """Seven steps to the faces. Two bands of a lobe are negative behind it: clamped, its flux of 1 grows by an eighth in the first step,
    and no more; 1.138 where the five directions of each neighbour stand for the integral, whose own is 9/8."""
    kept, clamped = (fluxes(centred(), 12, negative) for negative in ("kept", "clamped"))
    assert kept[:7] == pytest.approx(np.ones(7), abs=1e-5)
    assert clamped[0] == pytest.approx(9 / 8, rel=0.02) and clamped[:7] == pytest.approx(np.full(7, clamped[0]), rel=1e-4)
    for after in (kept[6:], clamped[6:]):
        assert (np.diff(after) < 0).all() and after[-1] > 0


@pytest.mark.parametrize(("normal", "least", "most"), [((0, 0, 1), 0.93, 1.5), ((0.6, 0, 0.8), 0.8, 1.4)])
def test_light_falls_with_the_square_of_the_distance_but_for_what_a_grid_of_two_bands_smears(normal, least, most):
    """On the axis of a lobe, irradiance flux / (pi d^2); measured .98 to 1.46 of it for two to seven cells in a grid of 41."""
    injected = centred(41, normal)
    volume = spread(injected, 80, "clamped")[..., 0, :]
    for distance in range(2, 8):
        cell = np.rint(20 + distance * np.asarray(normal)).astype(int)
        far = np.linalg.norm(cell - 20)
        found = volume[tuple(cell[::-1])] @ harmonics((cell - 20) / far) / 0.5**2
        assert least < found * np.pi * far**2 < most, distance


def test_volumes_add_up_and_scale_with_light():
    first, second, both = (stages.inject(scattered(20, seed), DOMAIN) for seed in (1, 2, 1))
    together = np.asarray(both.coefficients) + np.asarray(second.coefficients)
    overwrite(both.coefficients, together)
    sums = spread(first, 6) + spread(second, 6)
    assert spread(both, 6) == pytest.approx(sums, abs=1e-5 * np.abs(sums).max())
    for negative in ("kept", "clamped"):
        once = spread(first, 6, negative)
        overwrite(second.coefficients, 4 * np.asarray(first.coefficients))
        assert (spread(second, 6, negative) == 4 * once).all()


def turned(volume):
    """By 90 degrees about z: x to y, y to -x."""
    around = np.swapaxes(volume, 1, 2)[:, :, ::-1].copy()
    around[..., 1], around[..., 3] = around[..., 3].copy(), -around[..., 1].copy()
    return around


def test_what_is_turned_before_or_after_it_spread_is_the_same():
    first, other = centred(), centred()
    around = turned(np.asarray(first.coefficients))
    overwrite(other.coefficients, around)
    assert spread(other, 5, "clamped") == pytest.approx(turned(spread(first, 5, "clamped")), abs=1e-6)


def test_threads_and_place_do_not_matter():
    given = scattered(200, seed=3, margin=0)
    expected = spread(stages.inject(given, DOMAIN), 5, "clamped")
    with _core.Threads(1):
        assert (spread(stages.inject(given, DOMAIN), 5, "clamped") == expected).all()
    moved = _core.Domain(lower=tuple(np.add(DOMAIN.lower, 4)), voxel_size=0.25, cells=CELLS)
    there = lights(np.asarray(given.position) + np.float32(4), given.normal, given.flux)
    assert spread(stages.inject(there, moved), 5, "clamped") == pytest.approx(expected, abs=1e-4 * np.abs(expected).max())


def wall(z, facing, cells=15):
    """Surfels all over a plane of a grid of unit cells, one a cell; and what they block."""
    x, y = (np.ravel(v) + 0.5 for v in np.mgrid[:cells, :cells])
    room = ir.scenes.cornell_box()
    surfels = stages.place_surfels(ir.HaltonSurfels(surfels=4 * cells**2), room)
    rng = np.random.default_rng(0)
    n = len(surfels)
    which = rng.permutation(n) % cells**2
    overwrite(surfels.position, np.stack([x[which], y[which], np.full(n, z)], 1))
    overwrite(surfels.normal, np.broadcast_to(np.asarray(facing, np.float32), (n, 3)))
    overwrite(surfels.area, 1 / np.bincount(which)[which])
    return stages.geometry_volume(surfels, _core.Domain(lower=(0, 0, 0), voxel_size=1.0, cells=(cells, cells, cells)))


def test_a_wall_blocks_three_quarters_of_the_light_that_meets_its_front_and_none_from_behind():
    blocked = np.asarray(wall(9.0, (0, 0, -1)).coefficients, float)
    # Of all corners but those at the faces, which have half of a cell's surface about them.
    inner = blocked[9, 2:-2, 2:-2].mean((0, 1))
    assert inner @ harmonics((0, 0, -1)) == pytest.approx(0.75, rel=1e-4) and inner @ harmonics((0, 0, 1)) < 0
    assert not blocked[:9].any() and not blocked[10:].any()


def test_light_behind_a_wall_is_less_by_what_it_blocks():
    injected = centred()
    free, front, back = (spread(injected, 7, "clamped", b)[..., 0, 0] for b in (None, wall(9.0, (0, 0, -1)), wall(9.0, (0, 0, 1))))
    # The seven steps: light gets to the wall in the second, and what came through went once through it.
    assert 0.2 < front[9, 7, 7] / free[9, 7, 7] < 0.45
    assert back[9, 7, 7] > 0.9 * free[9, 7, 7]
    assert (front <= free * (1 + 1e-5)).all()


def test_bad_input_is_told():
    with pytest.raises(ValueError, match="evenly spread cells"):
        stages.inject(scattered(1), stages.place(ir.Grid(resolution=8, warp=ir.CubicSpline()), ir.scenes.cornell_box()))
    with pytest.raises(ValueError, match="would hold more than 4 GiB"):
        stages.inject(scattered(1), _core.Domain(lower=(0, 0, 0), voxel_size=1.0, cells=(1024, 1024, 1024)))
    with pytest.raises(ValueError, match="blockers of another grid"):
        stages.propagate(ir.LightPropagation(), stages.inject(scattered(1), DOMAIN), wall(9.0, (0, 0, 1)))
    for knobs, message in (
        ({"grid": ir.Grid(warp=ir.CubicSpline())}, "one grid of evenly spread cells"),
        ({"grid": ir.Grid(cascades=2)}, "one grid of evenly spread cells"),
        ({"sky": ir.ConeSky()}, "ConeSky needs cones"),
        ({"shadow": ir.VoxelCones()}, "VoxelCones needs voxels"),
    ):
        with pytest.raises(ValueError, match=message):
            ir.methods.LightPropagationVolumes(**knobs)


def test_no_light_and_no_steps_leave_pixels_black():
    room = ir.scenes.cornell_box(light="point")
    dark = ir.methods.LightPropagationVolumes().render(room.replace(lights=[]), size=(16, 12))
    still = ir.methods.LightPropagationVolumes(propagate=ir.LightPropagation(iterations=0)).render(room, size=(16, 12))
    assert not dark.indirect.any() and not still.indirect.any() and still.direct.any()
