"""Truths of these tests are shared by their files and kept nowhere else."""

import pytest


@pytest.fixture(autouse=True, scope="session")
def _cache_of_its_own(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("INTERREFLECT_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield
