"""Error at equal time: "64 with PCSS" beside "512 simple", area lights beside points and beside denoised path tracing."""

from __future__ import annotations

import dataclasses
from typing import Any

import interreflect as ir
from bench.calibration import Calibration
from bench.rows import Row
from bench.sponza import SIZE
from bench.virtual_light_pipeline import STAGES, Room, method

REPEATS = 3
TIMES = 2.0
OURS = (16, 32, 64, 128, 256, 512, 1024)
BUDGET = 1000.0  # ms
SCALES, SAMPLES = (0.25, 0.5, 1.0), (1, 2, 4, 8, 16)


@dataclasses.dataclass(frozen=True)
class Measured:
    milliseconds: float  # of the whole frame
    indirect: float  # of its stages that make indirect light alone
    error: float  # relMSE of the indirect light


def rows(_calibration: Calibration, room: Room, peers: bool) -> list[Row]:
    few, many = measure(method(64), room), measure(method(512, "512 simple"), room)
    found = [fewer_filtered_lights(room, few, many)]
    if peers:
        points = measure(method(256, "256 points"), room)
        ours = {f"{n} with PCSS": measure(method(n), room) for n in OURS}
        ours |= {f"{n} area lights": measure(method(n, "128 area lights"), room) for n in OURS}
        ours |= {f"{n} of the default": measure(default(n), room) for n in OURS}
        found += [beside(f"256 points: {room.name}", "256 points", ours, {"256 points": points}), beside_denoised(room, ours)]
    return found


def default(lights: int) -> ir.methods.VirtualAreaLights:
    return ir.methods.VirtualAreaLights(sample_lights=ir.HaltonLights(lights=lights))


def measure(way: Any, room: Room) -> Measured:
    prepared = way.prepare(room.scene)
    frames = [prepared.render(room.camera, size=SIZE) for _ in range(1 + REPEATS)]
    profiles = [frame.profile for frame in frames[1:]]
    indirect = min(sum(p.stages[name].milliseconds for name in STAGES if name in p.stages) for p in profiles)
    error = float(ir.metrics.relmse(frames[-1].indirect, room.truth.indirect))
    return Measured(min(float(p.milliseconds) for p in profiles), float(indirect), error)


def fewer_filtered_lights(room: Room, few: Measured, many: Measured) -> Row:
    """Claim W1."""
    met = TIMES * few.indirect <= many.indirect and few.error <= many.error
    note = f"{many.indirect / few.indirect:.2f}x; relMSE {few.error:.4f} and {many.error:.4f}; the truth's {room.truth.indirect_noise:.4f}"
    target = f"at most 1/{TIMES:g} of the time at no more error"
    details = {"64 with PCSS": dataclasses.asdict(few), "512 simple": dataclasses.asdict(many)}
    name = f"64 with PCSS beside 512 simple: {room.name}"
    return Row(name, few.indirect, None, "512 simple", many.indirect, target, met, note=note, details=details)


def beside_denoised(room: Room, ours: dict[str, Measured]) -> Row:
    ways = {
        f"{spp} samples at {scale:g}": ir.methods.PathTracingDenoised(spp=spp, scale=scale, bounces=1)
        for scale in SCALES
        for spp in SAMPLES
    }
    theirs = {name: measure(way, room) for name, way in ways.items()}
    quick = {name: one for name, one in theirs.items() if one.milliseconds <= BUDGET}
    return beside(f"denoised path tracing up to {BUDGET / 1000:g} s: {room.name}", "denoised path tracing", ours, quick)


def beside(name: str, peer: str, ours: dict[str, Measured], theirs: dict[str, Measured]) -> Row:
    """At every time from which on both have a picture: the least error of each by then. Where ours must err less, it is where theirs is
    best of all against ours."""
    start = max(min(one.milliseconds for one in some.values()) for some in (ours, theirs))
    end = max(one.milliseconds for one in theirs.values())
    times = sorted({one.milliseconds for some in (ours, theirs) for one in some.values() if start <= one.milliseconds <= max(start, end)})
    pairs = [(at, _best(ours, at), _best(theirs, at)) for at in times]
    at, mine, other = max(pairs, key=lambda pair: ours[pair[1]].error / theirs[pair[2]].error)
    note = f"closest at {at:.0f} ms: {mine} {ours[mine].error:.4f}, {other} {theirs[other].error:.4f}; " + "; ".join(
        f"{way} {one.milliseconds:.0f} ms {one.error:.4f}" for way, one in {**ours, **theirs}.items()
    )
    met = ours[mine].error < theirs[other].error
    details = {
        "ours": {k: dataclasses.asdict(one) for k, one in ours.items()},
        "peer": {k: dataclasses.asdict(one) for k, one in theirs.items()},
    }
    full = f"error at equal time beside {name}"
    return Row(full, ours[mine].milliseconds, None, peer, theirs[other].milliseconds, "less error", met, note=note, details=details)


def _best(of: dict[str, Measured], by: float) -> str:
    """The one with the least error of those that are there by then."""
    return min((name for name, one in of.items() if one.milliseconds <= by), key=lambda name: of[name].error)
