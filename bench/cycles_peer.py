"""Cycles as a peer of the path tracer, in a Python of its own: its module wants another numpy."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from bench.mitsuba_peer import PeerMissing

VARIABLE = "INTERREFLECT_CYCLES_PYTHON"
SCRIPT = Path(__file__).with_name("cycles_render.py")


def renderer(scene: ir.Scene, camera: str, size: tuple[int, int], spp: int) -> Callable[[int], tuple[NDArray[np.float32], float]]:
    """seed -> (picture, milliseconds) by Cycles, one diffuse bounce. PeerMissing where the variable names no Python that has bpy."""
    python = os.environ.get(VARIABLE, "")
    if not python or subprocess.run([python, "-c", "import bpy"], capture_output=True, check=False).returncode != 0:
        raise PeerMissing(f"Cycles is not present: {VARIABLE} names no Python that has bpy")
    folder = tempfile.TemporaryDirectory()
    _export(scene, scene.cameras[camera], size, Path(folder.name) / "scene.npz")
    process = subprocess.Popen(
        [python, str(SCRIPT), folder.name, str(spp)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )

    def render(seed: int) -> tuple[NDArray[np.float32], float]:
        assert process.stdin is not None and process.stdout is not None and folder is not None
        print(seed, file=process.stdin, flush=True)
        for line in process.stdout:
            if line.startswith("milliseconds "):
                return np.load(Path(folder.name) / "picture.npy"), float(line.split()[1])
        raise RuntimeError(f"Cycles ended with exit code {process.wait()} instead of a picture")

    return render


def _export(scene: ir.Scene, camera: ir.Camera, size: tuple[int, int], path: Path) -> None:
    """The scene as plain arrays: a mesh, an albedo and perhaps a texture for each mesh; one sun, one constant sky."""
    arrays: dict[str, NDArray[np.generic]] = {
        "size": np.array(size),
        "fov_x": np.array(camera.fov_x),
        "meshes": np.array(len(scene.meshes)),
    }
    arrays |= {key: np.array(getattr(camera, key)) for key in ("position", "target", "up")}
    for light in scene.lights:
        if isinstance(light, ir.DirectionalLight):
            arrays |= {"sun_direction": np.array(light.direction), "sun_irradiance": np.array(light.irradiance)}
        elif isinstance(light, ir.EnvironmentLight) and light.image is None:
            arrays["sky"] = np.array(light.radiance)
        else:
            raise ValueError(f"the bench does not give {light!r} to Cycles")
    for k, mesh in enumerate(scene.meshes):
        place = scene.bodies[mesh.body] @ mesh.transform
        arrays[f"positions {k}"] = (mesh.positions @ place[:3, :3].T + place[:3, 3]).astype(np.float32)
        arrays[f"triangles {k}"], arrays[f"albedo {k}"] = mesh.triangles, np.array(mesh.material.albedo)
        if mesh.material.albedo_map is not None and mesh.texcoords is not None:
            arrays[f"texcoords {k}"], arrays[f"texture {k}"] = mesh.texcoords, mesh.material.albedo_map.pixels
    np.savez(path, **arrays)  # type: ignore[arg-type]
