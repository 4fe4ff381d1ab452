"""Rehfeld's claims about caches. Metrics and bounds were written down before the first run; the comments say why so.

Verdicts are of the two cars, the paper's scene; Sponza's numbers are told beside, but where a claim speaks of flat surfaces.
"""

from __future__ import annotations

import interreflect as ir
from experiments.ledger.claim import Check, Claim, above, below, told
from experiments.rehfeld import (
    adapted_axes,
    figure_4,
    figure_5,
    figure_6,
    figure_7,
    figure_8,
    gather_or_splat,
    one_ray_a_texel,
    popping,
)
from experiments.rehfeld.sites import CARS, SPONZA


def r1(*records: ir.Records) -> list[Check]:
    times = figure_4.table(*records)
    ours = times[CARS]
    three = ours[["distribution", "creation", "evaluation"]]
    return [
        # The bar's picture, whatever the machine: which step is dearest, which cheapest, and that the method's own three are alike.
        Check("direct light by cones is the dearest step", ours.idxmax(), ours.idxmax() == "direct light"),
        Check("the G-buffer is the cheapest", ours.idxmin(), ours.idxmin() == "G-buffer"),
        below("none of the method's three takes more than half of their time", float(three.max() / three.sum()), 0.5),
        *(
            told(f"{site}: milliseconds (paper)", ", ".join(f"{step} {value:.0f} ({times['paper'][step]:g})" for step, value in of.items()))
            for site, of in times[[CARS, SPONZA]].items()
        ),
    ]


def r2(*records: ir.Records) -> list[Check]:
    found = figure_5.table(*records)
    off = found.loc[CARS]
    usual = off[figure_5.USUAL]
    fewer, coarser = float(off[(1024, 16)] / usual), float(off[(4096, 8)] / usual)
    return [
        # Both halve a side: a quarter of the caches, a quarter of the texels.
        above("a quarter of the caches costs more error than a quarter of the texels", fewer / coarser, 1.0, "x"),
        # Details lost: an error that is seen to grow, by a quarter.
        above("too few caches lose detail", fewer, 1.25, "x the error"),
        *(
            told(f"{site}: off", ", ".join(f"{count:,} of {n}^2: {value:.1%}" for (count, n), value in found.loc[site].items()))
            for site in (CARS, SPONZA)
        ),
    ]


def r3(*records: ir.Records) -> list[Check]:
    found = figure_6.table(*records)
    clustered, equidistant = (found.loc[(CARS, way)] for way in figure_6.WAYS)
    return [
        # "All": one pixel of a thousand is what edges of the weights may leave.
        below("clustered caches cover all pixels", 100 * clustered["uncovered"], 0.1, " % uncovered"),
        above("equidistant ones leave some", 100 * equidistant["uncovered"], 0.5, " % uncovered"),
        # "Muddies": a tenth more error.
        above("and muddy the picture", equidistant["difference"] / clustered["difference"], 1.1, "x the error"),
        told(
            "uncovered and off",
            ", ".join(f"{site}, {way}: {row['uncovered']:.2%}, {row['difference']:.1%}" for (site, way), row in found.iterrows()),
        ),
    ]


def r4(*records: ir.Records) -> list[Check]:
    found = figure_7.table(*records)
    flip = found.loc[CARS, "flip"]
    return [
        # As plausible as a lobe of exponent 10, which no cache is too coarse for, to within a quarter.
        below("exponent 150 looks as right as exponent 10", float(flip[150.0] / flip[10.0]), 1.25, "x the FLIP"),
        *(
            told(
                f"{site}: FLIP of the indirect light (of maps of 32^2 at every pixel; between the truth's halves)",
                ", ".join(f"{e:g}: {row['flip']:.3f} ({row['own']:.3f}; {row['halves']:.3f})" for e, row in found.loc[site].iterrows()),
            )
            for site in (CARS, SPONZA)
        ),
    ]


def r5(*records: ir.Records) -> list[Check]:
    both = figure_8.table(*records)
    found = both.loc[CARS]
    return [
        # Four tiles hold sixteen times as many caches as one; a fixed cost a pixel may hide most of that, but not a doubling.
        above("a radius of four tiles costs more than one", found["milliseconds"][4.0] / found["milliseconds"][1.0], 2.0, "x the time"),
        below("and smooths", found["detail"][4.0] / found["detail"][1.0], 1.0, "x the detail"),
        *(
            told(
                f"{site}: off",
                ", ".join(f"f = {f:g}: {row['difference']:.1%} in {row['milliseconds']:.0f} ms" for f, row in both.loc[site].iterrows()),
            )
            for site in (CARS, SPONZA)
        ),
    ]


