"""Figure 5: The buffers of a frame's lighting, from the light's map to the whole picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.light_picture import LightPicture
from experiments.shared.panels import as_light, as_share, groups, picture
from experiments.shared.phase_light_picture import PhaseLightPicture
from experiments.shared.split_picture import SplitPicture
from experiments.weinzierl_heigl.pipeline import MAP, area_lights, compared, indirect, replaced, study


def studies() -> Sequence[ir.Study]:
    maps = [replaced(LightPicture.preset("64 with PCSS"), show=show) for show in ("flux", "clusters")]
    return [
        study("the light's buffers", maps, size=MAP),
        study("split buffer", [SplitPicture(share=ir.Interleaved(width=4, height=4))]),
        study("light before the merge", [replaced(PhaseLightPicture.preset("64 with PCSS"), tiles=tiles) for tiles in (True, False)]),
        compared("lighting chain", [area_lights(), area_lights(share=ir.EveryPixel())]),
    ]


def chart(maps: ir.Records, split: ir.Records, phases: ir.Records, light: ir.Records) -> Figure:
    whole, of_indirect = (np.asarray(one) for one in light.truth(light[0]))
    image, merged = (np.asarray(one) for one in light.images(light[0]))
    return groups(
        {
            "the light's map": [
                ("flux that it sends on", as_share(picture(maps, 0))),
                ("64 clusters", as_share(picture(maps, 1))),
            ],
            "split over 4 x 4 pixels, a sixteenth of the lights each": [
                ("normals of each phase's pixels", as_share(picture(split))),
                ("light of each phase's lights on its pixels", as_light(indirect(phases, 0), of_indirect)),
                ("merged: every pixel where it stands", as_light(indirect(phases, 1), of_indirect)),
                ("filtered over neighbours on the same surface", as_light(merged, of_indirect)),
            ],
            "the picture's": [
                ("indirect light, all lights at every pixel", as_light(indirect(light, 1), of_indirect)),
                ("direct light", as_light(image - merged, whole)),
                ("all light", as_light(image, whole)),
                ("path-traced truth, one bounce", as_light(whole, whole)),
            ],
        }
    )
