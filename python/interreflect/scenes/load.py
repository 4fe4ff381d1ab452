"""`load_scene`: a scene.toml or a geometry file as a Scene. With the readers beside it the only place that reads untrusted bytes."""

from __future__ import annotations

import os
from pathlib import Path

from interreflect.errors import SceneError
from interreflect.scenes.files import EXTENSIONS, Folder, shown
from interreflect.scenes.scene import Scene
from interreflect.scenes.scene_cache import cached, keep


def load_scene(path: str | os.PathLike[str]) -> Scene:
    """A scene.toml, or a plain .obj, .ply, .gltf or .glb.

    Looked for as given, then below the folder INTERREFLECT_SCENES, then below ../shared/scenes (of the working folder and of
    the project). What was dropped or replaced stands in `scene.warnings`.

    Raises FileNotFoundError with the paths tried; SceneError with file and key or line for anything malformed.
    """
    found = find(path)
    extension = os.path.splitext(found)[1].lower()
    if extension != ".toml" and extension not in EXTENSIONS:
        raise SceneError(f"{shown(found)}: must be one of .toml, {', '.join(EXTENSIONS)}, got {extension!r}")
    scene = cached(found)
    if scene is None:
        folder = Folder.of(found)
        scene = read_scene(found, folder)
        keep(found, scene, folder)
    return scene


def read_scene(path: str, folder: Folder | None = None) -> Scene:
    """The scene as its files say now; `folder` learns which files those are."""
    from interreflect.scenes.assemble import assembled  # not needed for a scene that was kept
    from interreflect.scenes.manifest import Geometry, Manifest, read_manifest
    from interreflect.scenes.mesh import IDENTITY

    folder = folder or Folder.of(path)
    if path.lower().endswith(".toml"):
        return assembled(read_manifest(path, folder), folder)
    stem = os.path.splitext(os.path.basename(path))[0]
    geometry = Geometry(shown(path), os.path.realpath(path), None, IDENTITY, "file", "world")
    return assembled(Manifest(shown(path), stem, 1.0, (0.0, 1.0, 0.0), [geometry], {}, {}, []), folder)


def find(path: str | os.PathLike[str]) -> str:
    """The file that `path` names; FileNotFoundError with the paths tried."""
    name = os.fspath(path)
    tried = []
    for candidate in [name, *(os.path.join(folder, name) for folder in scene_folders() if not os.path.isabs(name))]:
        absolute = os.path.abspath(candidate)
        if absolute in tried:
            continue
        if os.path.isfile(absolute):
            return absolute
        tried.append(absolute)
    raise FileNotFoundError(f"no scene {name!r}; tried {', '.join(tried)}")


def scene_folders() -> list[str]:
    """Where scenes are looked for by name, first to last; not all need exist."""
    project = Path(__file__).resolve().parents[3]
    given = os.environ.get("INTERREFLECT_SCENES")
    return [*([given] if given else []), os.path.join("..", "shared", "scenes"), str(project.parent / "shared" / "scenes")]
