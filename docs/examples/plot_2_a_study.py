"""
A study: how fine must voxels be?
=================================

Methods are values. A sweep crosses their knobs, a study measures every cell against one truth, and charts only read the records.
"""

import tempfile

import matplotlib.pyplot as plt

import interreflect as ir

study = ir.Study(
    name="how fine must voxels be?",
    scenes=[ir.scenes.cornell_box()],
    methods=ir.sweep(ir.methods.VoxelConeTracing(), {
        "prefilter": [ir.SurfaceCoverage(), ir.OctantCoverage()],
        "grid.resolution": [16, 32, 64],
    }),
    size=(96, 72),
    seeds=range(2),
    bounces=1,
    reference=ir.Reference(noise=1e-2, max_spp=128),
    repeats=0,  # errors alone: no times
)  # fmt: skip
records = ir.run(study, tempfile.mkdtemp())

# %%
# A record is a row; a column is a knob, an error or an amount of work.

table = records.table
print(table[["prefilter", "grid.resolution", "indirect_relmse", "noise"]].to_string(index=False))

# %%
# `ir.charts.curves(records, x="grid.resolution", by=["prefilter"])` draws it with intervals; a table draws itself as well.

figure, ax = plt.subplots(figsize=(5, 3.5), layout="constrained")
for name, rows in table.groupby("prefilter"):
    means = rows.groupby("grid.resolution")["indirect_relmse"].mean()
    ax.plot(means.index, means, "o-", label=name)
ax.set(xscale="log", yscale="log", xlabel="cells along the longest side", ylabel="relMSE of indirect light")
ax.legend()
