"""Stages by hand: the core's functions for the values a user holds. Each takes a technique first and returns plain data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.scenes.camera import Camera, checked_size
from interreflect.scenes.lights import DirectionalLight
from interreflect.scenes.scene import Scene
from interreflect.scenes.unwrap import unwrap


def camera_of(scene: Scene, camera: Camera | str | None) -> Camera:
    """The camera itself, the scene's camera of that name, or its first. KeyError-like ValueError names those there are."""
    if isinstance(camera, Camera):
        return camera
    if camera is None:
        return scene.camera
    if camera in scene.cameras:
        return scene.cameras[camera]
    raise ValueError(f"scene {scene.name!r} has no camera {camera!r}; it has {', '.join(scene.cameras) or 'none'}")


def core_camera(camera: Camera) -> _core.Camera:
    return _core.Camera(camera.position, camera.target, camera.up, camera.fov_x)


def trace_gbuffer(
    scene: Scene, camera: Camera | str | None = None, size: tuple[int, int] | None = None, shade: Any = None
) -> _core.GBuffer:
    """What the camera sees through pixel centres: position, normal, albedo, ... as (height, width, ...) views, no copies.

    shade: the technique by which its surfaces reflect in `shadow`, `sky`, `glossy` and `shade`; None: Exact.
    """
    view = camera_of(scene, camera)
    width, height = view.size if size is None else checked_size(size)
    return _core.trace_gbuffer(scene.core, core_camera(view), width, height, _core.Exact() if shade is None else shade)


def shadow_maps(technique: Any, scene: Scene) -> _core.ShadowMaps | None:
    """Depth seen from every point, spot and directional light, which all that they light can share; None but for ShadowMap."""
    return _core.shadow_maps(technique, scene.core) if isinstance(technique, _core.ShadowMap) else None


def shadow(
    technique: Any, scene: Scene, gbuffer: _core.GBuffer, seed: int = 0, pyramids: Sequence[_core.Pyramid] = (),
    maps: _core.ShadowMaps | None = None,
) -> _core.DirectLight:  # fmt: skip
    """Light of point, spot and directional lights and of emitters, reflected once at the pixels: `.radiance` (height, width, 3).
    VoxelCones needs the voxels' pyramids; what several let through is multiplied. maps: of `shadow_maps`; None: ShadowMap makes its own."""
    if isinstance(technique, _core.VoxelCones):
        if not pyramids:
            raise ValueError("VoxelCones needs the voxels to march through: shadow(..., pyramids=[prefilter(...)])")
        return _core.cone_shadow(technique, scene.core, gbuffer, list(pyramids), seed)
    if maps is not None:
        return _core.shadow(technique, scene.core, gbuffer, maps, seed)
    return _core.shadow(technique, scene.core, gbuffer, seed)


def lamp_shadow(
    technique: Any, scene: Scene, gbuffer: _core.GBuffer, seed: int = 0, maps: _core.ShadowMaps | None = None
) -> _core.DirectLight:
    """`shadow` without emitters: what point, spot and directional lights send alone."""
    if maps is not None:
        return _core.lamp_shadow(technique, scene.core, gbuffer, maps, seed)
    return _core.lamp_shadow(technique, scene.core, gbuffer, seed)


def sky(technique: Any, scene: Scene, gbuffer: _core.GBuffer, seed: int = 0, gathered: Any = None, glossy: Any = None) -> _core.DirectLight:
    """Light of the environment, reflected once at the pixels. ConeSky takes it from what the march's cones left open:
    `gathered` and `glossy`."""
    if isinstance(technique, _core.ConeSky):
        if gathered is None:
            raise ValueError("ConeSky needs what the march gathered: sky(..., gathered=march(...))")
        return _core.cone_sky(gbuffer, gathered, glossy)
    return _core.sky(technique, scene.core, gbuffer, seed)


