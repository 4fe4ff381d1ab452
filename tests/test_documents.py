"""What the documents promise runs: the README's program, and the contract of the interface where it lies beside the repository."""

import ast
import re
from pathlib import Path

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
