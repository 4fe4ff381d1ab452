"""Configurations whose answer is known, numbered as in the table of closed forms (rows 1 to 17)."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from interreflect.scenes.builtin.closed_forms import enclosures, skies, transfers
from interreflect.scenes.builtin.closed_forms.value import ClosedForm
from interreflect.scenes.checks import nearest_name, whole

ROWS: dict[int, Callable[..., ClosedForm]] = {
    1: enclosures.white_furnace,
    2: enclosures.one_emitting_face,
    3: enclosures.lit_sphere,
    4: enclosures.lit_cap,
    5: transfers.parallel_squares,
    6: transfers.perpendicular_squares,
    7: transfers.coaxial_disks,
    8: transfers.point_below_disk,
    9: skies.sphere_above_point,
    10: transfers.sphere_light,
    11: skies.floor_beside_wall,
    12: transfers.square_light,
    13: enclosures.concentric_spheres,
    14: skies.slanted_sun,
    15: skies.cosine_sky,
    16: skies.reconstructed_sun,
    17: skies.white_metal,
}


def closed_form(row: int, **knobs: Any) -> ClosedForm:
    """A configuration with its exact answer: scene, camera, quantity, value, and `measure(frame)` to read it off a picture.

    row: 1 white furnace (shape, albedo, bounces), 2 cube with one emitting face (albedo, bounces), 3 point light in a sphere
    (albedo, part), 4 spot in a sphere (albedo, bounces, cap), 5 parallel squares (distance), 6 perpendicular squares, 7 coaxial
    disks (radius, other_radius, distance), 8 point below a disk (offset, radius, height), 9 sphere above a point (radius,
    height), 10 sphere light (radius, distance, tilt), 11 floor beside a wall, 12 square light (height), 13 concentric spheres
    (albedo, bounces), 14 slanted sun (albedo, tilt), 15 cosine sky, 16 a sun in spherical harmonics (angle), 17 metal (alpha).
    knobs: as in brackets; without them, the row's first number.
    Raises ValueError for another row and for a knob out of range, TypeError for a knob that the row does not have.
    """
    make = ROWS[whole("closed_form.row", row, 1, len(ROWS))]
    known = list(inspect.signature(make).parameters)
    for name in knobs:
        if name not in known:
            raise TypeError(f"closed_form({row}) has no knob {name!r}{nearest_name(name, known)}")
    return make(**knobs)