def place(grid: _core.Grid, scene: Scene, camera: Camera | str | None = None, size: tuple[int, int] | None = None) -> _core.Domain:
    """The domain of a grid. Warps, cascades and some regions need the camera (None: the scene's first), view volumes the picture's
    size too (None: the camera's). ValueError for a box without extent, far not beyond near, cascades with a warp."""
    view = camera_of(scene, camera) if camera is not None or scene.cameras else None
    if view is None:
        return _core.place(grid, scene.core)
    width, height = view.size if size is None else checked_size(size)
    return _core.place(grid, scene.core, core_camera(view), width / height)


def _number_of(scene: Scene, body: str) -> int:
    """As the core numbers bodies: the world is 0. ValueError names those there are."""
    if body not in scene.bodies:
        raise ValueError(f"scene {scene.name!r} has no body {body!r}; it has {', '.join(scene.bodies)}")
    return list(scene.bodies).index(body)


def body_domain(scene: Scene, body: str, voxel_size: float) -> _core.Domain:
    """Evenly spread voxels about a body in its own space, where its pose is the identity; the outermost ones are air.

    Voxels are larger than asked for where that would take more than 1024 of them. ValueError for a body without triangles."""
    _number_of(scene, body)
    boxes = [box for mesh in scene.meshes if mesh.body == body and (box := mesh.bounds(mesh.transform)) is not None]
    if not boxes:
        raise ValueError(f"body {body!r} of scene {scene.name!r} has no triangles")
    lower, upper = np.min([box[0] for box in boxes], 0), np.max([box[1] for box in boxes], 0)
    size = max(voxel_size, float((upper - lower).max()) / 1021)
    # At least half a voxel and the whole one around it lie between the surface and each face.
    cells = np.ceil((upper - lower) / size - 1e-3).astype(int) + 3
    corner = 0.5 * (lower + upper) - 0.5 * size * cells
    return _core.Domain(lower=tuple(corner), voxel_size=size, cells=tuple(int(n) for n in cells))


def voxelize(technique: Any, scene: Scene, domain: _core.Domain, body: str | None = None) -> _core.VoxelGrid:
    """Which cells the scene's surface passes through, and what it looks like there.

    body: only that body's surface, in its own space, where the domain must lie too; "world": only that of what stands still."""
    if body is None:
        return _core.voxelize(technique, scene.core, domain)
    return _core.voxelize(technique, scene.core, domain, _number_of(scene, body), scene.bodies[body])


def move_voxels(voxels: _core.VoxelGrid, scene: Scene, body: str) -> _core.VoxelGrid:
    """A body's voxels where the scene has that body: nothing is voxelized anew. They may be a copy's, of which `body` is another."""
    return voxels.moved(_number_of(scene, body), scene.bodies[body])


def light_voxels(
    technique: Any, scene: Scene, voxels: _core.VoxelGrid, seed: int = 0, history: Any = None, others: Sequence[_core.VoxelGrid] = ()
) -> _core.LitVoxels:
    """The radiance that each voxel reflects. history: what `light_history` kept of the last frame, for BlendHistory and Bounces.
    others: voxels of the scene's other parts, through which ConeLighting's cones pass too."""
    return _core.light_voxels(technique, scene.core, voxels, seed, history, list(others))


def holds_all_bounces(technique: Any) -> bool:
    """Whether voxels lit by this technique come to hold light of all bounces, from frame to frame."""
    held = technique.light_voxels if isinstance(technique, _core.BlendHistory) else technique
    return isinstance(held, _core.Bounces)


def light_history(technique: Any, pyramid: _core.Pyramid) -> Any:
    """What `light_voxels` wants of this frame in the next one: the pyramid for Bounces, its voxels for BlendHistory, else None."""
    if holds_all_bounces(technique):
        return pyramid
    return pyramid.lit if isinstance(technique, _core.BlendHistory) else None


def prefilter(technique: Any, lit: _core.LitVoxels) -> _core.Pyramid:
    """Radiance and opacity of ever larger voxels."""
    return _core.prefilter(technique, lit)


def _several(pyramids: _core.Pyramid | Sequence[_core.Pyramid]) -> list[_core.Pyramid]:
    return [pyramids] if isinstance(pyramids, _core.Pyramid) else list(pyramids)


