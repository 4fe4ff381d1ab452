"""
Where does a wall leak?
=======================

A failure is a scene with one knob. Here a wall that is turned against the grid gets thinner until light of the lit room is seen in the dark
one.
"""

import matplotlib.pyplot as plt

import interreflect as ir

failure = next(row for row in ir.stability.failures if row.name == "leak through a turned wall")
base = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=32), glossy=None)
ways = {name: base.replace({"prefilter": technique}) for name, technique in (
    ("VolumeCoverage", ir.VolumeCoverage()), ("OctantCoverage", ir.OctantCoverage()),
)}  # fmt: skip

figure, ax = plt.subplots(figsize=(5, 3.5), layout="constrained")
for name, method in ways.items():
    values = failure.values(5)
    leaked = [failure.read(method, value).error for value in values]
    ax.plot([32 * value for value in values], leaked, "o-", label=name)
ax.axhline(failure.tolerance, color="grey", linestyle=":", label="tolerance")
ax.set(xscale="log", yscale="log", xlabel="thickness of the wall, voxels",
       ylabel="dark room over lit room")
ax.legend()
