import numpy as np
from welch import compare


def noisy(seed: int, bias: float = 0.0, n: int = 8) -> np.ndarray:
    """Pictures with multiplicative noise of 20 % about a gradient."""
    rng = np.random.default_rng(seed)
    truth = np.linspace(0.5, 2, 64)[None, None, :, None] * np.ones((n, 48, 1, 3))
    return (truth * (1 + bias + 0.2 * rng.standard_normal((n, 48, 64, 3)))).astype(np.float32)


def test_equal_renderers_give_uniform_p_values() -> None:
    found = compare(noisy(1), noisy(2))
    # 144 tests: 5 standard deviations of a binomial share around a half and around a twentieth
    assert abs(found.share_below(0.5) - 0.5) < 5 * np.sqrt(0.25 / 144)
    assert found.share_below(0.05) < 0.05 + 5 * np.sqrt(0.05 * 0.95 / 144)
    assert abs(found.mean_difference) < 5 * found.mean_error


def test_a_bias_of_one_per_cent_is_seen_in_the_mean() -> None:
    found = compare(noisy(1), noisy(2, bias=0.01))
    assert found.mean_difference > 5 * found.mean_error


def test_a_bias_in_one_corner_is_seen_by_its_tiles() -> None:
    other = noisy(2)
    other[:, :16, :16] *= 1.2
    found = compare(noisy(1), other)
    assert (found.p_values[:2, :2] < 1e-3).all()
