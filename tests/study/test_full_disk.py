"""A disk without room: the study stops and says so, and what was written before is whole."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest
from study_fakes import Fake, Scene

from interreflect.study.files import DiskFull, replacing
from interreflect.study.run import run
from interreflect.study.store import load_records
from interreflect.study.study import Study

SIZE = (64, 48)  # 74 kB of pictures a cell


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 512 KiB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=512k", "tmpfs", str(folder)], capture_output=True, check=False).returncode:
        pytest.skip("mounting a small file system is not permitted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def study_of(cells):
    return Study(name="full", scenes=[Scene()], methods=[Fake(error=0.01 * k) for k in range(cells)], size=SIZE, repeats=1, max_repeats=1)


def test_a_full_disk_stops_the_study_with_an_error_that_says_so(small_disk, fake_truth):
    with pytest.raises(DiskFull, match=r"no room for .*; what was written before is whole") as stopped:
        run(study_of(20), small_disk / "r")
    assert stopped.value.errno == errno.ENOSPC
    kept = load_records(small_disk / "r")
    assert 0 < len(kept) < 20 and not kept.damaged
    assert all(kept.has_images(record) and kept.images(record)[0].shape == (48, 64, 3) for record in kept)
    assert not list(small_disk.rglob("*.part"))


def test_with_room_again_the_study_goes_on(small_disk, fake_truth):
    with pytest.raises(DiskFull):
        run(study_of(20), small_disk / "r")
    before = len(load_records(small_disk / "r"))
    subprocess.run(["mount", "-o", "remount,size=4m", str(small_disk)], check=True)
    after = run(study_of(20), small_disk / "r")
    assert len(after) == 20 > before and not after.damaged


def test_a_quota_on_the_size_of_files_says_so_too(tmp_path):
    """Where no file system can be mounted: the kernel refuses to let a file grow."""
    code = f"""
import resource, signal, sys
from pathlib import Path
sys.path.insert(0, {str(Path(__file__).parents[2] / "python")!r})
from interreflect.study.files import DiskFull, replacing
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
try:
    with replacing(Path({str(tmp_path)!r}) / "large") as file:
        file.write(bytes(5000))
except DiskFull as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert f"no room for {tmp_path / 'large'}" in done.stdout
    assert not list(tmp_path.iterdir())


def test_other_errors_stay_what_they_are(tmp_path):
    with pytest.raises(OSError) as found, replacing(tmp_path / "a"):
        raise OSError(errno.EIO, os.strerror(errno.EIO))
    assert not isinstance(found.value, DiskFull)
