"""The values a scene is made of, one file each; this page lists them."""

from interreflect.scenes.camera import Camera
from interreflect.scenes.lights import DirectionalLight, EnvironmentLight, Light, PointLight, SpotLight
from interreflect.scenes.material import Material
from interreflect.scenes.mesh import Mesh
from interreflect.scenes.scene import Scene
from interreflect.scenes.texture import Mask, Texture

__all__ = [
    "Camera",
    "DirectionalLight",
    "EnvironmentLight",
    "Light",
    "Mask",
    "Material",
    "Mesh",
    "PointLight",
    "Scene",
    "SpotLight",
    "Texture",
]
