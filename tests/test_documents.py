"""What the documents promise runs: the README's program, every block of code in docs, and the contract of the interface where it lies
beside the repository. (What is generated is run by test_docs.py, the page on adding a technique by test_adding_a_technique.py.)"""

import ast
import re
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import interreflect as ir

ROOT = Path(__file__).parents[1]
CONTRACT = ROOT.parent / "shared" / "API.md"
# Sections of the contract whose parts exist.
SECTIONS = ("scenes", "one picture", "truth", "stages by hand", "studies", "the three questions")
# The contract allows smaller sizes, fewer samples and repeats.
SMALLER = {
    "(640, 360)": "(48, 32)",
    "(320, 180)": "(32, 18)",
    "[method], ir.stability.failures)": "[method], ir.stability.failures[:1])",
    "ir.sensitivity(method, scene)": "ir.sensitivity(ir.methods.ConstantAmbient(), scene, size=(16, 9))",
    "ir.advise(scene)": "ir.advise(scene, size=(32, 18))",
    "max_spp=4096": "max_spp=8",
    "[32, 64, 128, 256]": "[8, 16]",
    "resolution=128": "resolution=16",
    "range(3)": "range(2)",
    "frames=30": "frames=2",
    "repeats=5, max_repeats=30": "repeats=1, max_repeats=1",
    "scenes=[ir.scenes.cornell_box(), scene]": "scenes=[ir.scenes.cornell_box()]",
    "(1, 4, 16)": "(1, 4)",
}


# Of the pages in docs: what is made smaller in each.
PAGES = {
    "index": {"(320, 240)": "(32, 24)", "max_spp=64": "max_spp=4"},
    "statistics": {"(160, 120)": "(32, 24)", "max_spp=256": "max_spp=4"},
    "scene_format": {"(160, 120)": "(32, 24)"},
    "three_questions": {
        "(160, 90)": "(32, 18)",  # as in the README, so that what both ask is measured once
        "resolution=64": "resolution=16",
        "range(3)": "range(2)",
        "max_spp=256": "max_spp=8",
        "[6, 20, 40]": "[6, 20]",
        "frames=8": "frames=2",
        "ir.stability.invariance(method, scene)": "ir.stability.invariance(method, size=(32, 24), seeds=range(2))",
        "ir.sensitivity(method, scene, ": "ir.sensitivity(ir.methods.ConstantAmbient(), scene, ",
        "ir.advise(scene)": "ir.advise(scene, size=(32, 18))",
    },
    "live_view": {"lines=270": "lines=24"},
    "studies_at_scale": {"tcp://10.0.0.1:8786": "{address}"},
}
TRIANGLES = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 3 2\nf 1 4 3\n"


def program(text):
    return "\n".join(re.findall(r"```python\n(.*?)```", text, re.DOTALL))


def run_each_statement(code, names):
    for statement in ast.parse(code).body:
        exec(ast.unparse(statement), names)
    return names


def test_the_program_in_the_readme_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = program((ROOT / "README.md").read_text())
    smaller = {"(320, 180)": "(48, 32)", "max_spp=64": "max_spp=4", "[16, 32, 64]": "[8, 16]", "resolution=64": "resolution=16"}
    smaller |= {"(160, 90)": "(32, 18)", "frames=8": "frames=2"}
    smaller |= {long: SMALLER[long] for long in ("[method], ir.stability.failures)", "ir.advise(scene)")}
    smaller |= {"ir.sensitivity(method,": "ir.sensitivity(ir.methods.ConstantAmbient(),"}
    for long, short in smaller.items():
        assert long in code
        code = code.replace(long, short)
    names = run_each_statement(code, {})
    assert (tmp_path / "atrium.png").stat().st_size > 0 and (tmp_path / "speed_accuracy.pdf").stat().st_size > 0
    assert len(names["records"]) == 3


@pytest.mark.skipif(not CONTRACT.exists(), reason="the interface's contract does not lie beside the repository")
def test_the_contract_of_the_interface_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = program(CONTRACT.read_text())
    sections = re.split(r"# --- ([a-z ]+) -+\n", code)
    chosen = "".join(body for title, body in zip(sections[1::2], sections[2::2], strict=True) if title.strip() in SECTIONS)
    for long, short in SMALLER.items():
        assert long in chosen, long
        chosen = chosen.replace(long, short)
    shifted = np.eye(4)
    shifted[0, 3] = 0.5
    names = {
        "ir": ir,
        "positions": np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], np.float32),
        "triangles": np.array([[0, 2, 1], [0, 3, 2]], np.uint32),
        "matrix": shifted,
        "matrix_a": shifted,
        "matrix_b": shifted @ shifted,
    }
    run_each_statement(chosen, names)
    assert np.isfinite(names["frame"].image).all() and (tmp_path / "frame.exr").exists() and (tmp_path / "report.html").exists()
    assert len(names["records"]) == (2 * 2 + 2) * 2


def page(name):
    return (ROOT / "docs" / f"{name}.md").read_text()


def code_of(name):
    code = program(page(name))
    for long, short in PAGES[name].items():
        assert long in code, long
        code = code.replace(long, short)
    return code


