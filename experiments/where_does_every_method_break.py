"""Where does every method break? Break points of all methods as they come, on the failures that any picture can show.

An atlas, not a study of pictures; every measured setting is kept, so it resumes. What belongs to one method's stages alone stands in
`where_do_voxels_break` and its siblings. `./run figures where_does_every_method_break` draws it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import interreflect as ir
from experiments.shared.atlases import Atlases, chart, measured, table
from experiments.shared.contenders import SMOOTH_SKY
from experiments.shared.keep import FOLDER

__all__ = ["chart", "measure"]

FAILURES = (
    "leak through a thin wall",
    "leak between corridors",
    "sky through walls",
    "occlusion by a ball",
    "occlusion by a wall",
    "banding",
    "self-illumination",
    "pixels without light",
    "penumbra",
    "roughness towards 0",
    "sharp Phong lobe",
    "black surfaces",
    "flicker under a dolly",
    "flicker under rotation",
    "popping at a depth edge",
    "scene scaled up",
    "scene scaled down",
    "scene moved away",
    "albedo towards 1",
)

methods: Mapping[str, Any] = {
    "cones": ir.methods.VoxelConeTracing(),
    "clustered caches": ir.methods.ClusteredRadianceCaching(),
    "virtual area lights": ir.methods.VirtualAreaLights(sky=SMOOTH_SKY),
    "composition": ir.methods.IlluminanceComposition(sky=SMOOTH_SKY),
    "light volumes": ir.methods.LightPropagationVolumes(sky=SMOOTH_SKY),
    "ambient occlusion": ir.methods.AmbientOcclusion(sky=SMOOTH_SKY),
    "denoised paths, 4": ir.methods.PathTracingDenoised(spp=4),
}


def measure(
    folder: Path,
    failures: Sequence[str] = FAILURES,
    ways: Mapping[str, Any] = methods,
    seeds: Sequence[int] = (0,),
    sweep: int = 5,
    bisections: int = 1,
) -> Atlases:
    """The atlas; break points as `break_points.csv` and a page of pictures in `folder`."""
    return measured(folder, {"methods": (ways, failures)}, seeds, sweep, bisections)


if __name__ == "__main__":
    for one in measure(FOLDER / "where_does_every_method_break").values():
        print(table(one).to_string())
