"""Failures of voxels: what their laws are where they have one, and which methods they concern."""

import math

import numpy as np
import pytest

import interreflect as ir
from interreflect.stability.crossing import BREAKS
from interreflect.stability.failure import Reading

ROWS = {row.name: row for row in ir.stability.failures}
MAP, ROOF = ROWS["shadow map coarser than the voxels"], ROWS["sky through walls"]
LAYER, CORRECTED = ROWS["opaque layer between empty ones"], ROWS["opaque layer, opacity by the step's length"]
CELLS = 64
METHOD = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=CELLS), glossy=None, share=ir.EveryPixel())


def left_open(step, corrected):
    """Most of the sun past one opaque layer: samples of the layer's tent, `step` apart, at the worst of places."""
    places = np.linspace(0, step, 401)[:, None] + step * np.arange(-math.ceil(1 / step) - 1, math.ceil(1 / step) + 1)
    transparent = np.prod(np.minimum(np.abs(places), 1.0), axis=1)
    return float(transparent.max() ** (step if corrected else 1.0))


@pytest.mark.parametrize("step", [0.25, 0.5, 1.0, 1.5])
@pytest.mark.parametrize("row", [LAYER, CORRECTED], ids=lambda row: row.name)
def test_an_opaque_layer_is_as_open_as_the_samples_of_its_tent(row, step):
    expected = left_open(step, corrected=row is CORRECTED)
    # Pixels are an eightieth of a step or more apart; what is below .02 (the cut-off) may be 0.
    assert row.read(METHOD, step).error == pytest.approx(expected, rel=0.005, abs=0.0008)


def test_half_a_diameter_resolves_a_layer_and_a_whole_one_does_not_unless_opacity_is_corrected_for_the_step(tmp_path):
    points = ir.stability.atlas([METHOD], [LAYER, CORRECTED], seeds=(0,), folder=tmp_path, bisections=2).break_points
    assert points["break_point"].iloc[0] == pytest.approx(0.55, abs=0.05)  # where left_open is a twentieth
    # Of ever shorter steps, e^-2 is left: the integral of the tent's optical depth.
    assert points["outcome"].iloc[1] == "always"


@pytest.mark.parametrize("texels", [0.25, 0.5, 0.75])
def test_a_coarse_shadow_map_lights_a_voxel_for_every_texel(texels):
    size = round(texels * CELLS)
    # A texel of margin on either side sees no floor; the grid's border keeps half a voxel of air on either side.
    lit = ((size - 2) / (CELLS - 1)) ** 2
    # The wall sees the nearest voxels best, so which of them are lit tells in the mean.
    assert MAP.read(METHOD, texels).signed == pytest.approx(lit - 1, abs=0.015)


@pytest.mark.parametrize(("warp", "between"), [(ir.Linear(), (0.9, 1.1)), (ir.Logistic(), (1.1, 2.5))])
def test_gaps_show_below_one_texel_a_voxel_and_earlier_where_voxels_are_squeezed_together(warp, between, tmp_path):
    atlas = ir.stability.atlas(
        [METHOD.replace(grid=ir.Grid(resolution=CELLS, warp=warp))], [MAP], seeds=(0,), folder=tmp_path, bisections=3
    )
    (row,) = atlas.break_points.itertuples()
    assert row.outcome == BREAKS and between[0] < row.break_point < between[1]


def test_texels_a_voxel_are_told_of_voxels_as_small_as_they_are():
    """A cube twice as wide as the scene with twice the voxels has voxels of the same size, and so the same gaps."""
    about_the_camera = METHOD.replace(grid=ir.Grid(resolution=2 * CELLS, region=ir.AroundCamera(width=2)))
    # Voxels that lie elsewhere in the grid are lit by other texels.
    assert MAP.read(about_the_camera, 0.5).signed == pytest.approx(MAP.read(METHOD, 0.5).signed, abs=0.03)


def test_a_fine_shadow_map_lights_what_traced_rays_light():
    assert MAP.read(METHOD, MAP.easy).error < 0.005  # voxels on the floor's border, partly outside of the map's last texels


@pytest.mark.parametrize("row", [MAP, LAYER, CORRECTED], ids=lambda row: row.name)
def test_a_method_without_voxels_is_measured_as_it_is(row):
    for method in (ir.methods.PathTracing(spp=1), ir.methods.ConstantAmbient()):
        assert row.read(method, row.hard).error == 0


def test_a_picture_without_indirect_light_has_no_gaps_to_read():
    dark = ir.methods.ConstantAmbient(ambient=0.0)
    with pytest.raises(ValueError, match="no indirect light"):
        MAP.read(dark, 1.0)


def test_walls_without_voxels_let_the_sky_in():
    """The measure sees light: a room of which nothing is voxelized is as open as the sky, once for the floor that it shows."""
    empty = METHOD.replace(grid=ir.Grid(resolution=8, region=ir.Box(lower_x=5, lower_y=5, lower_z=5, upper_x=6, upper_y=6, upper_z=6)))
    reading = ROOF.read(empty, 0.05)
    assert isinstance(reading, Reading) and reading.error == pytest.approx(1, abs=0.05)
