import numpy as np
import pytest

import interreflect as ir
from interreflect.methods.path_tracing_denoised import direct_share, resize


def test_resizing_keeps_constants_and_ramps() -> None:
    ramp = np.linspace(0, 1, 8, dtype=np.float32)[None, :, None] * np.ones((6, 1, 3), np.float32)
    assert np.allclose(resize(np.full((5, 7, 3), 0.25, np.float32), (20, 10)), 0.25)
    larger = resize(ramp, (32, 6))
    assert np.allclose(np.diff(larger[0, 2:-2, 0]), 1 / 28, atol=1e-6)  # 7 steps over 28 gaps, but for the clamped ends


def test_the_share_of_direct_light_is_taken_over_blocks() -> None:
    direct, indirect = np.zeros((16, 20, 3), np.float32), np.ones((16, 20, 3), np.float32)
    direct[:8, :8] = 3.0
    share = direct_share(direct, indirect)
    assert share.shape == (2, 3, 3)
    assert np.allclose(share[0, 0], 0.75) and share[1].max() == 0


@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_denoising_brings_a_picture_of_few_samples_closer_to_the_truth(scale: float) -> None:
    pytest.importorskip("pyoidn", reason="the extra `denoise` is not installed")
    # at half size a picture of 96 x 96 is so small that the ratio of errors lies between .36 and .78 over eight seeds; here below .2
    scene = ir.scenes.cornell_box()
    truth = ir.methods.PathTracing(spp=256, bounces=1).render(scene, size=(128, 128), seed=9)
    noisy = ir.methods.PathTracing(spp=1, bounces=1).render(scene, size=(128, 128))
    clean = ir.methods.PathTracingDenoised(spp=1, bounces=1, scale=scale).render(scene, size=(128, 128))
    for part in ("image", "indirect"):
        errors = [ir.metrics.relmse(getattr(frame, part), getattr(truth, part)) for frame in (noisy, clean)]
        assert errors[1] < 0.5 * errors[0]
    assert clean.image.mean() == pytest.approx(truth.image.mean(), rel=0.1)


def test_without_noise_nothing_is_changed() -> None:
    pytest.importorskip("pyoidn", reason="the extra `denoise` is not installed")
    scene = ir.scenes.cornell_box(light="point")
    truth = ir.methods.PathTracing(spp=1, bounces=0).render(scene, size=(64, 64))
    clean = ir.methods.PathTracingDenoised(spp=1, bounces=0).render(scene, size=(64, 64))
    assert np.allclose(clean.direct, truth.direct, atol=1e-6 * truth.direct.max())
