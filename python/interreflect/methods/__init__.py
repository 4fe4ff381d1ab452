"""Methods: compositions of stages that turn a scene and a camera into a frame. One file each, readable as the paper's pipeline figure."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

_HOMES = {
    "AmbientOcclusion": "ambient_occlusion",
    "ClusteredRadianceCaching": "clustered_radiance_caching",
    "ConstantAmbient": "constant_ambient",
    "IlluminanceComposition": "illuminance_composition",
    "LightPropagationVolumes": "light_propagation_volumes",
    "PathTracing": "path_tracing",
    "PathTracingDenoised": "path_tracing_denoised",
    "VirtualAreaLights": "virtual_area_lights",
    "VoxelConeTracing": "voxel_cone_tracing",
}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"interreflect.methods.{_HOMES[name]}"), name)
    raise AttributeError(f"there is no method {name!r}; the methods are {', '.join(_HOMES)}")


def __dir__() -> list[str]:
    return sorted(_HOMES)


if TYPE_CHECKING:
    from interreflect.methods.ambient_occlusion import AmbientOcclusion as AmbientOcclusion
    from interreflect.methods.clustered_radiance_caching import ClusteredRadianceCaching as ClusteredRadianceCaching
    from interreflect.methods.constant_ambient import ConstantAmbient as ConstantAmbient
    from interreflect.methods.illuminance_composition import IlluminanceComposition as IlluminanceComposition
    from interreflect.methods.light_propagation_volumes import LightPropagationVolumes as LightPropagationVolumes
    from interreflect.methods.path_tracing import PathTracing as PathTracing
    from interreflect.methods.path_tracing_denoised import PathTracingDenoised as PathTracingDenoised
    from interreflect.methods.virtual_area_lights import VirtualAreaLights as VirtualAreaLights
    from interreflect.methods.voxel_cone_tracing import VoxelConeTracing as VoxelConeTracing