def march(
    technique: Any,
    pyramids: _core.Pyramid | Sequence[_core.Pyramid],
    gbuffer: _core.GBuffer,
    scene: Scene,
    share: Any = None,
    seed: int = 0,
) -> _core.GatheredLight:
    """Light that arrives at the pixels over the hemisphere: `.irradiance` from voxels, `.sky` from the environment, `.occlusion`.

    pyramids: the scene's voxels, or those of its parts: of what stands still and of bodies, where they are. What a cone sees in
    each is put in order by how far away it is [Rehfeld et al. 2014, 3.1]."""
    return _core.march(technique, _several(pyramids), gbuffer, scene.core, _core.EveryPixel() if share is None else share, seed)


def glossy(
    technique: Any, pyramids: _core.Pyramid | Sequence[_core.Pyramid], gbuffer: _core.GBuffer, scene: Scene, seed: int = 0
) -> _core.GlossyLight:
    """Light that the glossy lobe reflects towards the camera: `.radiance` from voxels, `.sky` from the environment. pyramids: as
    `march` takes them."""
    return _core.glossy(technique, _several(pyramids), gbuffer, scene.core, seed)


def distribute(technique: Any, gbuffer: _core.GBuffer, scene: Scene, history: _core.CachePlaces | None = None) -> _core.CachePlaces:
    """Where radiance caches stand: `.position`, `.normal`, `.tile`, and `.cluster`, the cache of each pixel's cluster (height, width).

    history: the last frame's places, for ReuseCaches."""
    return _core.distribute(technique, gbuffer, scene.core, history)


def fill(
    technique: Any, places: _core.CachePlaces, pyramids: _core.Pyramid | Sequence[_core.Pyramid], scene: Scene, seed: int = 0
) -> _core.FilledCaches:
    """The radiance that arrives at every cache, as hemisphere maps: `.texels` (n, resolution, resolution, 4). pyramids: as `march`
    takes them."""
    return _core.fill(technique, places, _several(pyramids), scene.core, seed)


def preconvolve(technique: Any, filled: _core.FilledCaches) -> _core.ConvolvedCaches:
    """Caches ready for lobes of every width."""
    return _core.preconvolve(technique, filled)


def interpolate(
    technique: Any,
    caches: _core.ConvolvedCaches | None,
    gbuffer: _core.GBuffer,
    scene: Scene,
    pyramids: _core.Pyramid | Sequence[_core.Pyramid],
    fill: Any = None,
    preconvolve: Any = None,
    seed: int = 0,
) -> _core.CacheLight:
    """Light that pixels get from caches: `.gathered` and `.glossy`, as `march` and `glossy` return them, and `.weight`.

    fill, preconvolve, pyramids: how pixels that no cache serves get one of their own (None: ConeFill, MipChain). Evaluated gives one to
    every pixel; for it `caches` may be None."""
    by = _core.ConeFill() if fill is None else fill
    convolve = _core.MipChain() if preconvolve is None else preconvolve
    return _core.interpolate(technique, caches, gbuffer, scene.core, by, convolve, _several(pyramids), seed)


def light_maps(scene: Scene, size: int = 512, emitter_views: int = 16, environment: Sequence[DirectionalLight] = ()) -> _core.LightMaps:
    """Reflective shadow maps of all lights: `.maps`, each with `.position`, `.normal`, `.flux`, `.area` (size, size[, 3]).

    Every point, spot and directional light, all emitters together and the environment together have size x size texels. Emitters are
    seen from `emitter_views` points on them; `environment`: directional lights that stand for it (`directional_lights`)."""
    suns = [_core.DirectionalLight(light.direction, light.irradiance) for light in environment]
    return _core.light_maps(scene.core, size, emitter_views, suns)


def bounce_maps(scene: Scene, lights: _core.VirtualLights, size: int = 512) -> _core.LightMaps:
    """What virtual lights see, each of them over its hemisphere: maps of their next bounce, size x size texels together."""
    return _core.bounce_maps(scene.core, lights, size)


def join_lights(lights: Sequence[_core.VirtualLights]) -> _core.VirtualLights:
    """The lights of several bounces as one list, without their clusters."""
    return lights[0] if len(lights) == 1 else _core.join_lights(list(lights))


