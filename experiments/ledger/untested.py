"""The claims of the paper whose method is not built yet."""

from __future__ import annotations

from experiments.ledger.claim import Claim

SURFELS = "precomputed illuminance composition: surfels, links and caches"

JENDERSIE = {
    "J1": ("table 2", "Times of surfels, pulling and caches on two machines."),
    "J2": ("figure 3", "Halton places surfels better than Xorshift; relaxation better still."),
    "J3": (
        "figure 6",
        "Closer to the truth than light propagation volumes and voxel cone tracing; no bleeding through light-mapped walls.",
    ),
    "J4": ("figure 7", "A textured area light comes close to the path-traced image."),
    "J5": ("figure 8", "Glossy light with 2 to 8 bands at exponent 30; little gain above 6 bands."),
    "J6": ("figure 8 m", "Runtime projection looks nearly like precomputed links, with less memory and slightly more speed."),
    "J7": ("figure 8", "Half as many chrominance bands are barely visible and 31 % faster at 8 bands."),
    "J8": ("figure 10", "32 links do not suffice; cost is near-proportional to links."),
    "J9": ("figure 11", "Cost against bands, with and without runtime projection."),
    "J10": ("table 3", "Chrominance compression pays from 6 bands on; 2 chrominance bands are too few."),
    "J11": ("table 4", "Memory of surfels, links and caches."),
    "J12": ("figure 9", "Failures: misplaced texels, link discontinuities, bleeding between corridors."),
    "J13": ("5.3.1", "All stages but shading are independent of the resolution."),
    "J14": ("3", "Many bounces converge progressively by feeding the last caches into the surfels."),
    "J15": ("4.3", "Agglomerative clusters give better senders than a kd-tree."),
    "J16": ("4.1", "Pulling flux is faster than pulling radiosity."),
    "J17": ("5.3.2", "Fewer surfels are safer than fewer links; more caches reduce interpolation artefacts."),
}

CLAIMS = tuple(Claim(name, place, text, missing=SURFELS) for name, (place, text) in JENDERSIE.items())
