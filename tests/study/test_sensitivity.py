"""Sensitivity of a method whose knobs' effects are known: log error falls with effort alone, log time with effort and waste."""

import numpy as np
import pytest
from search_fakes import Moody, Tunable
from study_fakes import Scene

from interreflect.study.reference import Reference
from interreflect.study.sensitivity import sensitivity

pytest.importorskip("SALib", reason="the extra `search` is not installed")


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sensitivity")
    import study_fakes

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("INTERREFLECT_CACHE", str(folder / "cache"))
        patch.setenv(study_fakes.TRUTH, "1")
        yield sensitivity(Tunable(), Scene(), size=(24, 16), samples=16, reference=Reference(1e-6, 65536), folder=folder / "a")


def test_knobs_that_do_not_matter_are_named(found):
    assert found.idle == ["idle"]


def test_effects_have_the_size_they_were_given(found):
    rows = found.indices.set_index("knob")
    # error ~ 1/effort^2 over a range of 16: two times log10 16; the flag: log10 4; nothing else
    assert rows.loc["effort", "error_effect"] == pytest.approx(2 * np.log10(16), rel=0.05)
    # the middle of a step of 2/3 of the range of two choices always crosses from one to the other: log10 4 over 2/3
    assert rows.loc["flag", "error_effect"] == pytest.approx(1.5 * np.log10(4), rel=0.05)
    assert rows.loc["waste", "error_effect"] == pytest.approx(0, abs=0.01)
    assert rows.loc["waste", "matters"] == "time"
    assert rows.loc["effort", "matters"] == "error, time"


def test_variance_is_shared_among_the_knobs_that_matter(found):
    rows = found.indices.set_index("knob")
    # log error is a sum of two terms: variances (2 log10 16)^2 / 12 and (log10 4)^2 / 4, so that both orders are the same shares
    effort, flag = (2 * np.log10(16)) ** 2 / 12, np.log10(4) ** 2 / 4
    shares = {"effort": effort / (effort + flag), "flag": flag / (effort + flag)}
    assert rows.loc["effort", "error_total"] > 2 * rows.loc["flag", "error_total"]
    for knob, share in shares.items():
        assert rows.loc[knob, "error_total_low"] <= share <= rows.loc[knob, "error_total_high"]
    assert np.isnan(rows.loc["idle", "error_total"])


def test_the_chart_has_a_bar_for_every_knob(found):
    figure = found.chart()
    assert figure.axes[0].get_yticklabels()[0].get_text() == "effort"


def test_what_differs_from_preparation_to_preparation_is_noise(tmp_path, fake_truth):
    found = sensitivity(Moody(), Scene(), size=(24, 16), samples=0, reference=Reference(1e-6, 65536), folder=tmp_path / "a")
    rows = found.indices.set_index("knob")
    assert found.noise["time"] == pytest.approx(0.04, rel=0.5)  # sixteen pairs
    assert rows.loc["idle", "time_effect"] > 0.03
    assert found.idle == ["idle"]
