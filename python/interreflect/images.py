"""Pictures to files: linear EXR and HDR, or 8 bits after one stated tone map. Written by OpenImageIO."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

LINEAR = (".exr", ".hdr")


def tone_map(image: NDArray[np.float32], exposure: float = 0.0, curve: str = "srgb") -> NDArray[np.uint8]:
    """(h, w, 3) linear radiance c, times 2^exposure, to bytes. Not-a-number shows magenta.

    curve: "srgb", clipped to [0, 1] and sRGB transfer curve; or "reinhard", c / (c + 1) and then its power of 1 / 2.2, as in
    Freed 2018, algorithm 3. ValueError for another.
    """
    if curve not in CURVES:
        raise ValueError(f"tone_map: curve must be one of {', '.join(CURVES)}, got {curve!r}")
    scaled = np.clip(np.nan_to_num(image, nan=0.0, posinf=1e30) * 2.0**exposure, 0, None)
    bytes_: NDArray[np.uint8] = np.round(255 * CURVES[curve](scaled)).astype(np.uint8)
    bytes_[np.isnan(image).any(-1)] = (255, 0, 255)
    return bytes_


def _srgb(scaled: NDArray[np.float32]) -> NDArray[np.float32]:
    clipped = np.minimum(scaled, 1)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)


def _reinhard(scaled: NDArray[np.float32]) -> NDArray[np.float32]:
    return (scaled / (scaled + 1)) ** np.float32(1 / 2.2)


CURVES = {"srgb": _srgb, "reinhard": _reinhard}


def encode_png(image: NDArray[np.float32], exposure: float = 0.0) -> bytes:
    """The tone-mapped picture as PNG bytes."""
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(tone_map(image, exposure)).save(out, "PNG")
    return out.getvalue()


def write_image(path: str | Path, image: NDArray[np.float32], exposure: float = 0.0, curve: str = "srgb") -> None:
    """Writes (h, w, 3) linear radiance; .exr and .hdr as float, other formats by `tone_map`. OSError where the file cannot be written."""
    import OpenImageIO as oiio

    path = Path(path)
    linear = path.suffix.lower() in LINEAR
    pixels = np.ascontiguousarray(image, np.float32) if linear else tone_map(image, exposure, curve)
    output = oiio.ImageOutput.create(str(path))
    if output is None:
        raise OSError(f"{path}: no image format has this extension")
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, "float" if linear else "uint8")
    if not (output.open(str(path), spec) and output.write_image(pixels) and output.close()):
        raise OSError(f"{path}: {output.geterror()}")
