"""Tools that share a folder do not take each other's records for theirs."""

from study_fakes import Fake, Scene

from interreflect.study.measured import measured, study_folder, words
from interreflect.study.run import run
from interreflect.study.study import Study


def test_another_studys_list_in_the_folder_does_no_harm(fake_truth, tmp_path, monkeypatch):
    import interreflect.study.measured as module

    def study(name, *methods):
        return Study(name=name, scenes=[Scene()], methods=methods, size=(24, 16), seeds=(0, 1), repeats=1, images=False)

    def run_and_be_overtaken(mine, folder):
        run(mine, folder)
        return run(study("other", Fake(error=0.9)), folder)

    monkeypatch.setattr(module, "run", run_and_be_overtaken)
    groups = measured(study("mine", Fake(error=0.1), Fake(error=0.2)), tmp_path / "a")
    assert [[(record.knobs["error"], record.seed) for record in group] for group in groups] == [[(0.1, 0), (0.1, 1)], [(0.2, 0), (0.2, 1)]]


def test_a_setting_is_named_by_the_knobs_that_differ_from_the_defaults():
    assert words(Fake(error=0.3)) == "fake error=0.3"
    assert words(Fake()) == "fake"


def test_folders_tell_what_was_measured_apart():
    assert study_folder("ladder", Scene(), "front") != study_folder("ladder", Scene(), "side")
    assert study_folder("ladder", Scene("a b/c"), "front").name.startswith("ladder-a-b-c-")