def r9(pictures: ir.Records, times: ir.Records) -> list[Check]:
    found = gather_or_splat.table(pictures, times)["milliseconds"]
    return [
        above("gathering is faster than splatting by the same weights", found["splat, minimum"] / found["gather"], 1.0, "x the time"),
        above("and than splatting by the weight in space alone", found["splat, world"] / found["gather"], 1.0, "x the time"),
    ]


def r10(*records: ir.Records) -> list[Check]:
    found = adapted_axes.table(*records)["clusters"]
    adapted, fixed = adapted_axes.WAYS
    bent, flat = (float(found[(scene, adapted)] / found[(scene, fixed)]) for scene in (CARS, SPONZA))
    return [
        # "Fewer": a tenth.
        below("adapted axes make fewer clusters of the cars", bent, 0.9, " of the fixed cells'"),
        Check("above all on bent surfaces", f"cars {bent:.2f}, Sponza {flat:.2f} of the fixed cells' clusters", bent < flat),
        told("clusters", ", ".join(f"{scene}, {way}: {count:,.0f}" for (scene, way), count in found.items())),
    ]


def r12(*records: ir.Records) -> list[Check]:
    found = popping.table(*records)
    checks = []
    for case in popping.CASES:
        of = found.loc[case]
        jumping, steady, floor = of.loc["clustered"], of.loc[popping.KEEPING], of.loc[popping.FLOOR]
        checks += [
            # What a picture's resampling changes by itself is the floor; caches jump where most of the change is theirs.
            above(f"{case}: caches jump", float(jumping["mean"] / floor["mean"]), 2.0, "x the change with a cache at every pixel"),
            # A quarter less is what one notices in a film.
            below(f"{case}: kept places jump less", float(steady["beyond"] / jumping["beyond"]), 0.75, " of the change beyond that"),
        ]
    told_ = [
        told(
            case,
            ", ".join(f"{way} {row['mean']:.3f} ({row['pops']:.1%} pop; {row['caches']:.0f})" for way, row in found.loc[case].iterrows()),
        )
        for case in popping.CASES
    ]
    return checks + told_


def r14(records: ir.Records) -> list[Check]:
    found = one_ray_a_texel.table(records)
    (ray, ray_near), (cone, cone_near) = (100 * found.loc[f"one {way} a texel", ["missed", "nowhere near"]] for way in ("ray", "cone"))
    return [
        # "No bright part": less than half seen of one bright texel in twenty, and of a tenth of those that the ray misses.
        below("one cone a texel misses no bright part", cone, 5.0, " % of the bright texels"),
        above("one ray does", ray, 5.0, " % of the bright texels"),
        above("far more than the cone", ray / max(cone, 1e-6), 10.0, "x"),
        told("seen neither there nor a texel beside it, ray / cone", f"{ray_near:.1f} / {cone_near:.1f} %"),
    ]


CLAIMS = (
    Claim("R1", "figure 4", "Cost of each step: voxel shading 27, distribution 31, creation 39, evaluation 33.5, direct light 88 ms.",
          figure_4.studies, r1),
    Claim("R2", "figure 5", "The number of caches matters more than their resolution.", figure_5.studies, r2),
    Claim("R3", "figure 6", "Clustered placement covers all pixels, equidistant does not, and muddies.", figure_6.studies, r3),
    Claim("R4", "figure 7", "Exponents up to 150 stay visually plausible.", figure_7.studies, r4),
    Claim("R5", "figure 8", "A larger gathering radius smooths and costs more.", figure_8.studies, r5),
    Claim("R9", "3.3", "Gathering beats splatting in speed.", gather_or_splat.studies, r9),
    Claim("R10", "3.2", "Axes adapted to the normals give fewer clusters, above all on bent surfaces.", adapted_axes.studies, r10),
    Claim("R12", "5", "Under camera motion caches jump; keeping last frame's places lessens it.", popping.studies, r12),
    Claim("R14", "3.1", "One cone a texel misses no bright part; one ray does.", one_ray_a_texel.studies, r14),
)  # fmt: skip
