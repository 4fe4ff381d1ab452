"""Tools that share a folder do not take each other's records for theirs."""

from study_fakes import Fake, Scene

import interreflect.cache as cache
from interreflect.study.locks import Claims
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


def tool_study(name, error):
    """A study in the cache, as tools make them."""
    folder = study_folder(name, Scene())
    measured(Study(name=name, scenes=[Scene()], methods=[Fake(error=error)], size=(24, 16), seeds=(0, 1), repeats=0), folder)
    return folder


def test_the_cache_knows_the_studies_of_the_tools(fake_truth):
    folder = tool_study("ladder", 0.1)
    (entry,) = (entry for entry in cache.entries() if entry.kind == "studies")
    files = [path for path in folder.rglob("*") if path.is_file()]
    assert (entry.path, entry.files, entry.bytes) == (folder, len(files), sum(path.stat().st_size for path in files))
    assert len(files) >= 6  # the list, the claims, two records and their pictures
    assert cache.clear("studies") == len(files) and not folder.exists()


def test_the_studies_of_the_tools_share_the_caches_size_and_the_least_recently_used_goes_first(fake_truth, monkeypatch):
    first = tool_study("ladder", 0.1)
    room = sum(entry.bytes for entry in cache.entries()) + 100
    monkeypatch.setattr(cache.trim, "__defaults__", (room, None))
    second = tool_study("search", 0.2)
    assert not first.exists() and second.exists()


def test_a_study_that_runs_is_not_taken_from_the_cache(fake_truth):
    folder = tool_study("ladder", 0.1)
    running = Claims(folder)
    assert running.take("f" * 32)
    assert cache.trim(0) > 0 and cache.clear("studies") == 0 and folder.exists()
    running.close()
    assert cache.clear("studies") > 0 and not folder.exists()
