"""Image files by OpenImageIO: colours as 8-bit sRGB or linear float, masks, radiance. Values as stored: no gamma tag is followed."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.files import Folder, shown
from interreflect.scenes.texture import Mask, Texture

MASK_THRESHOLD = 0.5


def read_texture(path: str, folder: Folder) -> Texture:
    """Colours: 8 bits stay sRGB, 16 bits are decoded from it, float stays linear."""
    pixels, _ = _read(path, folder)
    return Texture(_colours(path, pixels, folder.warnings))


def read_radiance(path: str, folder: Folder) -> NDArray[np.float32]:
    """(height, width, 3) float32, linear."""
    pixels, _ = _read(path, folder)
    colours = _colours(path, pixels, folder.warnings)
    return decoded(colours.astype(np.float32) / 255) if colours.dtype == np.uint8 else colours


def read_mask(path: str, folder: Folder, threshold: float = MASK_THRESHOLD) -> Mask:
    """Solid where the alpha channel, or the first where there is none, reaches `threshold`; not decoded."""
    pixels, alpha = _read(path, folder)
    return _mask(pixels[..., max(alpha, 0)], threshold)


def _mask(channel: NDArray[Any], threshold: float) -> Mask:
    return Mask(channel >= threshold * (np.iinfo(channel.dtype).max if channel.dtype.kind == "u" else 1))


def read_alpha_mask(path: str, folder: Folder, threshold: float) -> Mask | None:
    """As `read_mask`; None where there is no alpha channel."""
    pixels, alpha = _read(path, folder)
    return None if alpha < 0 else _mask(pixels[..., alpha], threshold)


def decoded(srgb: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
    """Linear values of sRGB ones in [0, 1] [IEC 61966-2-1]."""
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return linear.astype(np.float32)


def _colours(path: str, pixels: NDArray[Any], warnings: list[str]) -> NDArray[Any]:
    """(height, width, 3) uint8, or float32 without negative numbers."""
    colours = pixels[..., :3] if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, 2)
    if colours.dtype == np.uint16:
        return decoded(colours.astype(np.float32) / 65535)
    if colours.dtype.kind == "f":
        if not np.isfinite(colours).all():
            raise SceneError(f"{shown(path)}: holds numbers that are not finite")
        negative = int((colours < 0).any(2).sum())
        if negative:
            warnings.append(f"{shown(path)}: {negative} pixels below 0 raised to 0")
            colours = np.maximum(colours, 0)
    return np.ascontiguousarray(colours)


def _read(path: str, folder: Folder) -> tuple[NDArray[Any], int]:
    """(height, width, 1 to 4) uint8, uint16 or float32 as stored, and the number of the alpha channel or -1."""
    import OpenImageIO as oiio

    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", 1)  # colours as stored, not multiplied by alpha
    image = oiio.ImageInput.open(path, config)
    if image is None:
        raise SceneError(f"{shown(path)}: is no image that can be read: {_last_error(oiio)}")
    try:
        spec = image.spec()
        if spec.deep or spec.depth > 1 or min(spec.width, spec.height, spec.nchannels) < 1:
            raise SceneError(f"{shown(path)}: is no flat image")
        folder.count_pixels(path, spec.width * spec.height)
        kinds = {oiio.UINT8: np.uint8, oiio.UINT16: np.uint16}
        dtype = kinds.get(spec.format.basetype, np.float32)
        channels = min(spec.nchannels, 4)
        pixels = image.read_image(0, 0, 0, channels, np.dtype(dtype).name.replace("float32", "float"))
        if pixels is None:
            raise SceneError(f"{shown(path)}: cannot be read whole: {image.geterror()[:200]}")
        alpha = spec.alpha_channel if spec.alpha_channel < channels else -1
        return np.asarray(pixels, dtype).reshape(spec.height, spec.width, channels), alpha
    finally:
        image.close()


def _last_error(oiio: Any) -> str:
    lines: list[str] = oiio.geterror().splitlines()
    return lines[0][:200] if lines else "unknown format"
