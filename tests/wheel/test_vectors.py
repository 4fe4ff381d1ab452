"""Kernels run on the vectors that INTERREFLECT_VECTORS forces, and every method's picture is the same on each but for rounding."""

import os
import subprocess
import sys

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core

BITS = {"sse4": 128, "avx2": 256, "avx512": 512}
METHODS = [name for name in dir(ir.methods) if isinstance(getattr(ir.methods, name), type)]
SIZE = (64, 48)
PICTURES = """
import sys
import numpy as np
import interreflect as ir

scene, small = ir.scenes.cornell_box(), ir.LightMap(texels=32, grid=ir.CacheGrid(nx=6, ny=6, nz=6))
knobs = {"IlluminanceComposition": {"place_surfels": ir.HaltonSurfels(surfels=2048), "place_caches": small}}
pictures = {}
for name in sys.argv[3:]:
    method = getattr(ir.methods, name)(**knobs.get(name, {}))
    frame = method.render(scene, size=(int(sys.argv[1]), int(sys.argv[2])), seed=1)
    pictures[name] = frame.image
np.savez(sys.stdout.buffer, vectors=ir.about().vectors, bits=ir.about().vector_bits, **pictures)
"""


def python(code, vectors, *arguments):
    environment = os.environ | {"INTERREFLECT_VECTORS": vectors}
    return subprocess.run([sys.executable, "-c", code, *arguments], env=environment, capture_output=True, check=False)


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    """Of every method by every target of this machine."""
    made = {}
    for target in _core.vector_targets():
        done = python(PICTURES, target, *map(str, SIZE), *METHODS)
        assert done.returncode == 0, f"{target}: {done.stderr.decode()}"
        path = tmp_path_factory.mktemp("vectors") / f"{target}.npz"
        path.write_bytes(done.stdout)
        made[target] = np.load(path)
    return made


@pytest.fixture(scope="module")
def truths():
    scene = ir.scenes.cornell_box()
    return {bounces: ir.reference(scene, size=SIZE, bounces=bounces, noise=1e-3, max_spp=512).image for bounces in (1, None)}


def of_target(pictures, target):
    return pictures[target] if target in pictures else pytest.skip(f"this machine has no {target}")


@pytest.mark.parametrize("target", BITS)
def test_kernels_run_on_the_vectors_that_are_forced_and_say_so(pictures, target):
    made = of_target(pictures, target)
    assert (made["vectors"], made["bits"]) == (target, BITS[target])


def test_kernels_run_on_the_widest_vectors_where_none_are_forced():
    forced = os.environ.get("INTERREFLECT_VECTORS")
    assert ir.about().vectors == (forced or _core.vector_targets()[-1]) and ir.about().vector_bits == BITS[ir.about().vectors]


@pytest.mark.parametrize("target", BITS)
@pytest.mark.parametrize("name", METHODS)
def test_every_target_makes_the_picture_of_the_widest_one(pictures, truths, name, target):
    """Without a thousandth of the terms: where a ray meets an edge, targets may see its other side."""
    made, widest = of_target(pictures, target)[name], pictures[_core.vector_targets()[-1]][name]
    error = ir.metrics.trimmed_relmse(widest, truths[getattr(ir.methods, name)().bounces])
    assert np.isfinite(made).all() and ir.metrics.trimmed_relmse(made, widest) < 0.1 * error


@pytest.mark.parametrize("name", ["sse2", "AVX2", ""])
def test_a_name_that_is_no_target_is_an_error(name):
    for code in ("import interreflect._core", "import interreflect as ir; ir.about()"):
        done = python(code, name)
        assert done.returncode != 0 and f"INTERREFLECT_VECTORS must be sse4, avx2 or avx512, got '{name}'" in done.stderr.decode()


def test_a_target_that_this_machine_lacks_is_an_error():
    lacking = [target for target in BITS if target not in _core.vector_targets()]
    if not lacking:
        pytest.skip("this machine has every target")
    done = python("import interreflect._core", lacking[0])
    assert done.returncode != 0 and f"INTERREFLECT_VECTORS is {lacking[0]}, which this machine lacks" in done.stderr.decode()
