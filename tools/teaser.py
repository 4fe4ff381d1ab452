"""Draws the README's picture: the built-in atrium by voxel cone tracing, beside the truth, and where they differ.

python tools/teaser.py docs/teaser.png
"""

import sys

import numpy as np
from matplotlib import colormaps

import interreflect as ir
from interreflect.images import tone_map

SIZE = (400, 300)
EXPOSURE = -0.5


def main(path: str) -> None:
    from PIL import Image

    rows = []
    for scene, exposure in ((ir.scenes.atrium(), EXPOSURE), (ir.scenes.cornell_box(), 1.0)):
        frame = ir.methods.VoxelConeTracing().render(scene, size=SIZE)
        truth = ir.reference(scene, size=SIZE, bounces=1, noise=1e-3, max_spp=1024)
        error = np.clip(np.log10(ir.metrics.error_map(frame.image, truth.image) + 1e-9) / 4 + 1, 0, 1)
        heat = (255 * colormaps["inferno"](error)[..., :3]).astype(np.uint8)
        rows.append(np.hstack([tone_map(frame.image, exposure), tone_map(truth.image, exposure), heat]))
    Image.fromarray(np.vstack(rows)).save(path, optimize=True)


if __name__ == "__main__":
    main(sys.argv[1])
