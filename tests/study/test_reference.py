"""Truth from a renderer whose noise is known: variance deviation^2 / spp of the indirect light."""

import numpy as np
import pytest
from study_fakes import FakePathTracing, Scene, truth_of

import interreflect
import interreflect.study.reference as reference_module
from interreflect import metrics
from interreflect.study.reference import Reference, converge, reference

SIZE = (64, 48)


def render(deviation, bias=0.0):
    def frame(spp, seed):
        made = FakePathTracing(spp=spp, deviation=deviation).prepare(Scene()).render(size=SIZE, seed=seed)
        made.indirect = made.indirect * np.float32(1 + bias)
        return made

    return frame


def test_the_noise_estimate_is_the_relmse_of_the_truth():
    truth = converge(render(2.0), Reference(noise=1e-9, max_spp=512), seed=3)
    exact = sum(truth_of(Scene(), SIZE))
    # both are means of 9,216 squares of normal numbers: standard error sqrt(2 / n) = 1.5 % each, four of their difference
    assert truth.noise == pytest.approx(metrics.relmse(truth.image, exact), rel=4 * 0.021)
    assert truth.indirect_noise == pytest.approx(metrics.relmse(truth.indirect, truth_of(Scene(), SIZE)[1]), rel=4 * 0.021)


def test_truths_of_real_path_tracing_are_as_noisy_as_they_say(monkeypatch, tmp_path):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path))
    scene = interreflect.scenes.cornell_box()
    a, b = (reference(scene, size=(48, 48), bounces=1, noise=1e-9, max_spp=64, seed=seed) for seed in (1, 2))
    between = 4 * metrics.relmse(a.indirect, (a.indirect + b.indirect) / 2)
    # two truths differ by the sum of their noise; over 120 pairs of seeds the ratio scattered by 4 %: five of that
    assert between == pytest.approx(a.indirect_noise + b.indirect_noise, rel=0.2)


def test_samples_double_until_the_noise_is_under_the_bound():
    truth = converge(render(2.0), Reference(noise=1e-3, max_spp=4096), seed=0)
    assert truth.noise <= 1e-3
    fewer = converge(render(2.0), Reference(noise=1e-9, max_spp=truth.spp // 2), seed=0)
    assert fewer.noise > 1e-3
    assert fewer.spp == truth.spp // 2


@pytest.mark.parametrize("max_spp", [2, 16, 100, 130])
def test_samples_never_exceed_the_largest_number(max_spp):
    drawn = []
    truth = converge(lambda spp, seed: drawn.append(spp) or render(1.0)(spp, seed), Reference(1e-12, max_spp), seed=0)
    assert truth.spp == sum(drawn) == max_spp


def test_halves_are_independent_and_average_to_the_truth():
    truth = converge(render(2.0), Reference(noise=1e-9, max_spp=64), seed=1)
    exact = sum(truth_of(Scene(), SIZE))
    a, b = (half - exact for half in truth.halves)
    correlation = float((a * b).mean() / np.sqrt((a**2).mean() * (b**2).mean()))
    assert abs(correlation) < 4 / np.sqrt(a.size)  # 4 standard errors
    np.testing.assert_allclose((truth.halves[0] + truth.halves[1]) / 2, truth.image, rtol=1e-6)
    np.testing.assert_allclose(truth.direct + truth.indirect, truth.image, rtol=1e-6)


def test_an_interrupted_truth_goes_on_where_it_was_and_ends_the_same(fake_truth, monkeypatch):
    wanted = {"scene": Scene(), "size": SIZE, "bounces": 1, "noise": 1e-12, "max_spp": 512}
    whole = reference(**wanted)
    for path in fake_truth.glob("*"):
        path.unlink()
    monkeypatch.setattr(reference_module, "SECONDS_AT_STAKE", -1.0)  # keep the halves after every round
    rendered, stop = [], [True]

    class Interrupted(FakePathTracing):
        def prepare(self, scene, threads=None):
            rendered.append(self.spp)
            if stop[0] and sum(rendered) > 100:
                raise KeyboardInterrupt
            return super().prepare(scene, threads)

    monkeypatch.setattr(reference_module, "path_tracer", lambda: Interrupted)
    monkeypatch.setattr(reference_module, "source_digest", lambda *_: "the same")
    with pytest.raises(KeyboardInterrupt):
        reference(**wanted)
    rendered.clear()
    stop[0] = False
    resumed = reference(**wanted)
    assert sum(rendered) < 512 - 50  # 8 + 8 + 16 + ... samples of each half were there
    np.testing.assert_array_equal(resumed.image, whole.image)
    assert (resumed.noise, resumed.spp) == (whole.noise, whole.spp)
    assert [path.name for path in fake_truth.iterdir()] == [f"{resumed.key}.npz"]


def test_no_stream_of_random_numbers_is_used_twice():
    seeds = []
    for seed in range(20):
        converge(lambda spp, s: seeds.append(s) or render(1.0)(spp, s), Reference(1e-12, 256), seed=seed)
    assert len(set(seeds)) == len(seeds)
    assert not set(seeds) & set(range(1000))  # a study's own seeds
    assert all(0 <= s < 2**31 for s in seeds)


def test_a_truth_that_is_not_finite_is_a_value_error():
    with pytest.raises(ValueError, match=r"indirect light has \d+ numbers that are not finite"):
        converge(render(1.0, bias=np.nan), Reference(), seed=0)


def test_the_truth_of_a_view_is_made_once(fake_truth, monkeypatch):
    first = reference(Scene(), size=SIZE, bounces=1)
    monkeypatch.setattr(reference_module, "converge", lambda *_: pytest.fail("made again"))
    again = reference(Scene(), "front", size=SIZE, bounces=1)
    for name in ("image", "direct", "indirect", "halves"):
        np.testing.assert_array_equal(getattr(first, name), getattr(again, name))
    assert (first.noise, first.indirect_noise, first.spp, first.key) == (again.noise, again.indirect_noise, again.spp, again.key)


@pytest.mark.parametrize(
    "other",
    [
        {"size": (65, 48)},
        {"bounces": 2},
        {"bounces": None},
        {"noise": 2e-3},
        {"max_spp": 64},
        {"seed": 1},
        {"scene": Scene(level=2.0)},
    ],
)
def test_whatever_determines_a_truth_makes_another_truth(fake_truth, other):
    given = {"scene": Scene(), "size": SIZE, "bounces": 1}
    assert reference(**given).key != reference(**(given | other)).key


def test_repaired_sources_make_new_truths(fake_truth, monkeypatch):
    before = reference(Scene(), size=SIZE).key
    monkeypatch.setattr(reference_module, "source_digest", lambda *_: "repaired")
    assert reference(Scene(), size=SIZE).key != before


def test_a_camera_that_is_not_there_is_a_value_error(fake_truth):
    with pytest.raises(ValueError, match=r"has no camera 'back'; it has \['front'\]"):
        reference(Scene(), "back", size=SIZE)
    with pytest.raises(ValueError, match="has no camera"):
        reference(Scene(cameras={}), size=SIZE)


def test_a_black_scene_has_no_noise(fake_truth):
    assert reference(Scene(level=0.0), size=SIZE).noise == 0.0
