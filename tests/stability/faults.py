"""Deliberate faults, one a stage and more, made by wrapping the stages that a method calls. Nothing in the product knows of them."""

from __future__ import annotations

import ctypes
from functools import partial
from importlib import import_module
from types import SimpleNamespace

import numpy as np

import interreflect as ir
from interreflect import _core, stages
from interreflect.stability.similar import similar

# Where a stage is called: those that make voxels where methods have them in common, the others in the method.
HOMES = ("interreflect.methods.voxel_scene", "interreflect.methods.voxel_cone_tracing")


def overwrite(view, values):
    """Writes through a read-only view into the core's memory."""
    values = np.ascontiguousarray(values, view.dtype)
    assert view.flags.c_contiguous and values.shape == view.shape
    ctypes.memmove(view.ctypes.data, values.ctypes.data, values.nbytes)


def after(stage, change):
    """A stage whose result is changed in place once it is there."""

    def faulty(*arguments, **keys):
        result = getattr(stages, stage)(*arguments, **keys)
        change(result, *arguments)
        return result

    return stage, faulty


def instead(stage, make):
    return stage, lambda *arguments, **keys: make(getattr(stages, stage), *arguments, **keys)


def is_noticed(monkeypatch, module, stage, faulty, error):
    """That a method of interreflect.methods passes while its stage is sound, and not once `faulty(stage, *arguments)` stands for it;
    `error()` in tolerances."""
    sound = error()
    assert sound <= 1, f"the sound stage fails already: {sound:.2f} of the tolerance"
    monkeypatch.setattr(f"interreflect.methods.{module}.{stage}", partial(faulty, getattr(stages, stage)))
    assert error() > 1


IMAGES = (
    "position", "normal", "geometric_normal", "albedo", "specular", "emission", "alpha", "depth", "offset", "triangle", "instance", "body",
)  # fmt: skip


def flipped_normals(gbuffer, *_):
    for name in ("normal", "geometric_normal"):
        overwrite(getattr(gbuffer, name), -getattr(gbuffer, name))


def mirrored(gbuffer, *_):
    for name in IMAGES:
        overwrite(getattr(gbuffer, name), getattr(gbuffer, name)[:, ::-1])


def cosine_dropped_at_voxels(lit, technique, scene, voxels, *_):
    (lamp,) = scene.lights
    away = np.asarray(lamp.position) - voxels.position
    cosine = np.einsum("ij,ij->i", voxels.normal, away) / np.linalg.norm(away, axis=1)
    overwrite(lit.radiance, lit.radiance / np.maximum(np.abs(cosine), 0.05)[:, None])


def half_light(lit, *_):
    overwrite(lit.radiance, lit.radiance / 2)


def clipped_at_1(lit, *_):
    overwrite(lit.radiance, np.minimum(lit.radiance, 1))


def darkened(gathered, *_):
    overwrite(gathered.irradiance, gathered.irradiance / np.pi)


def turned_round(gathered, *_):
    overwrite(gathered.irradiance, gathered.irradiance[:, ::-1])


def exchanged_rows(gathered, *_):
    pairs = gathered.irradiance.reshape(-1, 2, *gathered.irradiance.shape[1:])
    overwrite(gathered.irradiance, pairs[:, ::-1].reshape(gathered.irradiance.shape))


def lobe_halved(reflected, *_):
    overwrite(reflected.radiance, reflected.radiance / 2)


def unsnapped(place, grid, scene, camera=None, *more):
    """The grid follows the camera by parts of a voxel."""
    domain = place(grid, scene, camera, *more)
    lower = np.add(domain.lower, np.mod(camera.position, domain.voxel_size)) - domain.voxel_size / 2
    return _core.Domain(lower=[float(v) for v in lower], voxel_size=domain.voxel_size, cells=domain.cells)


def no_cosine_at_pixels(shadow, technique, scene, gbuffer, seed=0, pyramids=()):
    """Directional light without the receiver's cosine (45 degrees in the scene of the blade)."""
    return SimpleNamespace(radiance=shadow(technique, scene, gbuffer, seed, pyramids).radiance * np.float32(np.sqrt(2)))


def unshadowed(shadow, technique, scene, gbuffer, seed=0, pyramids=()):
    meshes = [mesh for mesh in scene.meshes if max(mesh.material.albedo) > 0]
    bare = ir.Scene(meshes=meshes, lights=scene.lights, cameras=scene.cameras)
    return shadow(technique, bare, gbuffer, seed, pyramids)