def sample_lights(technique: Any, maps: _core.LightMaps, seed: int = 0) -> _core.VirtualLights:
    """Texels of the maps that become virtual lights, or seeds of their clusters: `.position`, `.normal`, `.flux`, `.area`."""
    return _core.sample_lights(technique, maps, seed)


def cluster_lights(
    technique: Any, seeds: _core.VirtualLights, maps: _core.LightMaps, history: _core.VirtualLights | None = None, seed: int = 0
) -> _core.VirtualLights:
    """Virtual lights that each stand for several texels: `.cluster`, every texel's light, map by map. history: the last frame's
    lights. ValueError where all weights of KMeans are 0."""
    return _core.cluster_lights(technique, seeds, maps, history, seed)


def scatter_points(technique: Any, scene: Scene) -> _core.SurfacePoints:
    """Points of a scene's surface for the maps of its virtual lights; they move with their bodies."""
    return _core.scatter_points(technique, scene.core)


def shadow_lights(
    technique: Any, lights: _core.VirtualLights, scene: Scene, points: _core.SurfacePoints | None = None
) -> _core.LightShadows:
    """What virtual lights see. points: of `scatter_points`, or None: scattered now. ValueError for more maps than fit into 4096^2
    texels."""
    return _core.shadow_lights(technique, lights, scatter_points(technique, scene) if points is None else points, scene.core)


def shade_lights(
    technique: Any,
    lights: _core.VirtualLights,
    shadows: _core.LightShadows,
    gbuffer: _core.GBuffer,
    scene: Scene,
    filter_shadows: Any = None,
    share: Any = None,
    seed: int = 0,
) -> _core.VirtualLight:
    """What pixels get from virtual lights: `.gathered.irradiance` and `.glossy.radiance`.

    filter_shadows: how shadows are looked up (None: SimpleLookup). share: which lights each pixel does itself (None: all)."""
    by = _core.SimpleLookup() if filter_shadows is None else filter_shadows
    return _core.light_pixels(technique, by, _core.EveryPixel() if share is None else share, lights, shadows, gbuffer, scene.core, seed)


# Of light volumes: the core's functions take what a user holds.
inject, geometry_volume, propagate, look_up = _core.inject, _core.geometry_volume, _core.propagate, _core.look_up


def place_surfels(technique: Any, scene: Scene) -> _core.Surfels:
    """Disks that stand for the scene's still surface: `.position`, `.normal` (n, 3), `.area` (n,). Bodies have none.

    They lie on the sides that see the front of something, where materials are two-sided on both; what is buried has none."""
    return _core.open_sides(_core.place_surfels(technique, scene.core), scene.core)


def cluster_surfels(technique: Any, surfels: _core.Surfels) -> _core.ClusteredSurfels:
    """A binary tree over surfels in post-order; `.surfels` come back in the order of its leaves."""
    return _core.cluster_surfels(technique, surfels)


def place_caches(
    technique: Any, scene: Scene, gbuffer: _core.GBuffer | None = None, about: Scene | None = None
) -> _core.CacheSites:
    """Where caches of incident radiance stand: `.position`, `.normal` (n, 3). PixelCaches needs the picture: `gbuffer`. about: the scene
    whose box a grid fills, with bodies that `scene` may lack."""
    box = (scene if about is None else about).core
    if isinstance(technique, _core.PixelCaches):
        if gbuffer is None:
            raise ValueError("PixelCaches needs the picture whose pixels it stands at: place_caches(..., gbuffer=...)")
        return _core.pixel_sites(gbuffer)
    if isinstance(technique, _core.LightMap):
        return _core.place_caches(technique, scene.core, box, unwrap(scene, technique.texels, technique.area_share))
    return _core.place_caches(technique, scene.core, box)


def link(
    technique: Any, sites: _core.CacheSites, surfels: _core.ClusteredSurfels, scene: Scene
) -> _core.CacheLinks | _core.LinkCandidates | None:
    """Which patches of surfels send light to each cache; None for AllSurfels, which stores nothing. FluxLinks: what `_core.choose_links`
    takes every frame's from."""
    return None if isinstance(technique, _core.AllSurfels) else _core.link(technique, sites, surfels, scene.core)


