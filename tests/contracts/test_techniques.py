"""Contracts of every technique of every stage, and of one that this test adds."""

import copy
import importlib.util
import pickle
import sys
from pathlib import Path

import pytest

import interreflect as ir
from interreflect import _core

TECHNIQUES = {cls.__name__: cls for stage in _core.stages.values() for cls in stage["techniques"]}
NUMBERS = ("int", "float")


def load_dummy():
    """The compiled dummy stage beside this folder; built with the C++ tests."""
    built = sorted((Path(__file__).parents[1] / "dummy").glob("_dummy*.so"))
    if not built:
        pytest.skip("the dummy technique is built with the C++ tests (INTERREFLECT_TESTS=ON)")
    spec = importlib.util.spec_from_file_location("_dummy", built[0])
    module = importlib.util.module_from_spec(spec)
    sys.modules["_dummy"] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(params=[*TECHNIQUES, "Brightest", "Median"])
def cls(request):
    return TECHNIQUES.get(request.param) or getattr(load_dummy(), request.param)


def outside(param):
    """Values just beyond each end of a numeric knob's range."""
    step = 1 if param["type"] == "int" else 1e-6
    if param["minimum"] is not None:
        yield param["minimum"] if param["open_minimum"] else param["minimum"] - step
    if param["maximum"] is not None:
        yield param["maximum"] if param["open_maximum"] else param["maximum"] + step


def test_repr_pickle_copy_dict_and_hash_give_the_same_value_back(cls):
    value = cls()
    assert eval(repr(value), {**vars(_core), **vars(sys.modules.get("_dummy", _core))}) == value
    assert pickle.loads(pickle.dumps(value)) == value == copy.deepcopy(value)
    assert hash(cls()) == hash(value) and len({value, cls()}) == 1
    assert value.replace() == value and value.asdict()["technique"] == cls.__name__
    assert value != object()


def test_a_changed_knob_is_kept_everywhere_and_changes_equality(cls):
    for param in cls.description["params"]:
        name, default = param["name"], param["default"]
        if param["type"] == "bool":
            other = not default
        elif param["choices"]:
            other = next((c for c in param["choices"] if c != default), None)
        elif param["type"] in NUMBERS:
            top = param["maximum"] if param["maximum"] is not None else abs(default) * 2 + 1
            other = type(default)((default + top) / 2 if default != top else (default + (param["minimum"] or 0)) / 2)
        else:
            other = next((c() for c in param["techniques"] if c() != default), None)
        if other is None or other == default:
            continue
        value = cls(**{name: other})
        assert getattr(value, name) == other and value != cls(), name
        assert pickle.loads(pickle.dumps(value)) == value, name


def test_values_out_of_range_name_technique_field_and_value(cls):
    for param in cls.description["params"]:
        for bad in outside(param) if param["type"] in NUMBERS else ():
            kind = int if param["type"] == "int" else float
            with pytest.raises(ValueError, match=rf"{cls.__name__}\.{param['name']} must lie in"):
                cls(**{param["name"]: kind(bad)})
        if param["type"] == "float":
            with pytest.raises(ValueError, match=param["name"]):
                cls(**{param["name"]: float("nan")})
        if param["choices"]:
            with pytest.raises(ValueError, match=rf"{cls.__name__}\.{param['name']} must be one of"):
                cls(**{param["name"]: "no such word"})


def test_values_of_the_wrong_kind_are_type_errors(cls):
    for param in cls.description["params"]:
        with pytest.raises(TypeError, match=rf"{cls.__name__}\.{param['name']} must be"):
            cls(**{param["name"]: object()})


def test_unknown_knobs_are_type_errors_that_name_the_nearest(cls):
    with pytest.raises(TypeError, match=f"{cls.__name__} has no knob 'no_such_knob'"):
        cls(no_such_knob=1)
    for param in cls.description["params"][:1]:
        with pytest.raises(TypeError, match=f"did you mean '{param['name']}'"):
            cls(**{param["name"] + "x": 1})


def test_knobs_are_read_only_and_by_keyword(cls):
    with pytest.raises(TypeError):
        cls(1)
    for param in cls.description["params"]:
        with pytest.raises(AttributeError):
            setattr(cls(), param["name"], param["default"])


def test_every_knob_has_a_meaning_and_every_technique_a_source(cls):
    assert cls.description["doc"] and cls.description["source"]
    assert all(param["doc"] for param in cls.description["params"])


def test_stages_and_techniques_name_each_other():
    for name, stage in _core.stages.items():
        assert stage["doc"]
        assert ir.techniques(name) == stage["techniques"]
        for cls in stage["techniques"]:
            assert name in cls.stages
            assert getattr(ir, cls.__name__) is cls
        if stage["exact"] is not None:
            assert stage["exact"] is stage["techniques"][0]
            assert isinstance(ir.exact(stage["techniques"][-1]()), tuple(_core.stages[s]["exact"] for s in stage["techniques"][-1].stages))


def test_a_technique_held_by_another_keeps_its_own_knobs():
    dummy = load_dummy()
    value = dummy.Brightest(first=dummy.Median(taps=5))
    assert value.first.taps == 5 and value.asdict()["first"] == {"technique": "Median", "taps": 5}
    assert repr(value) == "Brightest(radius=1.5, wrap=False, metric='luminance', first=Median(taps=5))"
    assert dummy.stages["dummy"]["techniques"] == (dummy.Brightest, dummy.Median)
