import os
from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def own_cache_folder(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """No test reads or fills the user's cache."""
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path_factory.mktemp("cache")))


@pytest.fixture(scope="session")
def shared_scenes() -> Path:
    """The folder of downloaded scenes; a test that needs it is skipped where it is absent."""
    project = Path(__file__).resolve().parents[2]
    for folder in (os.environ.get("INTERREFLECT_SCENES"), project.parent / "shared" / "scenes"):
        if folder and Path(folder).is_dir():
            return Path(folder)
    pytest.skip("the downloaded scenes (../shared/scenes or INTERREFLECT_SCENES) are absent")
