"""The bench's bookkeeping: rows as the targets' check reads them, limits, tiles, errors. Nothing here is timed."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from bench import limits, rows
from bench.calibration import TARGETS_MACHINE, cosine_directions, tiled
from bench.path_rows import Measured, compared, equal_error, smoothed
from bench.sponza import soup

import interreflect as ir

KEYS = {"name", "milliseconds", "limit_milliseconds", "peer", "peer_milliseconds", "target", "met"}


def test_rows_are_written_as_the_check_of_the_targets_reads_them(tmp_path):
    made = [
        rows.at_most_times("a", 15.0, 5.0, "peer", 10.0, 1.6),
        rows.times_sooner("b", 5.0, 1.0, "peer", 10.0, 3.0),
        rows.within("c", 200.0, None, 160.0, 1.5),
        rows.absent("d", "3x sooner", "not present"),
    ]
    rows.write(made, tmp_path / "bench" / "suite.json")
    read = json.loads((tmp_path / "bench" / "suite.json").read_text())
    assert all(row.keys() >= KEYS for row in read)
    assert [row["met"] for row in read] == [True, False, True, None]
    assert read[3]["milliseconds"] is None
    assert read[3]["note"] == "not present"


def test_a_figure_that_is_not_a_number_is_not_written(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        rows.write([rows.within("a", float("nan"), None, 1.0)], tmp_path / "suite.json")


def test_rows_of_one_name_are_refused(tmp_path):
    with pytest.raises(ValueError, match="a name of its own"):
        rows.write([rows.absent("a", "", ""), rows.absent("a", "", "")], tmp_path / "suite.json")


def test_every_limit_is_positive_and_grows_with_the_work():
    c = TARGETS_MACHINE
    made = [
        lambda n: limits.hierarchy(c, n, n),
        lambda n: limits.gbuffer(c, n),
        lambda n: limits.sun_shadows(c, n),
        lambda n: limits.path_sample(c, n, 1),
        lambda n: limits.cone_march(c, n),
        lambda n: limits.voxel_frame(c, n, n, n, n),
        lambda n: limits.voxelize(c, n, n, n, n),
        lambda n: limits.light_map(c, n),
        lambda n: limits.inject(c, n, n),
        lambda n: limits.distribute(c, n),
        lambda n: limits.create(c, n, n),
        lambda n: limits.evaluate(c, n, n),
        lambda n: limits.trace_lights(c, n, n),
        lambda n: limits.prefilter(c, n, n),
        lambda n: limits.reflective_map(c, n),
        lambda n: limits.cluster(c, n, n),
        lambda n: limits.imperfect_maps(c, n, n),
        lambda n: limits.virtual_lights(c, n, n, n),
    ]
    for limit in made:
        assert 0 < limit(1000) < limit(2000)


def test_the_limit_of_a_path_is_that_of_its_rays():
    # 0.9216 million pixels; rates of the table: primary 42, sun 50, occlusion 34, shared bounce 20 million a second
    rays = 1 / 42 + 1 / 50 + 1 / 34 + (1 / 20 + 2 / 34)
    assert limits.path_sample(TARGETS_MACHINE, 921_600, 1) == pytest.approx(921.6 * rays, rel=1e-12)


def test_tiles_keep_every_pixel_once_with_packets_of_neighbours():
    image = np.stack(np.meshgrid(np.arange(48), np.arange(32)), -1)
    pixels = tiled(image)
    assert len(np.unique(pixels, axis=0)) == 48 * 32 == len(pixels)
    packets = pixels.reshape(-1, 16, 2)
    assert (np.ptp(packets, 1) == 3).all()
    assert (np.ptp(pixels.reshape(-1, 256, 2), 1) == 15).all()


def test_cosine_directions_have_the_moments_of_a_lambertian_lobe():
    n = 200_000
    u = np.random.default_rng(3).random((n, 2))
    d = cosine_directions(np.tile(np.float32([0, 0, 1]), (n, 1)), u)
    # E[cos] = 2/3 with variance 1/2 - 4/9; 5 standard errors, and 2e-4 for the sphere kept off the pole
    assert d[:, 2].mean() == pytest.approx(2 / 3, abs=5 * np.sqrt((1 / 2 - 4 / 9) / n) + 2e-4)
    assert np.allclose(np.linalg.norm(d, axis=1), 1, atol=1e-6)


def test_equal_error_asks_for_as_many_samples_as_the_variance_says():
    row = equal_error("a", Measured(100, 0.5, 1), Measured(300, 1.0, 1), "peer", 3.0, 10.0)
    assert row.milliseconds == 50  # half the variance: half the samples
    assert row.met
    assert not equal_error("a", Measured(100, 2.0, 1), Measured(300, 1.0, 1), "peer", 3.0, 10.0).met


def test_variance_is_measured_between_seeds_and_relative_to_the_picture():
    def noisy(seed):
        return np.random.default_rng(seed).normal(10, 1, (64, 64, 3)), 7.0

    measured = compared(noisy)[0]
    # variance 1 over 10^2 (1 + 0.01); 12288 x 4 degrees of freedom: 5 standard errors are 3.2 %
    assert measured.variance == pytest.approx(1 / 101, rel=0.035)
    assert measured.milliseconds == 7.0


def test_a_smoothed_picture_keeps_its_mean():
    picture = np.random.default_rng(5).random((16, 24, 3))
    assert smoothed(picture).mean() == pytest.approx(picture.mean(), rel=1e-12)
    assert np.ptp(smoothed(picture)[:8, :8], axis=(0, 1)).max() == 0


def test_a_soup_has_every_triangle_of_the_scene_in_the_world():
    scene = ir.scenes.cornell_box()
    positions, triangles = soup(scene)
    assert len(triangles) == scene.triangles
    assert np.allclose([positions.min(0), positions.max(0)], scene.bounds, atol=1e-6)
