"""Few paths a pixel and Open Image Denoise: the baseline that a real-time method has to beat."""

from __future__ import annotations

from collections.abc import Collection
from typing import ClassVar

import numpy as np

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.denoiser import denoiser_for
from interreflect.methods.knobs import knob
from interreflect.methods.method import Method, method
from interreflect.methods.path_tracing import PathTracing
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import core_camera

# As PathTracing.pattern. 4 has 1.1 to 1.5 times the error; 16 traces a fifth longer for 0 (atrium) to 14 % (Cornell box) less.
_PATTERN = 8
_LEAST_REFLECTANCE = 0.05  # below it, dividing by the reflectance would turn rounding into light


@method
class PathTracingDenoised(Method):
    """Path tracing with few samples, denoised with the G-buffer's albedo and normals as guides, after Áfra's Open Image Denoise.

    As strong as it can honestly be made: emission and delta lights have no noise and are kept as they are, only the rest is denoised.
    Dividing that rest by the surface's reflectance first was tried and lost. With `scale` below 1 it is traced and denoised at a smaller
    size and its irradiance scaled up; all else stays at full size. The picture is denoised once: its noisy part is given to direct and
    indirect light in the proportion that blocks of 8 x 8 pixels of the noisy picture have.

    ImportError where Open Image Denoise is absent: it comes with the extra `denoise`.
    """

    spp: int = knob(default=1, doc="paths a pixel of the traced picture", minimum=1)
    bounces: int | None = knob(default=1, doc="indirect bounces; None: all", minimum=0, optional=True)
    quality: str = knob(default="fast", doc="of the denoiser", choices=("fast", "balanced", "high"))
    scale: float = knob(default=1.0, doc="side of the traced picture as a share of the frame's", minimum=0.1, maximum=1.0)

    own_stages: ClassVar = ("path_trace", "denoise")

    def exactly(self, stages: Collection[str], samples: int) -> Method:
        """Exact denoising is none, at full size."""
        spp = max(self.spp, samples) if "path_trace" in stages else self.spp
        return PathTracing(spp=spp, bounces=self.bounces, pattern=_PATTERN) if "denoise" in stages else self.replace(spp=spp)

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        width, height = view.size
        small = max(1, round(width * self.scale)), max(1, round(height * self.scale))
        denoiser = denoiser_for(small, self.quality, _core.thread_limit())
        camera = core_camera(view.camera)
        with profile.stage("gbuffer") as note:
            gbuffer = note(_core.trace_gbuffer(view.scene.core, camera, width, height))
            guide = gbuffer if small == view.size else note(_core.trace_gbuffer(view.scene.core, camera, *small))
        with profile.stage("path_trace") as note:
            traced = note(self._trace(view, small, self.spp))
            certain = traced.certain if small == view.size else note(self._trace(view, view.size, 0)).certain
        with profile.stage("denoise"):
            sampled = traced.direct - traced.certain
            rest = denoiser(sampled + traced.indirect, guide.albedo, guide.normal)
        with profile.stage("shade"):
            share = direct_share(sampled, traced.indirect)
            if small != view.size:
                rest = resize(rest / _reflectance(guide), view.size) * _reflectance(gbuffer)
            direct_rest = rest * resize(share, view.size) if share.any() else np.float32(0)
        return certain + direct_rest, rest - direct_rest

    def _trace(self, view: View, size: tuple[int, int], samples: int) -> _core.PathTraced:
        camera = core_camera(view.camera)
        return _core.path_trace(view.scene.core, camera, *size, samples=samples, bounces=self.bounces, pattern=_PATTERN, seed=view.seed)


def _reflectance(gbuffer: _core.GBuffer) -> Image:
    reflectance: Image = np.maximum(gbuffer.albedo + gbuffer.specular, _LEAST_REFLECTANCE)
    return reflectance


def direct_share(direct: Image, indirect: Image) -> Image:
    """The share of direct light in blocks of 8 x 8 pixels: (ceil(height / 8), ceil(width / 8), 3)."""
    sums = [_block_sums(part) for part in (direct, indirect)]
    total = sums[0] + sums[1]
    share: Image = np.divide(sums[0], total, out=np.zeros_like(total), where=total > 0)
    return share


def _block_sums(image: Image, block: int = 8) -> Image:
    rows = np.add.reduceat(image, np.arange(0, image.shape[0], block), axis=0)
    sums: Image = np.add.reduceat(rows, np.arange(0, image.shape[1], block), axis=1)
    return sums


def resize(image: Image, size: tuple[int, int]) -> Image:
    """Bilinear between pixel centres, to (width, height)."""
    for axis, wanted in ((0, size[1]), (1, size[0])):
        place = np.clip((np.arange(wanted) + 0.5) * image.shape[axis] / wanted - 0.5, 0, image.shape[axis] - 1)
        first = np.minimum(place.astype(np.intp), max(image.shape[axis] - 2, 0))
        second = np.minimum(first + 1, image.shape[axis] - 1)
        weight = np.expand_dims((place - first).astype(np.float32), tuple(k for k in range(3) if k != axis))
        low = image.take(first, axis)
        image = low + (image.take(second, axis) - low) * weight
    return image
