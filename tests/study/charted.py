"""A study of fake methods whose records charts and pages show."""

from study_fakes import TRUTH, Fake, Scene

from interreflect.study.run import run
from interreflect.study.store import load_records
from interreflect.study.study import Study, sweep


class Rival(Fake):
    """The same under another name."""

    name = "rival"


METHODS = [
    *sweep(Fake, {"error": [0.1, 0.4]}),
    Rival(error=0.2, time=0.5),
    Rival(error=0.05, time=9.0),
    Fake(mode="raises"),
    Fake(mode="nan"),
]


def measure(folder, monkeypatch, seeds=(0,)):
    """Its records: two scenes, six methods of which two fail."""
    monkeypatch.setenv(TRUTH, "1")
    monkeypatch.setenv("INTERREFLECT_CACHE", str(folder / "cache"))
    scenes = [Scene(), Scene("<bright & wide>", 3.0)]
    run(Study(name="a < b?", scenes=scenes, methods=METHODS, size=(24, 16), repeats=1, seeds=seeds), folder / "r")
    return load_records(folder / "r")
