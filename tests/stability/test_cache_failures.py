"""Failures of caches: what they read, and that they read nothing where pixels share nothing."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from faults import is_noticed, overwrite

import interreflect as ir
from interreflect.methods.knobs import knob
from interreflect.methods.method import Method, method
from interreflect.stages import trace_gbuffer

ROWS = {row.name: row for row in ir.stability.failures}
UNCOVERED = [row for row in ir.stability.failures if row.name.startswith("pixels without a cache")]
LOBE = ROWS["reflection in a sharp lobe"]
CACHES = ir.methods.ClusteredRadianceCaching(grid=ir.Grid(resolution=64), distribute=ir.Clustered(caches=0, tile=8))
CONES = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=32), share=ir.EveryPixel())


@method
class OneCacheATile(Method):
    """The worst of caches: one for the first surface in a tile, good for pixels nearer to it than `reach` times their depth."""

    tile: int = knob(default=16, doc="pixels", minimum=1, maximum=256)
    reach: float = knob(default=0.1, doc="of the depth", minimum=0.0, maximum=10.0)

    bounces = 0

    def compose(self, view, profile):
        gbuffer = trace_gbuffer(view.scene, view.camera, view.size)
        depth, position = np.asarray(gbuffer.depth), np.asarray(gbuffer.position, np.float64)
        hit, covered = np.isfinite(depth), np.zeros(depth.shape, bool)
        for y in range(0, depth.shape[0], self.tile):
            for x in range(0, depth.shape[1], self.tile):
                place = np.s_[y : y + self.tile, x : x + self.tile]
                if hit[place].any():
                    first = position[place][hit[place]][0]
                    covered[place] = np.linalg.norm(position[place] - first, axis=2) < self.reach * depth[place]
        with profile.stage("interpolate") as note:
            note.counts.update(covered_pixels=int((hit & covered).sum()), uncovered_pixels=int((hit & ~covered).sum()))
        light = np.zeros((*depth.shape, 3), np.float32)
        return light, light, None


@pytest.mark.parametrize("row", UNCOVERED, ids=lambda row: row.name)
def test_equidistant_caches_leave_pixels_out_and_one_a_pixel_leaves_none(row):
    middle = row.at(0.5)
    assert row.read(OneCacheATile(), middle).error > 10 * row.tolerance
    assert row.read(OneCacheATile(tile=1), middle).error == 0
    assert row.read(OneCacheATile(reach=10.0), middle).error == 0


def test_the_share_is_that_of_pixels_with_a_surface():
    row = next(row for row in UNCOVERED if "wires" in row.name)  # most of the picture is sky
    tiny = row.read(OneCacheATile(tile=256, reach=0.001), row.easy)
    assert tiny.error > 0.9
    assert tiny.error < 1  # the cache's own pixel has it


def test_finer_things_leave_more_pixels_out():
    for row in UNCOVERED[:2]:
        easy, hard = (row.read(OneCacheATile(), row.at(share)).error for share in (0.0, 1.0))
        assert hard > easy


@pytest.mark.parametrize("row", UNCOVERED, ids=lambda row: row.name)
def test_a_method_whose_pixels_share_nothing_has_no_pixel_without_a_cache(row):
    for own in (CONES, ir.methods.ConstantAmbient()):
        assert row.read(own, row.at(0.3)).error == 0


def own_cache(resolution=32):
    """Light as it arrives: a cache a pixel, its lobes integrated."""
    return CACHES.replace({"interpolate": ir.Evaluated(), "preconvolve": ir.LobeIntegral(), "fill.resolution": resolution})


def test_a_lobe_is_blurred_the_more_the_sharper_it_is_and_the_coarser_the_cache():
    row = dataclasses.replace(LOBE, size=(24, 18))
    wide, sharp, finer, truth = (row.read(own_cache(n), exponent).error for n, exponent in ((8, 5.0), (8, 1e3), (32, 1e3), (64, 1e3)))
    assert sharp > 3 * wide and sharp > 3 * finer > 0
    assert truth == 0


def test_a_method_without_caches_blurs_none():
    for own in (CONES, ir.methods.ConstantAmbient(), ir.methods.PathTracing(spp=1)):
        assert LOBE.read(own, 50.0).error == 0


def test_blur_of_no_light_is_refused():
    black = dataclasses.replace(LOBE, scene=lambda n: ir.scenes.glossy_receiver(exponent=n).replace(lights=()))
    with pytest.raises(ValueError, match="no indirect light"):
        black.read(CACHES, 50.0)


def equidistant(stage, technique, *rest):
    return stage(ir.Equidistant(caches=0, tile=technique.tile), *rest)


def mirrored(stage, *arguments):
    filled = stage(*arguments)
    overwrite(filled.texels, filled.texels[:, :, ::-1])
    return filled


def coarser(stage, technique, *rest):
    return stage(technique.replace(level_bias=technique.level_bias + 2), *rest)


def too_near(stage, technique, *rest):
    return stage(technique.replace(radius=0.4), *rest)


def left_black(stage, *arguments):
    light = stage(*arguments)
    gathered = light.gathered
    served = light.weight != 1  # that of the one cache that lights a pixel without any; sums of weights are other numbers
    overwrite(gathered.irradiance, gathered.irradiance * served[..., None])
    return SimpleNamespace(gathered=gathered, glossy=light.glossy)


def read(name, value, method):
    return lambda: ROWS[name].read(method, value).error / ROWS[name].tolerance


A_PIXEL = CACHES.replace(distribute=ir.CachePerPixel())
INTEGRATED = A_PIXEL.replace(preconvolve=ir.LobeIntegral())
BY_LEVEL = A_PIXEL.replace(preconvolve=ir.MipChain(width="resultant", level_bias=-1.0))
SCATTERED = CACHES.replace(distribute=ir.Equidistant(caches=0, tile=8))
FAULTS = {
    "equidistant places": ("distribute", equidistant, read("pixels without a cache on wires", 0.02, CACHES)),
    "caches mirrored": ("fill", mirrored, read("reflection in a sharp lobe", 20.0, INTEGRATED)),
    "lobes two levels too wide": ("preconvolve", coarser, read("reflection in a sharp lobe", 50.0, BY_LEVEL)),
    "half a tile gathered": ("interpolate", too_near, read("pixels without a cache in foliage", 0.1, CACHES)),
    "pixels without a cache left black": ("interpolate", left_black, read("pixels without light", 0.03, SCATTERED)),
}


def test_every_stage_of_its_own_has_a_fault():
    assert {stage for stage, _, _ in FAULTS.values()} == {"distribute", "fill", "preconvolve", "interpolate"}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_noticed_and_the_sound_stage_passes(fault, monkeypatch):
    is_noticed(monkeypatch, "clustered_radiance_caching", *FAULTS[fault])


def test_a_small_ball_whose_light_is_lost_is_noticed():
    row = ROWS["tiles that see the sky alone"]
    fine = CONES.replace({"grid.resolution": 64})
    assert row.read(fine, 0.1).error <= row.tolerance

    class Striped(ir.methods.VoxelConeTracing):
        def compose(self, view, profile):
            direct, indirect, *_ = super().compose(view, profile)
            return direct, indirect * (np.arange(indirect.shape[1]) % 16 < 15)[None, :, None].astype(np.float32), None

    assert row.read(Striped(grid=fine.grid, share=fine.share), 0.1).error > row.tolerance


def test_popping_at_a_depth_edge_sees_what_jumps():
    row = ROWS["popping at a depth edge"]
    steady = row.read(ir.methods.ConstantAmbient(ambient=0.0), 0.3)

    class Jumping(ir.methods.ConstantAmbient):
        frames = 0

        def compose(self, view, profile):
            direct, indirect, *_ = super().compose(view, profile)
            type(self).frames += 1
            return direct, indirect + np.float32(0.01 * (self.frames % 2)), None

    assert row.read(Jumping(ambient=0.0), 0.3).error > 2 * steady.error
