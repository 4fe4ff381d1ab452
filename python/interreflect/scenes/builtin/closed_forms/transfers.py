"""Light from one surface to another, form factors: rows 5 to 8, 10 and 12. The emitters are black and have exitance 1."""

from __future__ import annotations

import numpy as np

from interreflect.scenes.builtin.closed_forms.value import ClosedForm
from interreflect.scenes.builtin.disk_above_point import disk_above_point
from interreflect.scenes.builtin.measured import facing_camera, point_camera
from interreflect.scenes.builtin.shapes import Shape, disk, mesh, quad, sphere
from interreflect.scenes.builtin.squares import corner, emitter_material, facing_squares
from interreflect.scenes.checks import number
from interreflect.scenes.values import Camera, Material, Scene

RHO = 0.5  # of receivers; it cancels
PER_IRRADIANCE = np.pi / RHO  # a receiver's irradiance over its radiance
MIDPOINTS = "midpoints of 64 x 64 pixels, error of second order"
NARROW = "a picture 1 degree wide: second order in the shift from the point"


def parallel_squares(distance: float = 1) -> ClosedForm:
    """Row 5. Howell C-11 for unit squares."""
    scene = facing_squares(distance, RHO)
    x = 1 / distance
    root = np.sqrt(1 + x * x)
    half = np.log((1 + x * x) / np.sqrt(1 + 2 * x * x)) + 2 * x * root * np.arctan(x / root) - 2 * x * np.arctan(x)
    return _received(5, "form factor between parallel unit squares", 2 / (np.pi * x * x) * half, scene, "receiver")


def perpendicular_squares() -> ClosedForm:
    """Row 6. Howell C-14 for unit squares with a shared edge."""
    root = np.sqrt(2)
    value = (np.pi / 2 - root * np.arctan(1 / root) + 0.25 * np.log(3 / 4)) / np.pi
    quantity = "form factor between perpendicular unit squares with a shared edge"
    return _received(6, quantity, value, corner("wall", RHO), "receiver")


def coaxial_disks(radius: float = 1, other_radius: float = 1, distance: float = 1) -> ClosedForm:
    """Row 7. From the emitting disk to the other: (X - sqrt(X^2 - 4 (r2/r1)^2)) / 2, X = 1 + (1 + R2^2) / R1^2, R = r / h."""
    r1 = number("coaxial_disks.radius", radius, 0, open_low=True)
    r2 = number("coaxial_disks.other_radius", other_radius, 0, open_low=True)
    h = number("coaxial_disks.distance", distance, 0, open_low=True)
    x = 1 + (1 + (r2 / h) ** 2) / (r1 / h) ** 2
    half = 1.001 * r2  # disks of 256 corners with the true area reach 1.0001 r
    emitter = disk(r1, centre=(0, h, 0), down=True)
    camera = facing_camera((0, 0, 0), (0, 1, 0), half_width=half, distance=0.5 * h)
    scene = _pair(disk(r2), emitter, {"receiver": camera}, "coaxial_disks")
    share = (2 * half) ** 2 / (np.pi * r1 * r1)  # the picture is a square around the receiver, black beside it
    return ClosedForm(
        row=7,
        quantity="share of the light of one disk that reaches a coaxial one",
        value=float(x - np.sqrt(x * x - 4 * (r2 / r1) ** 2)) / 2,
        scene=scene,
        bounces=0,
        cameras=("receiver",),
        scale=PER_IRRADIANCE * share,
        size=(128, 128),
        tolerance=2e-3,
        reason="the receiver's rim in 128 x 128 pixels",
    )


def point_below_disk(offset: float = 0, radius: float = 1, height: float = 1) -> ClosedForm:
    """Row 8. (1 - (1 + H^2 - R^2) / sqrt(Z^2 - 4 R^2)) / 2, Z = 1 + H^2 + R^2, H and R over the offset (Howell B-13).

    Below the centre R^2 / (R^2 + h^2).
    """
    scene = disk_above_point(radius, height, offset, RHO)
    # All terms times the squared offset, so that it may be 0.
    a2, h2, r2 = offset**2, height**2, radius**2
    z = a2 + h2 + r2
    value = (1 - (a2 + h2 - r2) / np.sqrt(z * z - 4 * a2 * r2)) / 2
    return _at_point(8, "form factor from a point of the floor to a disk", value, scene, "point")


def sphere_light(radius: float = 0.5, distance: float = 2, tilt: float = 60) -> ClosedForm:
    """Row 10. E / (pi L) = (r / d)^2 cos(tilt), for a sphere that is wholly above the horizon."""
    r = number("sphere_light.radius", radius, 0, open_low=True)
    d = number("sphere_light.distance", distance, r, open_low=True)
    highest = float(90 - np.degrees(np.arcsin(r / d)))
    angle = np.radians(number("sphere_light.tilt", tilt, 0, highest))
    centre = (d * np.sin(angle), d * np.cos(angle), 0)
    camera = point_camera((0, 0, 0), distance=0.25 * (d - r))
    scene = _pair(_floor(4 * d), sphere(r, centre=centre), {"point": camera}, "sphere_light")
    return _at_point(10, "form factor from a point of the floor to a sphere", (r / d) ** 2 * np.cos(angle), scene, "point")


def square_light(height: float = 1) -> ClosedForm:
    """Row 12. Four times the form factor to a rectangle above a corner (Howell B-4), half a unit wide and long."""
    h = number("square_light.height", height, 0, open_low=True)
    x = 0.5 / h
    root = np.sqrt(1 + x * x)
    value = 4 / np.pi * x / root * np.arctan(x / root)
    emitter = quad((-0.5, h, -0.5), (1, 0, 0), (0, 0, 1))
    scene = _pair(_floor(4 + 4 * h), emitter, {"point": point_camera((0, 0, 0), distance=0.5 * h)}, "square_light")
    return _at_point(12, "form factor from a point of the floor to a unit square above it", value, scene, "point")


def _floor(side: float) -> Shape:
    return quad((-side / 2, 0, side / 2), (side, 0, 0), (0, 0, -side))


def _pair(receiver: Shape, emitter: Shape, cameras: dict[str, Camera], name: str) -> Scene:
    grey = Material(name="receiver", albedo=(RHO,) * 3)
    return Scene(name=name, meshes=[mesh(receiver, grey), mesh(emitter, emitter_material())], cameras=cameras)


def _received(row: int, quantity: str, value: float, scene: Scene, camera: str) -> ClosedForm:
    return ClosedForm(
        row=row,
        quantity=quantity,
        value=float(value),
        scene=scene,
        bounces=0,
        cameras=(camera,),
        scale=PER_IRRADIANCE,
        size=(64, 64),
        tolerance=1e-3,
        reason=MIDPOINTS,
    )


def _at_point(row: int, quantity: str, value: float, scene: Scene, camera: str) -> ClosedForm:
    return ClosedForm(
        row=row,
        quantity=quantity,
        value=float(value),
        scene=scene,
        bounces=0,
        cameras=(camera,),
        scale=PER_IRRADIANCE,
        reason=NARROW,
    )
