"""3.1: Do several voxel hierarchies compose? A ball and a torus in a box, with voxels of their own and together with the box."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.pipeline import rehfeld
from experiments.shared.keep import NONE, SIZE
from experiments.shared.panels import as_light, panels

NAMES = ("one hierarchy", "a hierarchy each", "one hierarchy, voxels elsewhere")


def scene() -> ir.Scene:
    """Lit by a lamp alone, whose shadows cones can march: emitters are traced by every technique."""
    box = ir.scenes.textured_light_box()
    lower, upper = np.asarray(box.bounds)
    lamp = ir.PointLight(position=tuple(float(v) for v in lower + (upper - lower) * (0.4, 0.85, 0.7)), intensity=(1, 1, 1))
    dark = {name: {"emission": (0, 0, 0)} for name in {mesh.material.name for mesh in box.meshes if max(mesh.material.emission) > 0}}
    return box.replace(lights=[lamp], materials=dark)


def studies() -> Sequence[ir.Study]:
    # 121 voxels lie elsewhere than 128 do: what that changes is the voxels' alignment, and a little their size.
    ways = [rehfeld(shadow=ir.VoxelCones(), glossy=None, **change) for change in ({}, {"bodies": "apart"}, {"grid__resolution": 121})]
    return [ir.Study(name="Rehfeld: rigid bodies", scenes=[scene()], methods=ways, size=SIZE, bounces=0, reference=NONE, repeats=0)]


def light(records: ir.Records, index: int) -> tuple[np.ndarray, np.ndarray]:
    """(direct, indirect) light of one way."""
    image, indirect = records.images(records[index])
    return np.asarray(image - indirect), np.asarray(indirect)


def differences(records: ir.Records) -> dict[str, tuple[float, float]]:
    """Of direct and of indirect light from one hierarchy's, mean over the picture, as a share of its mean: by name."""
    one = light(records, 0)
    return {
        name: tuple(float(np.abs(a - b).mean() / b.mean()) for a, b in zip(light(records, 1 + i), one, strict=True))  # type: ignore[misc]
        for i, name in enumerate(NAMES[1:])
    }


def chart(records: ir.Records) -> Figure:
    direct, indirect = light(records, 0)
    shown = []
    for i, name in enumerate(NAMES):
        mine = light(records, i)
        shown += [(f"direct, {name}", as_light(mine[0], direct)), (f"indirect, {name}", as_light(mine[1], indirect))]
    return panels(shown, columns=2, title="rigid bodies with voxels of their own")
