"""Closed rooms, in which every reflection can be summed: rows 1 to 4 and 13."""

from __future__ import annotations

import numpy as np

from interreflect.scenes.builtin.closed_forms.value import ClosedForm
from interreflect.scenes.builtin.furnace import furnace
from interreflect.scenes.builtin.integrating_sphere import integrating_sphere
from interreflect.scenes.builtin.measured import facing_camera
from interreflect.scenes.builtin.shapes import Shape, box, flipped, mesh, sphere
from interreflect.scenes.builtin.squares import emitter_material
from interreflect.scenes.checks import choice, number
from interreflect.scenes.values import Camera, Material, Scene

FLAT = "exact on flat faces"
FACETS = "a sphere of 96 rings with the true area: facets lie up to 3e-4 off the sphere"


def white_furnace(shape: str = "cube", albedo: float = 0.5, bounces: int | None = None) -> ClosedForm:
    """Row 1. Le / (1 - rho); with bounces=0, emission and one reflection, Le (1 + rho)."""
    _all_or("white_furnace.bounces", bounces, 0)
    scene = furnace(shape, albedo)
    return ClosedForm(
        row=1,
        quantity="radiance everywhere in a closed room of emission 1",
        value=1 + albedo if bounces == 0 else 1 / (1 - albedo),
        scene=scene,
        bounces=bounces,
        tolerance=1e-5,
        reason="exact for any closed mesh; the tolerance is that of sums in float32",
    )


def one_emitting_face(albedo: float = 0.5, bounces: int | None = None) -> ClosedForm:
    """Row 2. (A_e / A) E / (1 - rho) for the unit cube, one face of exitance E = 1; with bounces=0, (A_e / A) E (1 + rho)."""
    _all_or("one_emitting_face.bounces", bounces, 0)
    rho = number("one_emitting_face.albedo", albedo, 0, 0.999)
    return ClosedForm(
        row=2,
        quantity="mean radiosity over the six faces of a unit cube, one of which has exitance 1",
        value=(1 + rho if bounces == 0 else 1 / (1 - rho)) / 6,
        scene=_cube(rho),
        bounces=bounces,
        cameras=("emitter", "opposite", "side"),
        weights=(1 / 6, 1 / 6, 4 / 6),
        scale=np.pi,
        tolerance=1e-3,
        reason="radiosity changes quickest along the emitter's edges: midpoints of 32 x 32 pixels, error of second order",
    )


def _cube(albedo: float) -> Scene:
    half = 0.5
    faces = flipped(box((-half,) * 3, (half,) * 3))
    emits = (faces.positions[faces.triangles][:, :, 0] == half).all(axis=1)
    grey = Material(name="wall", albedo=(albedo,) * 3)
    glow = Material(name="emitter", albedo=(albedo,) * 3, emission=(1 / np.pi,) * 3)
    meshes = [mesh(Shape(faces.positions, faces.triangles[part]), paint) for part, paint in ((~emits, grey), (emits, glow))]
    faced = {"emitter": (half, 0, 0), "opposite": (-half, 0, 0), "side": (0, 0, -half)}
    cameras = {n: facing_camera(c, -np.sign(c), half_width=half, distance=half) for n, c in faced.items()}
    return Scene(name=f"one_emitting_face(albedo={albedo:g})", meshes=meshes, cameras=cameras)


def lit_sphere(albedo: float = 0.5, part: str = "image") -> ClosedForm:
    """Row 3. rho I / (pi R^2) / (1 - rho), I = pi, R = 1; part "direct": the first reflection, "indirect": the second."""
    choice("lit_sphere.part", part, ("image", "direct", "indirect"))
    scene = integrating_sphere(albedo, flux=4 * np.pi**2, light="point")
    bounces, value = {"image": (None, albedo / (1 - albedo)), "direct": (0, albedo), "indirect": (1, albedo**2)}[part]
    return ClosedForm(
        row=3,
        quantity="radiance of a sphere around a point light of intensity pi",
        value=value,
        scene=scene,
        bounces=bounces,
        part=part,
        reason=FACETS,
    )


def lit_cap(albedo: float = 0.5, bounces: int | None = 1, cap: float = 30) -> ClosedForm:
    """Row 4. Irradiance of reflected light: rho Phi / (4 pi R^2) once reflected (bounces=1), rho / (1 - rho) of it in all."""
    _all_or("lit_cap.bounces", bounces, 1)
    scene = integrating_sphere(albedo, cap=cap)
    return ClosedForm(
        row=4,
        quantity="irradiance of reflected light in a sphere of radius 1, a spot of flux 1 on part of its wall",
        value=(albedo if bounces == 1 else albedo / (1 - albedo)) / (4 * np.pi),
        scene=scene,
        bounces=bounces,
        part="indirect",
        scale=np.pi / albedo,
        reason=FACETS,
    )


def concentric_spheres(albedo: float = 0.5, bounces: int | None = None) -> ClosedForm:
    """Row 13. rho F21 / (1 - rho F22), F21 = 1/4, F22 = 3/4; with bounces=0, rho F21."""
    _all_or("concentric_spheres.bounces", bounces, 0)
    rho = number("concentric_spheres.albedo", albedo, 0, 0.999)
    inner = mesh(sphere(1), emitter_material())
    outer = mesh(flipped(sphere(2)), Material(name="outer", albedo=(rho,) * 3))
    camera = Camera(position=(1.5, 0, 0), target=(2, 0, 0), fov_x=60)
    return ClosedForm(
        row=13,
        quantity="radiosity of a sphere of radius 2 around a black one of radius 1 and exitance 1",
        value=rho / 4 / (1 if bounces == 0 else 1 - 0.75 * rho),
        scene=Scene(name=f"concentric_spheres(albedo={rho:g})", meshes=[inner, outer], cameras={"view": camera}),
        bounces=bounces,
        scale=np.pi,
        reason=FACETS,
    )


def _all_or(argument: str, bounces: object, one: int) -> None:
    if bounces is not None and bounces != one:
        raise ValueError(f"{argument} must be None (all) or {one}, got {bounces!r}")
