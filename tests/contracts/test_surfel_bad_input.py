"""What illuminance composition must refuse in words, and what looks bad and is not."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import box

import interreflect as ir
from interreflect import _core, stages

SIZE = (24, 18)
METHOD = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=300), place_caches=ir.CacheGrid(nx=3, ny=3, nz=3), link=ir.ShLinks(links=16, near_rays=16),
)  # fmt: skip
GREY = ir.Material(albedo=(0.5,) * 3)


def room(*more, walls=None):
    lamp = ir.PointLight(position=(0.2, 0.6, 0.5), intensity=(1, 1, 1))
    view = ir.Camera(position=(0, 0, 0.95), target=(0, -0.3, -1), fov_x=90)
    return ir.Scene(meshes=[walls or box(inward=True, material=GREY), *more], lights=[lamp], cameras={"view": view})


@pytest.mark.parametrize(("make", "message"), [
    (lambda: ir.HaltonSurfels(surfels=0), r"HaltonSurfels.surfels must lie in \[1, 4.1943e\+06\], got 0"),
    (lambda: ir.RelaxedSurfels(surfels=-1), r"RelaxedSurfels.surfels must lie in \[1, 4.1943e\+06\], got -1"),
    (lambda: ir.XorshiftSurfels(surfels=1 << 23), r"XorshiftSurfels.surfels must lie in \[1, 4.1943e\+06\]"),
    (lambda: ir.ShLinks(bands=0), r"ShLinks.bands must lie in \[1, 8\], got 0"),
    (lambda: ir.RuntimeProjection(bands=9), r"RuntimeProjection.bands must lie in \[1, 8\], got 9"),
    (lambda: ir.ShLinks(links=0), r"ShLinks.links must lie in \[1, 65536\], got 0"),
    (lambda: ir.AllSurfels(bands=9), r"AllSurfels.bands must lie in \[1, 8\], got 9"),
    (lambda: ir.LightMap(texels=0), r"LightMap.texels must lie in \[1, 4096\] texels, got 0"),
    (lambda: ir.CacheGrid(nx=0), r"CacheGrid.nx must lie in \[1, 1024\], got 0"),
    (lambda: ir.SphericalHarmonicLobes(chrominance_bands=9), r"chrominance_bands must lie in \[0, 8\], got 9"),
    (lambda: METHOD.replace({"link.bands": 2, "evaluate.chrominance_bands": 3}), r"chrominance_bands must lie in \[0, 2\]"),
])  # fmt: skip
def test_a_number_out_of_range_is_named_with_its_bounds(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_caches_that_all_lie_in_solids_are_an_error():
    solid = box((-0.9,) * 3, (0.9,) * 3, material=GREY)
    one = METHOD.replace(place_caches=ir.CacheGrid(nx=1, ny=1, nz=1))
    with pytest.raises(ValueError, match=r"every cache of CacheGrid\(nx=1.*lies in a solid"):
        one.prepare(room(solid))
    assert one.render(room(), size=SIZE).indirect.max() > 0


def test_links_beyond_the_memory_are_an_error_before_any_ray():
    much = METHOD.replace({"place_caches": ir.CacheGrid(nx=20, ny=20, nz=20), "link.links": 65536, "link.bands": 8})
    with pytest.raises(ValueError, match="8000 caches with 65536 links of 132 bytes each are more than 4 GiB"):
        much.prepare(room())


@pytest.mark.parametrize(("texcoord", "message"), [
    (np.zeros((30, 2), np.float32), "must have 36 entries, three a triangle, got 30"),
    (np.full((36, 2), np.nan, np.float32), "of triangle 0 are not finite"),
    (np.full((36, 2), 9, np.float32), "beyond the map's 8 texels"),
    (np.zeros((36, 3), np.float32), "shape"),
    (np.zeros((36, 2)), "dtype float32, got float64"),
])  # fmt: skip
def test_texture_coordinates_of_a_light_map_that_do_not_fit_are_an_error(texcoord, message):
    core = room().core
    with pytest.raises(ValueError, match=message):
        _core.place_caches(ir.LightMap(texels=8), core, core, texcoord)


def test_texture_coordinates_that_overlap_or_are_missing_change_no_light_map():
    """A map has charts of its own: those of textures may overlap."""
    plain = box(inward=True, material=GREY)
    overlapping = ir.Mesh(plain.positions, plain.triangles, material=GREY, texcoords=np.zeros((len(plain.positions), 2)))
    places = [stages.place_caches(ir.LightMap(texels=16), room(walls=walls)).position for walls in (plain, overlapping)]
    assert len(places[0]) > 100 and (np.asarray(places[0]) == np.asarray(places[1])).all()


def test_triangles_without_area_carry_no_surfel_and_no_texel():
    plain = box(inward=True, material=GREY)
    first = np.asarray(plain.positions)[0]
    needle = ir.Mesh(np.stack([first, first * 0.5, first * 0.25]), np.array([(0, 1, 2)]), material=GREY)
    scene = room(needle)
    surfels = stages.place_surfels(ir.HaltonSurfels(surfels=300), scene)
    assert (np.asarray(surfels.triangle) < 12).all() and np.asarray(surfels.area).sum() == pytest.approx(24, rel=1e-4)
    for caches in (METHOD.place_caches, ir.LightMap(texels=12, grid=METHOD.place_caches)):
        image = METHOD.replace(place_caches=caches).render(scene, size=SIZE).image
        assert np.isfinite(image).all() and image.max() > 0


def test_fewer_surfels_than_links_are_all_linked():
    few = METHOD.replace({"place_surfels.surfels": 10, "link.links": 100})
    links = few.prepare(room()).state["links"]
    assert links.per_cache == 100 and np.asarray(links.node).max() < 2 * 10 - 1
    assert few.render(room(), size=SIZE).indirect.max() > 0
