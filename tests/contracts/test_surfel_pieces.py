"""Pieces of illuminance composition's precomputation: shared between methods, and kept in files."""

from __future__ import annotations

import random
from collections import Counter

import numpy as np
import pytest
from voxel_scenes import box

import interreflect as ir
from interreflect import _core
from interreflect.methods import composition_pieces, stored
from interreflect.study.files import DamagedFile
from interreflect.study.plan import Limits, Plan

SIZE = (24, 18)
METHOD = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=300), place_caches=ir.CacheGrid(nx=3, ny=3, nz=3),
    link=ir.ShLinks(links=16, near_rays=16),
)  # fmt: skip
WITH_MAP = METHOD.replace(place_caches=ir.LightMap(texels=24, grid=ir.CacheGrid(nx=3, ny=3, nz=3)))
STAGES = ("place_surfels", "cluster_surfels", "place_caches", "link")


def room(cube=0.0, albedo=0.5):
    pose = np.eye(4)
    pose[1, 3] = cube
    body = box((-0.3,) * 3, (0.3,) * 3, body="cube", material=ir.Material(albedo=(0.9,) * 3))
    walls = box(inward=True, material=ir.Material(albedo=(albedo,) * 3))
    lamp = ir.PointLight(position=(0.2, 0.6, 0.5), intensity=(1, 1, 1))
    view = ir.Camera(position=(0, 0, 0.95), target=(0, -0.3, -1), fov_x=90)
    return ir.Scene(meshes=[body, walls], lights=[lamp], bodies={"cube": pose}, cameras={"view": view})


@pytest.fixture
def made(monkeypatch):
    """How often every stage of the precomputation ran."""
    counts = Counter()

    def counted(name, stage):
        def run(*given):
            counts[name] += 1
            return stage(*given)

        return run

    for name in STAGES:
        monkeypatch.setattr(composition_pieces, name, counted(name, getattr(composition_pieces, name)))
    monkeypatch.setattr(_core, "shared_cut", counted("cut", _core.shared_cut))
    return counts


VARIANTS = [
    {}, {"link.bands": 1}, {"link.bands": 8}, {"evaluate.chrominance_bands": 2}, {"evaluate": ir.DirectLinks()}, {"bounces": 3},
    {"link": ir.RuntimeProjection(links=16, near_rays=16)}, {"link": ir.RuntimeProjection(links=16, near_rays=16, bands=6)},
]  # fmt: skip


def test_methods_that_differ_in_bands_projection_or_evaluation_share_one_cut_and_give_the_same_bits(made):
    pieces = ir.Pieces()
    for changes in VARIANTS:
        method = METHOD.replace(changes)
        shared = method.prepare(room(), pieces=pieces).render(size=SIZE)
        apart = method.render(room(), size=SIZE)
        assert (shared.image == apart.image).all() and shared.indirect.max() > 0, changes
    assert (made["cut"], made["link"]) == (1, len(VARIANTS))  # made apart: a link each
    assert made["place_surfels"] == made["cluster_surfels"] == made["place_caches"] == 1 + len(VARIANTS)


def test_another_cut_keeps_the_tree_and_other_surfels_keep_the_sites(made):
    pieces = ir.Pieces()
    for changes in ({}, {"link.links": 8}, {"link.pull": "radiosity"}, {"cluster_surfels": ir.KdTree()}):
        METHOD.replace(changes).prepare(room(), pieces=pieces)
    assert made == {"place_surfels": 1, "cluster_surfels": 2, "place_caches": 1, "cut": 4}


def test_pieces_of_another_scene_are_let_go(made):
    pieces = ir.Pieces()
    METHOD.prepare(room(), pieces=pieces)
    other = METHOD.prepare(room(albedo=0.1), pieces=pieces).render(size=SIZE)
    assert made["cut"] == 2
    assert (other.image == METHOD.render(room(albedo=0.1), size=SIZE).image).all()


