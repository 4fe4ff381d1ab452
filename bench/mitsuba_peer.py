"""Mitsuba 3 as a peer of the path tracer: the same diffuse scene, in its fastest CPU variant."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import interreflect as ir


class PeerMissing(RuntimeError):
    """The peer is not on this machine; the message says what is missing."""


def renderer(scene: ir.Scene, camera: str, size: tuple[int, int], bounces: int | None, spp: int) -> Callable[[int], NDArray[np.float32]]:
    """seed -> picture (height, width, 3) by Mitsuba's path integrator. PeerMissing where the package or LLVM 19 is not there."""
    try:
        import mitsuba
    except ImportError as error:
        raise PeerMissing("mitsuba is not installed (extra `peers`)") from error
    if not os.path.isfile(os.environ.get("DRJIT_LIBLLVM_PATH", "")):
        raise PeerMissing("LLVM 19 is not there (Debian package libllvm19, DRJIT_LIBLLVM_PATH)")
    mitsuba.set_variant("llvm_ad_rgb")
    # One translation of our scenes into Mitsuba's: the one that the tests trust as a witness.
    sys.path.append(str(Path(__file__).resolve().parent.parent / "tests" / "peers"))
    import mitsuba_scene

    loaded = mitsuba_scene.to_mitsuba(scene, scene.cameras[camera], size)
    return lambda seed: mitsuba_scene.render(loaded, bounces, spp, seed)