def half_light_source(shadow, technique, scene, gbuffer, seed=0, pyramids=()):
    """The emitter taken for a quarter of its area: a penumbra half as wide, at the same power."""

    def narrowed(mesh):
        strong = mesh.material.replace(emission=tuple(4 * e for e in mesh.material.emission))
        return ir.Mesh(mesh.positions * np.float32((0.5, 1, 0.5)), mesh.triangles, material=strong)

    meshes = [narrowed(mesh) if mesh.material.emits else mesh for mesh in scene.meshes]
    return shadow(technique, ir.Scene(meshes=meshes, lights=scene.lights), gbuffer, seed, pyramids)


class Stale:
    """Voxels lit in the first frame are used in every later one: a history that is never refreshed."""

    def __init__(self):
        self.lit = None

    def __call__(self, light_voxels, technique, scene, voxels, seed=0, **keys):
        if self.lit is None:
            self.lit = light_voxels(technique, scene, voxels, seed)
        return self.lit


# name -> stage and its faulty version
FAULTS = {
    "normals of the G-buffer flipped": after("trace_gbuffer", flipped_normals),
    "G-buffer mirrored": after("trace_gbuffer", mirrored),
    "grid not snapped to voxels": instead("place", unsnapped),
    "axes of the voxels exchanged": instead("voxelize", lambda f, technique, scene, domain: f(technique, similar(scene, turn=90), domain)),
    "cosine dropped at voxels": after("light_voxels", cosine_dropped_at_voxels),
    "half the light in voxels": after("light_voxels", half_light),
    "voxels clipped at 1": after("light_voxels", clipped_at_1),
    "stale history": ("light_voxels", None),  # a state of its own for every test: see `faulty`
    "mip of half the weight": instead("prefilter", lambda f, technique, lit: f(_core.VolumeCoverage(), lit)),
    "march divided by pi twice": after("march", darkened),
    "march mirrored": after("march", turned_round),
    "rows of the march exchanged": after("march", exchanged_rows),
    "cones in steps of absolute length": instead(
        "march",
        lambda f, t, all_, *rest, **keys: f(t.replace(normal_offset=min(8.0, 0.05 / all_[0].domain.voxel_size)), all_, *rest, **keys),
    ),
    "seed depends on threads": instead("march", lambda f, *a, seed, **keys: f(*a, **keys, seed=seed + _core.thread_limit())),
    "lobe halved": after("glossy", lobe_halved),
    "cosine dropped at pixels": instead("shadow", no_cosine_at_pixels),
    "no shadows": instead("shadow", unshadowed),
    "light of half the width": instead("shadow", half_light_source),
    "sky twice as bright": instead("sky", lambda f, *a, **k: SimpleNamespace(radiance=2 * f(*a, **k).radiance)),
    "sky never hidden": instead("sky", lambda f, t, scene, g, *a, **k: SimpleNamespace(radiance=np.asarray(g.albedo) * np.float32(1))),
    "albedo applied twice": instead("shade", lambda f, gbuffer, *rest: f(gbuffer, *rest) * np.asarray(gbuffer.albedo)),
}


class _Core:
    """The compiled core with some functions replaced."""

    def __init__(self, **functions):
        self.__dict__.update(functions)

    def __getattr__(self, name):
        return getattr(_core, name)


def one_bounce_less(*arguments, bounces, **keys):
    return _core.path_trace(*arguments, bounces=max(bounces - 1, 0), **keys)


def guides_mirrored(denoiser_for):
    def made(*arguments):
        denoise = denoiser_for(*arguments)
        return lambda color, albedo, normal: denoise(color, np.ascontiguousarray(albedo[:, ::-1]), np.ascontiguousarray(normal[:, ::-1]))

    return made


def plant(patch, name):
    """Plants a fault by a pytest MonkeyPatch."""
    if name == "one bounce less":
        patch.setattr("interreflect.methods.path_tracing._core", _Core(path_trace=one_bounce_less))
    elif name == "guides of the denoiser mirrored":
        from interreflect.methods import path_tracing_denoised

        patch.setattr(path_tracing_denoised, "denoiser_for", guides_mirrored(path_tracing_denoised.denoiser_for))
    else:
        stage, faulty = FAULTS[name]
        home = next(home for home in map(import_module, HOMES) if hasattr(home, stage))
        patch.setattr(home, stage, instead(stage, Stale())[1] if faulty is None else faulty)