def test_two_hundred_methods_of_a_study_in_any_order_share_ten_precomputations(made, tmp_path):
    methods = ir.sweep(METHOD, {
        "place_surfels.surfels": [100, 200, 300, 400, 500], "link.links": [4, 8], "link.bands": [2, 3, 4, 5, 6],
        "evaluate.chrominance_bands": [0, 2], "shadow": [ir.TracedShadows(samples=1), ir.TracedShadows(samples=2)],
    })  # fmt: skip
    random.Random(1).shuffle(methods)
    assert len(methods) == 200
    study = ir.Study(name="many", scenes=[room()], methods=methods, size=SIZE, reference=ir.Reference(noise=1, max_spp=2))
    pieces = ir.Pieces()
    with Plan(study, tmp_path, Limits()) as plan:
        for index in plan._order():
            plan.cells[index].method.prepare(room(), pieces=pieces)
    assert made == {"place_surfels": 5, "cluster_surfels": 5, "place_caches": 1, "cut": 10}


def test_a_piece_that_was_taken_counts_what_it_took_to_make():
    pieces = ir.Pieces()
    first = METHOD.prepare(room(), pieces=pieces).precompute_milliseconds
    kept = sum(piece.milliseconds for piece in pieces._kept.values())
    again = METHOD.replace({"link.bands": 2}).prepare(room(), pieces=pieces).precompute_milliseconds
    assert 0 < kept <= first and again >= kept


def test_records_of_cells_that_share_have_the_time_of_a_whole_precomputation(tmp_path):
    methods = [METHOD.replace({"link.bands": bands}) for bands in (2, 3, 4)]
    study = ir.Study(
        name="shared", scenes=[room()], methods=methods, size=SIZE, reference=ir.Reference(noise=1, max_spp=2), repeats=0,
        images=False,
    )  # fmt: skip
    table = ir.run(study, tmp_path).table
    assert (table.status == "ok").all()
    first, *others = table.precompute_milliseconds
    # What is shared counts with the time that it took once; what a cell does by itself may take any time.
    assert all(other > 0.5 * first for other in others), table.precompute_milliseconds


def test_what_is_precomputed_does_not_depend_on_where_bodies_are():
    here, there = (METHOD.prepare(room(cube)).state["links"] for cube in (0.0, 0.5))
    assert (here.node == there.node).all()
    frames = [METHOD.prepare(room(cube)).render(size=SIZE, scene=room(0.2)) for cube in (0.0, 0.5)]
    assert (frames[0].image == frames[1].image).all()


@pytest.mark.parametrize("changes", [
    {"place_caches": WITH_MAP.place_caches}, VARIANTS[-1], {"link": ir.AllSurfels(samples=50)},
    {"place_caches": ir.PixelCaches(), "bounces": 2},
])  # fmt: skip
def test_what_was_saved_comes_back_bit_by_bit(tmp_path, changes):
    method = METHOD.replace(changes)
    prepared = method.prepare(room())
    prepared.save(tmp_path / "room.prepared")
    back = method.replace({"shadow.samples": 8}).load(tmp_path / "room.prepared", room(cube=0.5))
    assert back.precompute_milliseconds == prepared.precompute_milliseconds
    frames = [one.render(size=SIZE, scene=room()) for one in (prepared, back)]
    assert (frames[0].image == frames[1].image).all() and frames[0].indirect.max() > 0
    assert [path.name for path in tmp_path.iterdir()] == ["room.prepared"]


@pytest.fixture(scope="module")
def content(tmp_path_factory):
    path = tmp_path_factory.mktemp("saved") / "room.prepared"
    WITH_MAP.prepare(room()).save(path)
    return path.read_bytes()


@pytest.fixture
def saved(tmp_path, content):
    path = tmp_path / "room.prepared"
    path.write_bytes(content)
    return path


def flip(data, at):
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


