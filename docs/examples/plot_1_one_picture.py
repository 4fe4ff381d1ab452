"""
One picture and its truth
=========================

A scene goes in, a method renders it, and the path-traced truth says how far off it is.
"""

import matplotlib.pyplot as plt

import interreflect as ir
from interreflect.images import tone_map

scene = ir.scenes.cornell_box()
method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=64))
frame = method.render(scene, size=(192, 144))
truth = ir.reference(scene, size=(192, 144), bounces=method.bounces, noise=5e-3, max_spp=256)

# %%
# The profile says what each stage took and what work it did.

print(frame.profile)

# %%
# The error is relative: exposure does not matter. The truth's own noise is stated beside it.

print(f"relMSE {ir.metrics.relmse(frame.image, truth.image):.4f}, the truth's noise {truth.noise:.4f}")

figure, axes = plt.subplots(1, 2, figsize=(7, 2.8), layout="constrained")
for ax, image, name in zip(axes, (frame.image, truth.image), ("voxel cone tracing, 64 cells", "path-traced truth"), strict=True):
    ax.imshow(tone_map(image, 1.0))
    ax.set_title(name)
    ax.axis("off")
