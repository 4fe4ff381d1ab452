"""Rehfeld's claims about voxels and cones. Metrics and bounds were written down before the first run; the comments say why so."""

from __future__ import annotations

import interreflect as ir
from experiments.ledger.claim import Check, Claim, above, below, told
from experiments.rehfeld import alternating_layers, cone_shadows, resolution, rigid_bodies, start_as_rays, surface_coverage


def r6(*records: ir.Records) -> list[Check]:
    gains = {}
    for exponent, one in zip(resolution.EXPONENTS, records, strict=True):
        errors = resolution.errors(one)
        gains[exponent] = 1 - errors[256] / errors[128]
    # "Noticeable": a tenth of the error. "Depending on the glossiness": the sharpest lobe gains more than the widest.
    usual, widest, sharpest = gains[50], gains[resolution.EXPONENTS[0]], gains[resolution.EXPONENTS[-1]]
    return [
        below("256^3 is not noticeably better than 128^3 at the paper's exponent 50", usual, 0.1, " of the error"),
        Check("sharper lobes gain more", ", ".join(f"exponent {e}: {g:.2f} of the error" for e, g in gains.items()), sharpest > widest),
    ]


def r7(records: ir.Records) -> list[Check]:
    paper, corrected = (alternating_layers.openness(records, corrected) for corrected in (False, True))
    # One opaque layer hides the sun. Sampled between an opaque and an empty voxel twice, as a step of a full diameter may, it leaves a
    # quarter; sampled four times at quarters, as a step of half may at worst, .035. A twentieth lies between the two.
    return [
        below("half a diameter sees the layer", 100 * float(paper[0.5].max()), 5.0, " % open at worst"),
        above("a full diameter does not", 100 * float(paper[1.0].max()), 5.0, " % open at worst"),
        told("with opacity corrected for the step, 1/2 and 1", " / ".join(f"{100 * float(corrected[s].max()):.1f} %" for s in (0.5, 1.0))),
    ]


def r8(records: ir.Records) -> list[Check]:
    opacity = surface_coverage.table(records)
    last = opacity.index[-1]
    # Opaque: 99 % in every level. Thinned: halved from level to level (ERRATA), so by level 2 less than a third is left.
    return [
        above("surface coverage keeps the wall opaque in every level", float(opacity["SurfaceCoverage"].min()), 0.99),
        below("volume coverage thins it", float(opacity["VolumeCoverage"][2]), 1 / 3, " at level 2"),
        told(f"volume coverage from level 0 to {last}", ", ".join(f"{value:.2f}" for value in opacity["VolumeCoverage"])),
    ]


def r11(records: ir.Records) -> list[Check]:
    found = rigid_bodies.differences(records)
    (shadows, radiance), (moved_shadows, moved_radiance) = (found[name] for name in rigid_bodies.NAMES[1:])
    return [
        # "Exactly": a body's own voxels lie elsewhere than the box's, so it may differ by what moving the voxels makes, and no more.
        below("shadows compose as exactly as voxels can tell", shadows / moved_shadows, 1.0, " of what other voxels change"),
        # "Small": a twentieth of the light.
        below("radiance has a small error", 100 * radiance, 5.0, " % of the indirect light"),
        told("other voxels change", f"{moved_shadows:.1%} of the direct and {moved_radiance:.1%} of the indirect light"),
    ]


def r13(records: ir.Records) -> list[Check]:
    found = start_as_rays.table(records)
    steps, error = found["steps"], found["error"]
    small = start_as_rays.ANGLES[0]
    return [
        # Steps are work that no clock disturbs. A quarter more is a cost that is noticed.
        above("starting as rays costs steps at small angles", steps["rays"][small] / steps["compromise"][small], 1.25, "x the steps"),
        # "Without gain in precision": less than a twentieth of the error.
        above("and does not lessen the error", error["rays"][small] / error["compromise"][small], 0.95, "x the error"),
        told("at large angles", f"{steps['rays'].iloc[-1] / steps['compromise'].iloc[-1]:.2f}x the steps"),
        told(
            "starting at once",
            f"{steps['immediate'][small] / steps['compromise'][small]:.2f}x the steps, "
            f"{error['immediate'][small] / error['compromise'][small]:.2f}x the error",
        ),
    ]


def r15(records: ir.Records) -> list[Check]:
    shares = cone_shadows.wrong(records)
    told_ = ", ".join(f"{n}^3: {share:.1%}" for n, share in shares.items())
    return [
        # Artefacts that one sees: a fiftieth of the picture off by a quarter of the sun.
        above("cone-marched shadows are visibly wrong at 128^3", 100 * shares[128], 2.0, " % of the pixels"),
        # They are those of voxels, so smaller voxels shrink them.
        Check("they are the voxels': finer ones lessen them", told_, shares[256] < shares[128] < shares[64]),
    ]


CLAIMS = (
    Claim("R6", "4", "Voxel resolution above about 128^3 brings no noticeable gain, depending on the glossiness.", resolution.studies, r6),
    Claim(
        "R7",
        "4",
        "A step of half the cone diameter resolves alternating opaque and empty voxels; a full diameter does not.",
        alternating_layers.studies,
        r7,
    ),
    Claim(
        "R8", "3.1", "Surface coverage keeps walls opaque in coarse levels where volume coverage thins them.", surface_coverage.studies, r8
    ),
    Claim(
        "R11",
        "3.1",
        "Several hierarchies (rigid instances) compose: shadows exactly, radiance with small error.",
        rigid_bodies.studies,
        r11,
    ),
    Claim(
        "R13", "4", "Starting with ray marching costs the speed-up at small angles without gain in precision.", start_as_rays.studies, r13
    ),
    Claim("R15", "5", "Cone-marched direct shadows show the voxels.", cone_shadows.studies, r15),
)
