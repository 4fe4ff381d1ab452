"""Where Rehfeld's figures are made: two cars in the atrium, as near to the paper's as public files come, and Sponza."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

import interreflect as ir
from experiments.shared.keep import NONE
from experiments.shared.scenes import phong_sponza
from experiments.shared.suns import SUNS, sky
from experiments.shared.two_cars import EXPONENT, two_cars

SMALL = (872, 572)  # half the paper's pictures along each side


@dataclass(frozen=True)
class Site:
    """scene: of a Phong exponent. whole, bent: cameras that see all of it, and bent surfaces from near."""

    scene: Callable[[float], ir.Scene]
    whole: str
    bent: str


def sponza_by_suns(exponent: float = EXPONENT) -> ir.Scene:
    """Sponza with the cars' lobes and the cars' suns."""
    return phong_sponza(exponent).replace(lights=sky(SUNS), name=f"Sponza, exponent {exponent:g}, {SUNS} suns")


CARS, SPONZA = "cars", "Sponza"
SITES = {CARS: Site(two_cars, "cars", "grille"), SPONZA: Site(sponza_by_suns, "nave", "gallery")}


def study(
    site: str, name: str, methods: Sequence[Any], exponent: float = EXPONENT, bent: bool = False, size: tuple[int, int] = SMALL,
    reference: ir.Reference = NONE, seeds: Sequence[int] = (0,), repeats: int = 0,
) -> ir.Study:  # fmt: skip
    """Pictures of a site; not timed unless `repeats` says so."""
    at = SITES[site]
    return ir.Study(
        name=f"Rehfeld: {name}, {site}, exponent {exponent:g}", scenes=[at.scene(exponent)], cameras=[at.bent if bent else at.whole],
        methods=methods, size=size, seeds=seeds, bounces=1, reference=reference, repeats=repeats, max_repeats=max(repeats, 1),
    )  # fmt: skip


def everywhere(name: str, methods: Sequence[Any], exponent: float = EXPONENT, **how: Any) -> list[ir.Study]:
    """The same study of every site, in their order."""
    return [study(site, name, methods, exponent, **how) for site in SITES]


def by_site(records: Sequence[ir.Records]) -> dict[str, tuple[ir.Records, ...]]:
    """Records of studies that `everywhere` made, call by call: site -> its record of every call. ValueError if some are missing."""
    if not records or len(records) % len(SITES):
        raise ValueError(f"{len(records)} records are not as many of each of {', '.join(SITES)}")
    return {site: tuple(records[k :: len(SITES)]) for k, site in enumerate(SITES)}


def tables(of_site: Callable[..., Any], records: Sequence[ir.Records]) -> Any:
    """A table of each site below the other, the site the first level of the index."""
    return pd.concat({site: of_site(*its) for site, its in by_site(records).items()})