def surfel_pixels(surfels: _core.ClusteredSurfels, scene: Scene) -> _core.GBuffer:
    """Surfels as the pixels of a picture, row by row, for `shadow`, `sky` and `evaluate`."""
    return _core.surfel_pixels(surfels, scene.core)


def pull(surfels: _core.ClusteredSurfels, radiance: NDArray[np.float32], radiosity: bool = False) -> _core.NodeLight:
    """What every patch of surfels sends on: the sum of flux, or the mean radiosity. radiance: (..., 3) of each surfel."""
    return _core.pull(surfels, radiance, radiosity)


def used_caches(sites: _core.CacheSites, gbuffer: _core.GBuffer) -> NDArray[np.uint8]:
    """(caches,): 1 where some pixel interpolates from the cache, else 0."""
    return _core.used_caches(sites, gbuffer)


def light_caches(
    technique: Any,
    links: _core.CacheLinks | None,
    sites: _core.CacheSites,
    surfels: _core.ClusteredSurfels,
    light: _core.NodeLight,
    scene: Scene,
    chrominance_bands: int = 0,
    seed: int = 0,
    window: str = "none",
    used: NDArray[np.uint8] | None = None,
) -> _core.LightCaches:
    """Incident radiance of every cache, in spherical harmonics: the sum over its links, or for AllSurfels over surfels themselves.

    window: none, hanning or lanczos, over the bands. used: caches that anything reads (`used_caches`); the others may stay black."""
    if links is None:
        made = _core.sample_caches(technique, sites, surfels, light, chrominance_bands, scene.core, seed)
    else:
        made = _core.light_caches(links, light, technique.bands, chrominance_bands, used)
    _core.window_caches(made, window)
    return made


def evaluate(
    technique: Any,
    caches: _core.LightCaches | None,
    sites: _core.CacheSites,
    gbuffer: _core.GBuffer,
    scene: Scene,
    links: _core.CacheLinks | None = None,
    light: _core.NodeLight | None = None,
) -> _core.SurfelLight:
    """What pixels get from caches: `.gathered.irradiance` and `.glossy.radiance`. DirectLinks takes, in place of the caches' light, the
    links and what comes through them."""
    if isinstance(technique, _core.DirectLinks):
        if links is None or light is None:
            raise ValueError("DirectLinks needs links that are stored, and what comes through them: evaluate(..., links=..., light=...)")
        return _core.evaluate(technique, links, light, sites, gbuffer, scene.core)
    if caches is None:
        raise ValueError(f"{type(technique).__name__} needs the caches' light")
    return _core.evaluate(technique, caches, sites, gbuffer, scene.core)


def shade(gbuffer: _core.GBuffer, light: _core.GatheredLight, glossy: _core.GlossyLight | None = None) -> NDArray[np.float32]:
    """(height, width, 3): indirect light that leaves the pixels' surfaces towards the camera."""
    return _core.shade(gbuffer, light, glossy)


def techniques(stage: str) -> tuple[type, ...]:
    """Every technique of a stage. ValueError names the stages there are."""
    if stage not in _core.stages:
        raise ValueError(f"there is no stage {stage!r}; the stages are {', '.join(_core.stages)}")
    return tuple(_core.stages[stage]["techniques"])


def exact(technique: Any) -> Any:
    """The exact counterpart of a technique: its stage's slow, unapproximated one. ValueError for a stage without.

    Around another technique: of light without history, that of what it holds; of all bounces, all bounces of exact light.
    """
    if isinstance(technique, _core.BlendHistory):
        return exact(technique.light_voxels)
    if isinstance(technique, _core.Bounces):
        return technique.replace(light_voxels=exact(technique.light_voxels))
    for stage in type(technique).stages:
        counterpart = _core.stages[stage]["exact"]
        if counterpart is not None:
            return technique if isinstance(technique, counterpart) else counterpart()
    raise ValueError(f"{type(technique).__name__} belongs to {', '.join(type(technique).stages)}, which has no exact counterpart")
