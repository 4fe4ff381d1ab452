"""How a surface reflects, emits and is cut out."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from interreflect.scenes.checks import Vector, boolean, choice, nearest_name, number, text, vector
from interreflect.scenes.digest import digest
from interreflect.scenes.texture import Mask, Texture

LOBES = ("ggx", "phong", "blinn-phong")


@dataclass(frozen=True, kw_only=True)
class Material:
    """Lambert plus one glossy lobe. The lobes add and nothing rescales them: keep albedo + specular at most 1.

    albedo: diffuse reflectance, each in [0, 1]; multiplies `albedo_map`. Default 0.5, with a map 1.
    albedo_map: Texture or None.
    specular: reflectance at normal incidence of the glossy lobe, each in [0, 1]; 0: no lobe.
    roughness: of the glossy lobe in [0, 1], GGX alpha = roughness^2; default 0.5 where there is no exponent.
    exponent: of the Phong or Blinn-Phong lobe; for GGX, alpha = sqrt(2 / (exponent + 2)). One of the two.
    lobe: "ggx", or with an exponent "phong" or "blinn-phong".
    emission: radiance that leaves the front face (counter-clockwise), W/(m^2 sr); multiplies `emission_map`.
    emission_map: Texture or None.
    mask: Mask or None.
    two_sided: whether both faces reflect; emission is always one-sided.

    Raises ValueError that names the argument, its bound and its value.
    """

    albedo: Vector = None  # type: ignore[assignment]  # depends on the map: given below
    albedo_map: Texture | None = None
    specular: Vector = (0.0, 0.0, 0.0)
    roughness: float | None = None
    exponent: float | None = None
    lobe: str = "ggx"
    emission: Vector = (0.0, 0.0, 0.0)
    emission_map: Texture | None = None
    mask: Mask | None = None
    two_sided: bool = True
    name: str = ""

    def __post_init__(self) -> None:
        for key, kind in (("albedo_map", Texture), ("emission_map", Texture), ("mask", Mask)):
            value = getattr(self, key)
            if value is not None and not isinstance(value, kind):
                raise ValueError(f"{key} must be a {kind.__name__} or None, got {type(value).__name__}")
        if self.albedo is None:
            self._set("albedo", (1.0, 1.0, 1.0) if self.albedo_map is not None else (0.5, 0.5, 0.5))
        self._set("albedo", vector("albedo", self.albedo, 0, 1))
        self._set("specular", vector("specular", self.specular, 0, 1))
        self._set("emission", vector("emission", self.emission, 0))
        if self.roughness is not None and self.exponent is not None:
            raise ValueError(f"only one of roughness and exponent may be given, got {self.roughness} and {self.exponent}")
        if self.exponent is not None:
            self._set("exponent", number("exponent", self.exponent, 0, open_low=True))
        else:
            self._set("roughness", number("roughness", 0.5 if self.roughness is None else self.roughness, 0, 1))
        choice("lobe", self.lobe, LOBES)
        if self.lobe != "ggx" and self.exponent is None:
            raise ValueError(f"lobe {self.lobe!r} must have an exponent")
        self._set("two_sided", boolean("two_sided", self.two_sided))
        text("name", self.name)

    def _set(self, key: str, value: Any) -> None:
        object.__setattr__(self, key, value)

    def replace(self, **keys: Any) -> Material:
        """This material with other keys. An exponent replaces a roughness, a roughness an exponent and its lobe."""
        known = [field.name for field in fields(self)]
        for key in keys:
            if key not in known:
                raise TypeError(f"Material has no key {key!r}{nearest_name(key, known)}")
        values = {key: getattr(self, key) for key in known}
        if keys.get("exponent") is not None and "roughness" not in keys:
            values["roughness"] = None
        if keys.get("roughness") is not None and "exponent" not in keys:
            values["exponent"] = None
            values["lobe"] = "ggx"
        return Material(**{**values, **keys})

    @property
    def emits(self) -> bool:
        return max(self.emission) > 0

    @property
    def hash(self) -> str:
        """Digest of all keys but the name."""
        maps = tuple(None if m is None else m.hash for m in (self.albedo_map, self.emission_map, self.mask))
        lobe = (self.specular, self.roughness, self.exponent, self.lobe)
        return digest("material", self.albedo, lobe, self.emission, maps, self.two_sided)

    @property
    def reflection_hash(self) -> str:
        """Digest of all keys but the name and emission."""
        return self.replace(emission=(0, 0, 0), emission_map=None).hash
