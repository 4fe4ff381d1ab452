"""Where do virtual area lights break? The value at which each failure crosses its tolerance, for the ways to shade them, to see past them,
to filter what they see, and to cluster them: dots in a corner, light lost to a bound, holes in maps, penumbras, clusters that jump.

Atlases, not a study of pictures; every measured setting is kept, so it resumes. `python -m experiments.where_do_virtual_lights_break`
prints the break points; `./run figures where_do_virtual_lights_break` draws them too.
"""

from __future__ import annotations

from pathlib import Path

import interreflect as ir
from experiments.shared.atlases import Atlases, Wanted, chart, measured, table
from experiments.shared.keep import FOLDER

__all__ = ["chart", "measure"]

# Every pixel by every light, so that what is measured is the lights' own; rays where shadows are not what is looked at.
base = ir.methods.VirtualAreaLights(
    map_size=256, share=ir.EveryPixel(), shadow_lights=ir.ImperfectShadowMaps(), filter_shadows=ir.Pcss(), shade_lights=ir.DiskVector()
)
rays = base.replace(shadow_lights=ir.TracedVisibility(), filter_shadows=ir.SimpleLookup())

shaded = {
    "Point, clustered": rays.replace(shade_lights=ir.Point()),
    "Point, not clustered": rays.replace(shade_lights=ir.Point(), cluster_lights=None),
    "ClampedPoint": rays.replace(shade_lights=ir.ClampedPoint()),
    "ClampedPoint, not clustered": rays.replace(shade_lights=ir.ClampedPoint(), cluster_lights=None),
    "PointToDisk": rays.replace(shade_lights=ir.PointToDisk()),
    "DiskVector": rays,
    "MemberBoundedDisk": rays.replace(shade_lights=ir.MemberBoundedDisk()),
    "DiskIntegral": rays.replace(shade_lights=ir.DiskIntegral()),
}

MANY = 1_000_000  # points
mapped = {
    "100,000 points": base,
    "1 million points": base.replace({"shadow_lights.points": MANY}),
    "no pull and push": base.replace({"shadow_lights.iterations": 0}),
    "squares": base.replace({"shadow_lights.splat": "square"}),
    "points of 2 diameters": base.replace({"shadow_lights.point_size": 2.0}),
    "1 million, maps of 64": base.replace({"shadow_lights.points": MANY, "shadow_lights.size": 64}),
    "1 million, 32 lights": base.replace({"shadow_lights.points": MANY, "sample_lights.lights": 32}),
    "TracedVisibility": rays,
}

# Few lights, so that penumbras are the filter's; maps of many points, or rays.
few = base.replace({"sample_lights.lights": 4, "shadow_lights.points": MANY, "shadow_lights.size": 512})
filtered = {
    "SimpleLookup": few.replace(filter_shadows=ir.SimpleLookup()),
    "Pcf": few.replace(filter_shadows=ir.Pcf()),
    "Pcss": few,
    "Pcss, 64 + 64 samples": few.replace(filter_shadows=ir.Pcss(blocker_samples=64, filter_samples=64)),
    "Pcss of rays": few.replace(shadow_lights=ir.TracedVisibility()),
    "Pcss, 128 lights": few.replace({"sample_lights.lights": 128, "shadow_lights.size": 128}),
    "TracedDisk": few.replace(filter_shadows=ir.TracedDisk(samples=16)),
}

clustered = {
    "KMeans": base,
    "flux at the centre": base.replace({"cluster_lights.flux": "centre"}),
    "at the mean": base.replace({"cluster_lights.centre": "mean"}),
    "8 iterations": base.replace({"cluster_lights.iterations": 8}),
    "512 lights": base.replace({"sample_lights.lights": 512}),
    "the paper's 64": base.replace(ir.methods.VirtualAreaLights.preset_values["64 with PCSS"]).replace(share=ir.EveryPixel()),
    "not clustered": base.replace(cluster_lights=None),
}

ATLASES: Wanted = {
    "shaded": (shaded, ("singularity of few lights", "singularity by bound", "energy lost to a bound")),
    "mapped": (
        mapped,
        (
            "light in an umbra by points",
            "light in an umbra by pull and push",
            "light in an umbra by size of points",
            "false shadow in a gap",
        ),
    ),
    "filtered": (filtered, ("width of a penumbra", "penumbra of two layers")),
    "clustered": (
        clustered,
        (
            "flux of clusters on chequers",
            "churn of clusters",
            "churn of clusters made anew",
            "jumps of clusters",
            "jumps of clusters made anew",
            "drift of flux between clusters",
        ),
    ),
}


def measure(folder: Path, atlases: Wanted = ATLASES, sweep: int = 6, bisections: int = 2) -> Atlases:
    """The atlases by name; break points as `break_points.csv` and pages of pictures in `folder`. One seed: errors are far above noise."""
    return measured(folder, atlases, (0,), sweep, bisections)


if __name__ == "__main__":
    for title, one in measure(FOLDER / "where_do_virtual_lights_break").items():
        print(f"{title}: where each failure crosses its tolerance\n{table(one).to_string()}\n")
