"""Light from infinity on a floor, and what reflection makes of it: rows 9, 11 and 14 to 17."""

from __future__ import annotations

import numpy as np

from interreflect.scenes.builtin.closed_forms.value import ClosedForm
from interreflect.scenes.builtin.measured import point_camera
from interreflect.scenes.builtin.shapes import Shape, mesh, quad, sphere
from interreflect.scenes.checks import number
from interreflect.scenes.values import DirectionalLight, EnvironmentLight, Light, Material, Scene

RHO = 0.5  # of floors; it cancels
NARROW = "a picture 1 degree wide: second order in the shift from the point"
BLACK = Material(name="black", albedo=(0, 0, 0))


def sphere_above_point(radius: float = 0.5, height: float = 1) -> ClosedForm:
    """Row 9. (r / h)^2."""
    r = number("sphere_above_point.radius", radius, 0, open_low=True)
    h = number("sphere_above_point.height", height, r, open_low=True)
    scene = _floor(RHO, EnvironmentLight(), "sphere_above_point", sphere(r, centre=(0, h, 0)), eye=0.5 * (h - r))
    return ClosedForm(
        row=9,
        quantity="occlusion of a point of the floor by a black sphere above it",
        value=(r / h) ** 2,
        scene=scene,
        bounces=0,
        scale=-1 / RHO,
        offset=1,
        tolerance=2e-3,
        reason="a sphere of 96 rings, 1e-3 of what is left of the sky, and " + NARROW,
    )


def floor_beside_wall() -> ClosedForm:
    """Row 11. (1 + cos phi) / 2 with the wall's top at phi = 45 degrees."""
    wall = quad((-1, 0, 1000), (0, 0, -2000), (0, 1, 0))
    return ClosedForm(
        row=11,
        quantity="share of the sky that lights a floor as far from an infinite wall as that is high",
        value=(1 + float(np.sqrt(0.5))) / 2,
        scene=_floor(RHO, EnvironmentLight(), "floor_beside_wall", wall),
        bounces=0,
        scale=1 / RHO,
        reason="a wall 2000 times as long as high, and " + NARROW,
    )


def slanted_sun(albedo: float = 0.5, tilt: float = 60) -> ClosedForm:
    """Row 14. rho E cos(tilt) / pi, E = pi."""
    angle = np.radians(number("slanted_sun.tilt", tilt, 0, 89))
    rho = number("slanted_sun.albedo", albedo, 0, 1)
    sun = DirectionalLight(direction=(np.sin(angle), -np.cos(angle), 0), irradiance=(np.pi,) * 3)
    return ClosedForm(
        row=14,
        quantity="radiance of a Lambertian floor in the sun",
        value=rho * float(np.cos(angle)),
        scene=_floor(rho, sun, "slanted_sun"),
        bounces=0,
        tolerance=1e-5,
        reason="exact; the tolerance is that of sums in float32",
    )


def cosine_sky() -> ClosedForm:
    """Row 15. 2 pi / 3 under L = max(0, cos)."""
    rows = 256
    cosine = np.cos((np.arange(rows) + 0.5) * (np.pi / rows))
    image = np.broadcast_to(np.maximum(0, cosine)[:, None, None], (rows, 2 * rows, 3)).astype(np.float32)
    return ClosedForm(
        row=15,
        quantity="irradiance that faces a sky of radiance max(0, cos)",
        value=2 * np.pi / 3,
        scene=_floor(RHO, EnvironmentLight(image=image), "cosine_sky"),
        bounces=0,
        scale=np.pi / RHO,
        reason="a sky image of 256 rows",
    )


def reconstructed_sun(angle: float = 0) -> ClosedForm:
    """Row 16. 1/4 + c/2 + (5/32) (3 c^2 - 1), c = cos(angle): the clamped cosine of a unit sun in three bands."""
    degrees = number("reconstructed_sun.angle", angle, 0, 180)
    c = float(np.cos(np.radians(degrees)))
    sun = DirectionalLight(direction=(float(np.sin(np.radians(degrees))), -c, 0), irradiance=(1, 1, 1))
    return ClosedForm(
        row=16,
        quantity="irradiance that three bands of spherical harmonics give a floor turned by `angle` from a unit sun",
        value=1 / 4 + c / 2 + 5 / 32 * (3 * c * c - 1),
        scene=_floor(RHO, sun, "reconstructed_sun"),
        bounces=0,
        scale=np.pi / RHO,
        transport="spherical harmonics",
        tolerance=1e-5,
        reason="exact; the tolerance is that of sums in float32",
    )


def white_metal(alpha: float = 1) -> ClosedForm:
    """Row 17. 1 - ln 2 for alpha = 1: GGX, F = 1, height-correlated Smith, normal view; other alpha by quadrature."""
    a = number("white_metal.alpha", alpha, 0.05, 1)
    metal = Material(name="floor", albedo=(0, 0, 0), specular=(1, 1, 1), roughness=np.sqrt(a))
    return ClosedForm(
        row=17,
        quantity="albedo of a white GGX metal at normal view, by its radiance under a white sky",
        value=float(1 - np.log(2)) if a == 1 else _ggx_albedo(a),
        scene=_with_floor(metal, EnvironmentLight(), "white_metal"),
        bounces=0,
        reason=NARROW,
    )


def _ggx_albedo(alpha: float) -> float:
    """Integral of D G2 / (4 cos_o cos_i) cos_i over incident directions, view along the normal, by the half vector's angle."""
    nodes, weights = np.polynomial.legendre.leggauss(256)
    # u = the distribution's own cumulative, so that sharp lobes need no more nodes: D cos sin dtheta 2 pi = du.
    u = 0.5 * (nodes + 1)
    cos2 = (1 - u) / (1 + (alpha**2 - 1) * u)
    cos_i = 2 * cos2 - 1
    lit = np.maximum(cos_i, 1e-12)
    smith = np.sqrt(lit**2 + alpha**2 * (1 - lit**2))
    # 4 cos_h dw_h = dw_i at normal view, and G2 / (4 cos_i) = 1 / (2 (cos_i + smith)).
    integrand = np.where(cos_i > 0, 2 * lit / (lit + smith), 0)
    return float(np.sum(0.5 * weights * integrand))


def _floor(albedo: float, light: Light, name: str, blocker: Shape | None = None, eye: float = 0.5) -> Scene:
    return _with_floor(Material(name="floor", albedo=(albedo,) * 3), light, name, blocker, eye)


def _with_floor(material: Material, light: Light, name: str, blocker: Shape | None = None, eye: float = 0.5) -> Scene:
    floor = quad((-10, 0, 10), (20, 0, 0), (0, 0, -20))
    meshes = [mesh(floor, material)] + ([] if blocker is None else [mesh(blocker, BLACK)])
    return Scene(name=name, meshes=meshes, lights=[light], cameras={"view": point_camera((0, 0, 0), distance=eye)})
