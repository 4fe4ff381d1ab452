import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import study_fakes


@pytest.fixture
def fake_truth(monkeypatch, tmp_path):
    """Truths by FakePathTracing, cached in a folder of this test, which is returned."""
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv(study_fakes.TRUTH, "1")
    return tmp_path / "cache" / "references"
