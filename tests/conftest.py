import pytest


@pytest.fixture(scope="session", autouse=True)
def own_locks(tmp_path_factory):
    """Tests wait for no other study on this machine, and no other waits for them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("INTERREFLECT_LOCKS", str(tmp_path_factory.mktemp("locks")))
        yield