@pytest.mark.parametrize(("change", "error", "message"), [
    (lambda data: flip(data, len(data) // 2), DamagedFile, "content and checksum differ"),
    (lambda data: flip(data, 40), DamagedFile, "content and checksum differ"),  # of the checksum
    (lambda data: data[:-1], DamagedFile, "cut short"),
    (lambda data: data[: len(data) // 2], DamagedFile, "cut short"),
    (lambda data: b"", ValueError, "not a precomputation"),
    (lambda data: b"v/1" + data, ValueError, "not a precomputation"),
    (lambda data: data.replace(b"precomputation 2\n", b"precomputation 7\n"), ValueError, "format version must be 2, got 7"),
])  # fmt: skip
def test_a_damaged_file_is_an_error_that_names_it(saved, change, error, message):
    saved.write_bytes(change(saved.read_bytes()))
    with pytest.raises(error, match=rf"room\.prepared: .*{message}"):
        WITH_MAP.load(saved, room())


def test_a_file_of_another_scene_or_of_other_knobs_is_an_error_that_says_so(saved, tmp_path):
    with pytest.raises(ValueError, match="made from another scene"):
        WITH_MAP.load(saved, room(albedo=0.4))
    with pytest.raises(ValueError, match=r"links=16.*not with.*links=17"):
        WITH_MAP.replace({"link.links": 17}).load(saved, room())
    with pytest.raises(ValueError, match="made by IlluminanceComposition"):
        ir.methods.VirtualAreaLights().load(saved, room())
    with pytest.raises(FileNotFoundError):
        WITH_MAP.load(tmp_path / "nowhere", room())


def last(value):
    """That number in place of an array's last."""

    def change(array):
        changed = np.array(array)
        changed[(-1,) * changed.ndim] = value
        return changed

    return change


@pytest.mark.parametrize(("name", "change", "message"), [
    ("surfels.triangle", last(12), "a triangle that the still surface lacks"),
    ("surfels.position", last(np.nan), "not finite"),
    ("surfels.area", last(-1), "not finite"),
    ("surfels.normal", lambda a: a[:-1], "different lengths"),
    ("surfels.normal", lambda a: np.ascontiguousarray(a[:, :2]), "another shape"),
    ("surfels.area", lambda a: a.astype(float), "dtype float32, got float64"),
    ("surfels.leaves", last(7), "not the next in post-order"),
    ("surfels.leaf_end", last(7), "not the next in post-order"),
    ("surfels.node", last(0), "not the next in post-order"),
    ("surfels.leaves", lambda a: a[:-2], "nodes, got"),
    ("surfels.extent", lambda _: "wide", "not a number of its kind"),
    ("sites.map_cache", last(4_000_000), "a cache that is not there"),
    ("sites.grid_cache", last(4_000_000), "a cache that is not there"),
    ("sites.grid_nearest", lambda a: a[:-1], "a box of 27 cells"),
    ("sites.nx", lambda n: -n, "a box of"),
    ("sites.map_size", lambda n: n + 1, "a light map of 25 texels"),
    ("sites.map_texcoord", lambda a: a[:3], "3 corners"),
    ("sites.map_triangle", last(12), "a chart of a triangle that the still surface lacks"),
    ("sites.map_texcoord", last(1e30), "beyond the light map"),
    ("links.link_node", last(2**20), "a node that is not there"),
    ("links.coefficients", lambda a: a[:-80], "arrays of other lengths"),
    ("links.per_cache", lambda n: n + 1, "arrays of other lengths"),
    ("links.caches", lambda n: n - 1, "caches and"),
    ("links.unit", lambda _: 0.0, "their unit"),
    ("links.bands", lambda _: 9, "bands out of range"),
])  # fmt: skip
def test_a_file_whose_numbers_do_not_fit_is_an_error_that_names_them(saved, name, change, message):
    """As someone would write it who knows the checksum."""
    belongs, values = stored.read(saved)
    values[name] = change(values[name])
    stored.write(saved, belongs, values)
    with pytest.raises(ValueError, match=rf"room\.prepared: .*{message}"):
        WITH_MAP.load(saved, room())


def test_a_file_that_lacks_an_array_is_an_error(saved):
    belongs, values = stored.read(saved)
    del values["sites.normal"]
    stored.write(saved, belongs, values)
    with pytest.raises(ValueError, match="lack normal"):
        WITH_MAP.load(saved, room())
