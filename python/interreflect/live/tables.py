"""What the page says in words and numbers, as HTML."""

from __future__ import annotations

from html import escape

from interreflect.live.comparison import Errors
from interreflect.live.session import Picture
from interreflect.profile import Profile, Stage

SMALL = "font-size: 0.8em; padding: 0 0.9em 0.4em; line-height: 1.45"
CELL = "padding: 0.05em 0.4em 0.05em 0; vertical-align: top"
NUMBER = f"{CELL}; text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap"


def status(times: str, found: Errors | None) -> str:
    """What every tab shows: times, and the error where a truth is there."""
    if found is None:
        return _block(times)
    flip = "" if found.flip is None else f", FLIP {found.flip.value:.3f}"
    return _block(f"{times}<br>relMSE {found.relmse:.2e}{flip} against {found.spp} paths a pixel")


def times(picture: Picture, sending: float) -> str:
    """Which method took how long. sending: milliseconds that it took to encode the picture and hand it to the network."""
    seen, profile = picture.seen, picture.seen.frame.profile
    whole = profile.milliseconds + picture.milliseconds + sending
    width, height = seen.size
    return (
        f"<b>{escape(seen.prepared.method.name)}</b>, {width} x {height}<br>frame {profile.milliseconds:.0f} ms, drawn "
        f"{picture.milliseconds:.0f} ms, sent {sending:.0f} ms: {1e3 / whole:.1f} a second"
    )


def waiting(method: str) -> str:
    return _block(f"<b>{escape(method)}</b><br>is being prepared ...")


def problem(words: str) -> str:
    return f'<div role="alert" style="{SMALL}; color: #ff8f7a; overflow-wrap: anywhere">{escape(words)}</div>'


def stages(profile: Profile) -> str:
    """A row per stage: milliseconds, MiB that its result holds, and the work it did."""
    rows = "".join(
        f'<tr><td style="{CELL}; white-space: nowrap">{_words(name)}</td><td style="{NUMBER}">{stage.milliseconds:.1f}</td>'
        f'<td style="{NUMBER}">{stage.bytes / 2**20:.1f}</td><td style="{CELL}; opacity: 0.7">{_work(stage)}</td></tr>'
        for name, stage in profile.stages.items()
    )
    head = "".join(f'<th style="{style}">{name}</th>' for name, style in (("stage", CELL), ("ms", NUMBER), ("MiB", NUMBER), ("work", CELL)))
    rest = f"precomputation {profile.precompute_milliseconds:.0f} ms"
    return _block(f'<table style="border-collapse: collapse; text-align: left"><tr>{head}</tr>{rows}</table>{rest}')


def errors(found: Errors | None) -> str:
    if found is None:
        return _block("Switch the truth on: it refines while the camera rests.")
    bound = "" if found.relmse > 2 * found.noise else "<br>The error is within the truth's noise."
    flip = "..." if found.flip is None else f"<b>{found.flip.value:.3f}</b> (at {found.flip.spp} paths)"
    return _block(
        f"relMSE <b>{found.relmse:.2e}</b><br>FLIP {flip}<br>truth: {found.spp} paths a pixel, noise {found.noise:.1e}{bound}"
        f"<br>Error map: relative squared error of a pixel.{_ramp()}"
    )


def _ramp() -> str:
    """The colours of error maps, from the least error they tell to the largest."""
    from matplotlib import colormaps

    from interreflect.charts import ERROR_RANGE

    colours = ", ".join("rgb({:.0f} {:.0f} {:.0f})".format(*(255 * colormaps["magma"](k / 8)[c] for c in range(3))) for k in range(9))
    low, high = ERROR_RANGE
    ends = f'<span>{low:g}</span><span>{high:g}</span>'
    return (
        f'<div style="height: 0.8em; margin-top: 0.3em; background: linear-gradient(to right, {colours})"></div>'
        f'<div style="display: flex; justify-content: space-between">{ends}</div>'
    )


def code(text: str) -> str:
    return f'<pre style="{SMALL}; white-space: pre-wrap; overflow-wrap: anywhere; user-select: text; margin: 0">{escape(text)}</pre>'


def _work(stage: Stage) -> str:
    return ", ".join(f"{_short(count)} {_words(name)}" for name, count in stage.counts.items())


def _words(name: str) -> str:
    return escape(name.replace("_", " "))


def _short(count: int) -> str:
    for unit, size in (("G", 10**9), ("M", 10**6), ("k", 10**3)):
        if count >= size:
            return f"{count / size:.3g} {unit}"
    return str(count)


def _block(inside: str) -> str:
    return f'<div style="{SMALL}">{inside}</div>'
