"""Open Image Denoise, kept warm: one filter for each size, quality and number of threads, with the images it reads and writes."""

from __future__ import annotations

import threading
from functools import lru_cache
from typing import Any

import numpy as np

from interreflect.frame import Image


def _library() -> Any:
    try:
        import pyoidn
    except ImportError as missing:
        raise ImportError("Open Image Denoise is not installed: pip install 'interreflect[denoise]'") from missing
    return pyoidn


class Denoiser:
    """Call it with a noisy picture, albedo and normals, (height, width, 3) float32; returns the denoised picture."""

    def __init__(self, size: tuple[int, int], quality: str, threads: int) -> None:
        oidn = _library()
        self._device = oidn.Device(oidn.OIDN_DEVICE_TYPE_CPU)
        if threads > 0:
            self._device.set_int("numThreads", threads)
        self._device.set_bool("setAffinity", False)
        self._device.commit()
        self._filter = oidn.Filter(self._device, oidn.OIDN_FILTER_TYPE_RT)
        self._images = {name: np.zeros((size[1], size[0], 3), np.float32) for name in ("color", "albedo", "normal", "output")}
        for name, image in self._images.items():
            self._filter.set_image(name, image, oidn.OIDN_FORMAT_FLOAT3)
        self._filter.set_bool("hdr", True)
        self._filter.set_bool("cleanAux", quality == "high")  # the guides have no noise; lower qualities have no network for that
        self._filter.set_quality(getattr(oidn, f"OIDN_QUALITY_{quality.upper()}"))
        self._filter.commit()
        self._lock = threading.Lock()  # its images serve one picture at a time
        self._check()

    def _check(self) -> None:
        error = self._device.get_error()
        if error is not None:
            raise RuntimeError(f"Open Image Denoise failed: {error}")

    def __call__(self, color: Image, albedo: Image, normal: Image) -> Image:
        with self._lock:
            for name, image in (("color", color), ("albedo", albedo), ("normal", normal)):
                np.copyto(self._images[name], image)
            self._filter.execute()
            self._check()
            return self._images["output"].copy()


@lru_cache(maxsize=8)
def denoiser_for(size: tuple[int, int], quality: str, threads: int) -> Denoiser:
    """The denoiser of these settings; its first use loads and prepares the network. threads: 0: all. ImportError without the library."""
    return Denoiser(size, quality, threads)
