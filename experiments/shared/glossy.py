"""Built-in scenes with glossy surfaces everywhere: what caches are for."""

from __future__ import annotations

import interreflect as ir

LOBE = {"specular": (0.2, 0.2, 0.2), "lobe": "phong", "exponent": 50.0}


def glossy_scenes() -> list[ir.Scene]:
    """The Cornell box and the atrium with Rehfeld's lobe on every surface."""
    return [scene.replace(materials={"*": LOBE}, name=f"glossy {scene.name}") for scene in (ir.scenes.cornell_box(), ir.scenes.atrium())]