def test_no_page_of_the_docs_has_code_that_no_test_runs():
    blocks = {path.stem: re.findall(r"^```([a-z]+)$", path.read_text(), re.MULTILINE) for path in (ROOT / "docs").glob("*.md")}
    assert {name for name, found in blocks.items() if "python" in found} == {*PAGES, "adding_a_technique"}
    assert {language for found in blocks.values() for language in found} <= {"python", "sh", "toml", "cpp", "diff"}


@pytest.mark.parametrize("name", ["index", "statistics", "three_questions"])
def test_the_code_of_a_page_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_each_statement(code_of(name), {})


def test_the_scene_on_the_page_of_the_format_loads_and_renders(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (scene,) = re.findall(r"```toml\n(.*?)```", page("scene_format"), re.DOTALL)
    (tmp_path / "scene.toml").write_text(scene)
    (tmp_path / "broken.toml").write_text(scene.replace("fov_x    = 50", "fov_y = 50"))
    (tmp_path / "floor.obj").write_text(TRIANGLES)
    names = run_each_statement(code_of("scene_format"), {})
    assert names["scene"].triangles == 4 and len(names["scene"].lights) == 2 and names["frame"].image.mean() > 0


def test_the_live_view_of_its_page_opens_and_closes():
    pytest.importorskip("viser", reason="needs the extra `view`")
    box = ir.scenes.cornell_box()
    names = run_each_statement(code_of("live_view"), {"ir": ir, "scene": box.replace(cameras={"front": next(iter(box.cameras.values()))})})
    assert names["page"].address.startswith("http://")


def test_studies_at_scale_run_on_a_cluster_of_this_machine(tmp_path, monkeypatch):
    """SLURM is not here: its class is one that takes the page's words and starts a worker of this machine."""
    distributed = pytest.importorskip("distributed", reason="needs the extra `distributed`")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    options = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": None, "local_directory": str(tmp_path)}

    class Cluster(distributed.LocalCluster):
        def __init__(self, *, cores, processes, memory, walltime, job_extra_directives, job_script_prologue):
            super().__init__(**options)

        def adapt(self, *, maximum_jobs):
            assert maximum_jobs > 1

    jobs = ModuleType("dask_jobqueue")
    jobs.SLURMCluster = Cluster
    monkeypatch.setitem(sys.modules, "dask_jobqueue", jobs)
    clients = []

    class Client(distributed.Client):
        def __init__(self, *given):
            super().__init__(*given)
            clients.append(self)

    monkeypatch.setattr(distributed, "Client", Client)
    study = ir.Study(
        name="small", scenes=[ir.scenes.cornell_box()], methods=[ir.methods.ConstantAmbient()], size=(16, 12), bounces=1,
        reference=ir.Reference(max_spp=2), repeats=1, max_repeats=1,
    )  # fmt: skip
    with distributed.LocalCluster(**options) as cluster:
        code = code_of("studies_at_scale").replace("{address}", cluster.scheduler_address).replace("/shared/results", "shared")
        names = run_each_statement(code, {"ir": ir, "study": study})
        for client in clients:
            client.close()
    assert set(names["records"].table["status"]) == {"ok"} and names["records"].folder == Path("shared/voxels")
    names["cluster"].close()


def test_every_command_in_the_documents_exists():
    from interreflect.cli import app

    known = {command.name or command.callback.__name__ for command in app.registered_commands} | {g.name for g in app.registered_groups}
    targets = set(re.findall(r"^  ([a-z]+)\)$", (ROOT / "run").read_text(), re.MULTILINE))
    texts = [path.read_text() for path in (ROOT / "README.md", *(ROOT / "docs").glob("*.md"))]
    lines = [line for text in texts for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL) for line in block.splitlines()]
    commands = [*lines, *(span for text in texts for span in re.findall(r"`((?:\./run|\.venv/bin/python) [^`]+)`", text))]
    assert len(commands) > 10
    for command in commands:
        program_name, *words = command.partition("#")[0].removeprefix(".venv/bin/").split()
        if program_name == "./run":
            assert words[0] in targets, command
        elif program_name == "interreflect":
            assert set(words[0].split("|")) <= known, command
        elif program_name == "python":
            file = words[1].replace(".", "/") + ".py" if words[0] == "-m" else words[0]
            assert (ROOT / file).exists() or (ROOT / "python" / file).exists(), command
        else:
            raise AssertionError(f"no such program: {command}")


def test_every_picture_says_which_command_makes_it():
    for path in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")):
        text = path.read_text()
        assert len(re.findall(r"\{(?:figure|image)\}|<img", text)) == len(re.findall(r":::\{figure\}", text)), path
        for figure in re.findall(r":::\{figure\}.*?\n:::", text, re.DOTALL):
            assert re.search(r"`(\./run|\.venv/bin/python) [^`]+`", figure), figure
        for alone, after in re.findall(r"(!\[.*?\]\(.*?\))\n(.*)", text):
            assert re.search(r"`(\./run|\.venv/bin/python) [^`]+`", after), f"{path}: {alone} has no line below it that names its command"
