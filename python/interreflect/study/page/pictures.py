"""Pictures of a page: beside each other with exposure, flip and slider, and their error maps on one scale."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
import numpy.typing as npt

from interreflect import charts, metrics
from interreflect.study.page import asset
from interreflect.study.page.parts import inline, script_data
from interreflect.study.records import Record, Records

Floats = npt.NDArray[np.floating]

# Radiance over the truth's mean, as log2(v + 2^LOW) in ten bits: steps of 1.2 %, whose square is a tenth of the smallest error shown.
LOW, HIGH = -10.0, 8.0
SMALL = (320, 180)  # to which pictures shrink where the page would grow too large
LIMIT = 8  # pictures a view


def comparison(records: Records, most_bytes: int) -> str:
    """Every view's pictures beside their truth; smaller, then fewer, where they would take more than `most_bytes`."""
    for limit, size in ((LIMIT, None), (LIMIT, SMALL), (LIMIT // 2, SMALL), (2, SMALL), (2, (160, 90))):
        views = [_view(records, title, picked, size) for title, picked in charts.pictured(records, limit) if picked]
        body = "".join(_block(k, view) for k, view in enumerate(views))
        content = script_data("pictures", {"views": views, "low": LOW, "high": HIGH, "grey": metrics.MIDDLE_GREY, "ramp": _ramp()})
        if len(content) + len(body) <= most_bytes:
            break
    else:
        return f"<p>The pictures of {len(views)} views do not fit the page.</p>"
    if not views:
        return "<p>No pictures were kept.</p>"
    low, high = charts.ERROR_RANGE
    words = (
        f"Two pictures on one stage: drag or use the slider; on the stage, space flips, 1 to 9 choose the right picture, e shows "
        f"errors, + and - expose. Exposure 0 brings the truth's mean to middle grey. Error maps: relative squared error of a pixel, "
        f"{low:g} (black) to {high:g} (white), one scale everywhere."
    )
    return f'<p class="words">{words}</p>{body}{content}<script type="module">\n{asset("pictures.js")}</script>'


def _view(records: Records, title: Any, picked: Sequence[Record], size: tuple[int, int] | None) -> dict[str, Any]:
    whole = records.truth(picked[0])[0]
    factor = 1 if size is None else max(1, math.ceil(whole.shape[1] / size[0]), math.ceil(whole.shape[0] / size[1]))
    mean = float(whole.mean(dtype=np.float64)) or 1.0
    words = f"its own relMSE {picked[0].noise:.1e}"
    pictures = [{"name": "truth", "words": words, "light": stored(shrunk(whole, factor) / mean), "error": None}]
    for record in picked:
        image = records.images(record)[0]
        words = f"{record.milliseconds:.4g} ms, relMSE {record.metrics['relmse']:.2e}, FLIP {record.metrics['flip']:.3f}"
        pictures.append({
            "name": charts.label(records, record.row()),
            "words": words,
            "light": stored(shrunk(image, factor) / mean),
            "error": _webp(error_levels(shrunk(metrics.error_map(image, whole), factor))),
        })  # fmt: skip
    height, width = shrunk(whole, factor).shape[:2]
    return {"title": charts.view_title(title), "mean": mean, "width": width, "height": height, "pictures": pictures}


def shrunk(image: Floats, factor: int) -> Floats:
    """The mean of blocks of `factor` x `factor` pixels; what is left over at the right and below is cut off."""
    height, width = (side // factor * factor for side in image.shape[:2])
    blocks = image[:height, :width].reshape(height // factor, factor, width // factor, factor, *image.shape[2:])
    smaller: Floats = blocks.mean(axis=(1, 3))
    return smaller


def stored(light: Floats) -> str:
    """Radiance as an image of twice the height: above the upper eight of ten bits, below the lower two of each channel in one."""
    level = (np.log2(np.maximum(light, 0) + 2**LOW) - LOW) / (HIGH - LOW)
    bits = np.round(1023 * np.clip(level, 0, 1)).astype(np.uint16)
    rest = (bits & 3).astype(np.uint8)
    packed = rest[..., 0] | rest[..., 1] << 2 | rest[..., 2] << 4
    return _webp(np.concatenate([(bits >> 2).astype(np.uint8), np.repeat(packed[..., None], 3, axis=2)]))


def error_levels(error: Floats) -> npt.NDArray[np.uint8]:
    """Relative squared errors as grey levels, by decades over the range of error maps."""
    low, high = (math.log(bound) for bound in charts.ERROR_RANGE)
    level = (np.log(np.maximum(error, 1e-30)) - low) / (high - low)
    return np.round(255 * np.clip(level, 0, 1)).astype(np.uint8)


def _webp(pixels: npt.NDArray[np.uint8]) -> str:
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(pixels).convert("RGB").save(buffer, format="webp", lossless=True, method=4, exact=True)
    return inline(buffer.getvalue(), "image/webp")


def _ramp() -> list[list[int]]:
    from matplotlib import colormaps

    return (colormaps["magma"](np.arange(256))[:, :3] * 255 + 0.5).astype(int).tolist()  # type: ignore[no-any-return]


def _block(k: int, view: dict[str, Any]) -> str:
    size = f'width="{view["width"]}" height="{view["height"]}"'
    right = len(view["pictures"]) - 1
    left_choice, right_choice = (
        f'<label>{side} <select name="{side}">{_options(view, chosen)}</select></label>' for side, chosen in (("left", 0), ("right", right))
    )
    label = f"two pictures of {escape(view['title'])} beside each other"
    small = "".join(_small(index, picture, size) for index, picture in enumerate(view["pictures"]))
    return (
        f'<h3>{escape(view["title"])}</h3><div><div class="compare" id="compare-{k}"><form class="controls">{left_choice}{right_choice}'
        f'<button type="button" data-flip>flip</button><label><input type="checkbox" name="errors"> errors</label>'
        f'<label>exposure <input type="range" name="exposure" min="-8" max="8" step="0.5" value="0"> <span data-stops>0</span></label>'
        f'<div class="stage" tabindex="0" role="img" aria-label="{label}"><canvas {size}></canvas></div>'
        f'<input type="range" name="split" min="0" max="100" step="any" value="50" aria-label="where the right picture begins, %"></form>'
        f'<output></output></div><div class="pictures">{small}</div></div>'
    )  # fmt: skip


def _options(view: dict[str, Any], chosen: int) -> str:
    names = [picture["name"] for picture in view["pictures"]]
    return "".join(f'<option value="{k}"{" selected" if k == chosen else ""}>{escape(name)}</option>' for k, name in enumerate(names))


def _small(index: int, picture: dict[str, Any], size: str) -> str:
    error = f'<canvas data-error="{index}" {size}></canvas>' if picture["error"] else ""
    caption = f"{escape(picture['name'])}<br>{escape(picture['words'])}"
    return f'<figure><canvas data-light="{index}" {size}></canvas>{error}<figcaption>{caption}</figcaption></figure>'
