"""Figure 1: Sponza with its caches, and a car under an environment with slightly glossy surfaces and many bounces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import compared, composition, precomputed, replaced, study
from experiments.shared.composition_picture import CompositionPicture
from experiments.shared.panels import as_light, as_share, groups, picture
from experiments.shared.scenes import car_in_a_hall, sunny_phong_sponza

SIZE = (640, 360)
CAR_GRID = ir.CacheGrid(nx=32, ny=12, nz=20, normal_offset=0.0)  # the car is a body: it is lit by the grid
SAMPLES = ir.TracedSky(samples=64, filter_radius=2)

PAPER_PRINTS = "Sponza 5.7 ms (245k triangles, 10k caches, 4 bands), the car 10.5 ms (1.35M triangles, 10k caches, 6 bands), on a GTX 980"


def car_way() -> Any:
    """Six bands, as the paper's; all bounces; half of setting 1's surfels, as most of the surface is the car's, which sends none on."""
    caches = ir.LightMap(texels=128, grid=CAR_GRID)
    return composition(link__bands=6, place_caches=caches, place_surfels__surfels=65536, sky=SAMPLES, bounces=None)


def studies() -> Sequence[ir.Study]:
    caches = replaced(CompositionPicture.preset("setting 1"), show="caches", bounces=1)
    hall: dict[str, Any] = {"at": car_in_a_hall(), "camera": None, "reference": ir.Reference(noise=1e-2, max_spp=256)}
    return [
        study("caches of Sponza", [caches], size=SIZE),
        compared("Sponza, all bounces", [composition(bounces=None)], at=sunny_phong_sponza(), size=SIZE, bounces=None, repeats=2),
        compared("a car in a hall", [car_way()], size=SIZE, bounces=None, repeats=2, **hall),
    ]


def chart(caches: ir.Records, sponza: ir.Records, of_car: ir.Records) -> Figure:
    def pair(records: ir.Records) -> list[Any]:
        record = records[0]
        truth = np.asarray(records.truth(record)[0])
        ours = f"{record.milliseconds:.0f} ms, FLIP {record.metrics['flip']:.3f}"
        return [(ours, as_light(picture(records), truth)), ("path-traced truth", as_light(truth, truth))]

    counts = [precomputed(records, 0)["caches"] for records in (sponza, of_car)]
    return groups(
        {
            f"Sponza, {counts[0]:,} caches, 4 bands, all bounces": [("each cache in its colour", as_share(picture(caches))), *pair(sponza)],
            f"a car, {counts[1]:,} caches, 6 bands, all bounces": pair(of_car),
        },
        columns=3,
    )
