"""Pictures of techniques and methods: what they render, the truth, and where the two differ. Kept in the cache by what makes them."""

from __future__ import annotations

import hashlib
import io
from typing import Any

import numpy as np
from matplotlib import colormaps
from PIL import Image

import interreflect as ir
from docs.generate.settings import SIZE, TRUTH, Setting
from interreflect import cache
from interreflect.images import tone_map
from interreflect.study.sources import source_digest

FORMAT = 1
EXPOSURE = {"cornell_box": 1.0, "atrium": -0.5}


def picture(setting: Setting) -> bytes:
    """Frame, truth and difference side by side, as PNG."""
    identity = (FORMAT, source_digest(type(setting.method)), repr(setting), setting.scene.hash, SIZE, TRUTH)
    path = cache.folder("docs") / f"{hashlib.sha256(repr(identity).encode()).hexdigest()[:32]}.png"
    if path.exists():
        cache.touch(path)
        return path.read_bytes()
    made = _encoded(panels(setting))
    cache.write(path, lambda file: file.write(made))
    return made


def panels(setting: Setting) -> np.ndarray[Any, Any]:
    frame, truth = setting.render(setting.method.prepare(setting.scene)), setting.truth()
    exposure = EXPOSURE.get(setting.scene_name.partition("(")[0], 0.0)
    shown = [tone_map(image, exposure) for image in (frame.image, truth.image)]
    return np.hstack([*shown, heat(getattr(frame, setting.part), getattr(truth, setting.part))])


def heat(image: Any, truth: Any) -> np.ndarray[Any, Any]:
    """Relative squared error on a logarithmic scale: black is a ten-thousandth or less, bright is 1 or more."""
    shade = np.clip(np.log10(ir.metrics.error_map(image, truth) + 1e-9) / 4 + 1, 0, 1)
    return (255 * colormaps["inferno"](shade)[..., :3]).astype(np.uint8)


def _encoded(image: np.ndarray[Any, Any]) -> bytes:
    out = io.BytesIO()
    Image.fromarray(image).save(out, "PNG", optimize=True)
    return out.getvalue()
