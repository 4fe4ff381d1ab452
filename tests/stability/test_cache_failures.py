"""Failures of caches: what they read, and that they read nothing where pixels share nothing."""

import dataclasses

import numpy as np
import pytest

import interreflect as ir
from interreflect.methods.knobs import knob
from interreflect.methods.method import Method, method
from interreflect.stages import trace_gbuffer

ROWS = {row.name: row for row in ir.stability.failures}
UNCOVERED = [row for row in ir.stability.failures if row.name.startswith("pixels without a cache")]
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


def test_light_in_the_wrong_place_is_an_error_where_energy_is_none():
    """The lobe row sees what the row of a sharp lobe's energy does not."""
    sharp, energy = (dataclasses.replace(ROWS[name], size=(32, 24)) for name in ("reflection in a sharp lobe", "sharp Phong lobe"))

    class Upside(ir.methods.PathTracing):
        def compose(self, view, profile):
            direct, indirect, *_ = super().compose(view, profile)
            return direct, np.ascontiguousarray(indirect[::-1]), None

    right, wrong = ir.methods.PathTracing(spp=2048), Upside(spp=2048)
    assert sharp.read(right, 300.0, seed=9).error < 0.5 * sharp.tolerance < sharp.tolerance < sharp.read(wrong, 300.0, seed=9).error
    assert energy.read(wrong, 300.0, seed=9).error < energy.tolerance


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
