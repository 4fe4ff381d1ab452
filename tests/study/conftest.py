import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import study_fakes

import interreflect.study.reference as reference_module


@pytest.fixture
def fake_truth(monkeypatch, tmp_path):
    """Truths by FakePathTracing, cached in a folder of this test, which is returned."""
    monkeypatch.setattr(reference_module, "path_tracer", lambda: study_fakes.FakePathTracing)
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "references"
