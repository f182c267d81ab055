"""Reasons are observations that suffice for a verdict, and of which none can be left out."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.mtl.parser import parse_formula
from dyknow.mtl.semantics import evaluate
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.time import TimePoint
from tests.dyknow.mtl.formulas import small_formulas, traces
from tests.traffic.monitoring.test_past import remembered
from traffic.monitoring import reasons as module
from traffic.monitoring.reasons import reasons_of


def trace_of(**features):
    """Return states every millisecond; a feature is a text of digits, 1 for true."""
    (length,) = {len(text) for text in features.values()}
    return [
        (TimePoint(at * 1_000_000), {name: text[at] == "1" for name, text in features.items()})
        for at in range(length)
    ]


def reasons_for(formula, trace, model=TimeModel.HOLD):
    """Return reasons as short texts: the atom, and the numbers of the first and last state."""
    past = remembered(parse_formula(formula), trace, model)
    return [
        f"{'' if r.value else 'not '}{r.atom} {r.begin // 1_000_000}-{r.end // 1_000_000}"
        for r in reasons_of(past)
    ]


@pytest.mark.parametrize("model", TimeModel)
@pytest.mark.parametrize(
    ("formula", "features", "reasons"),
    [
        ("always p", {"p": "11101"}, ["not p 3-3"]),
        ("always (p and q)", {"p": "1100", "q": "1110"}, ["not p 2-2"]),
        ("always eventually [0, 3] p", {"p": "01000000"}, ["not p 2-5"]),
        ("always (p -> eventually [1, 2] q)", {"p": "1001110", "q": "0110000"},
         ["p 3-3", "not q 4-5"]),
        ("p until q", {"p": "1101", "q": "0000"}, ["not q 0-2", "not p 2-2"]),
        ("p until q", {"p": "1100", "q": "0010"}, ["p 0-1", "q 2-2"]),
        ("p -> always q", {"p": "1000", "q": "1110"}, ["p 0-0", "not q 3-3"]),
        ("eventually (p and q)", {"p": "0110", "q": "0010"}, ["p 2-2", "q 2-2"]),
        ("p <-> q", {"p": "0", "q": "1"}, ["not p 0-0", "q 0-0"]),
        ("not eventually p", {"p": "0001"}, ["p 3-3"]),
        ("eventually [2, oo] true", {"p": "0000"}, []),
    ],
)  # fmt: skip
def test_what_brings_a_verdict_about(formula, features, reasons, model):
    """As few observations as will do, and each as short as can be."""
    assert reasons_for(formula, trace_of(**features), model) == reasons


def test_a_thousand_objects_have_one_reason():
    """Of a thousand cars, the one that was too fast is named, with its speed."""
    formula = " and ".join(f"speed(car{n}) < 30" for n in range(1_000))
    trace = [(TimePoint(t), {f"speed(car{n})": 20.0 for n in range(1_000)}) for t in range(20)]
    trace[13][1]["speed(car77)"] = 31.5

    (reason,) = reasons_of(remembered(parse_formula(f"always ({formula})"), trace))

    assert (reason.atom, reason.value, reason.begin, reason.end) == (
        "speed(car77) < 30", False, 13, 13,
    )  # fmt: skip
    assert reason.values == {"speed(car77)": 31.5}


@settings(derandomize=True, deadline=None, max_examples=150)
@given(small_formulas(), traces(), st.sampled_from(TimeModel), st.data())
def test_reasons_suffice(formula, trace, model, data):
    """Whatever p and q are elsewhere, the meaning of the formula is the same."""
    past = remembered(formula, trace, model)
    verdict = past.monitor.verdict
    if verdict is Verdict.UNDECIDED:
        return
    reasons = reasons_of(past)
    if reasons is None:
        return
    seen = [(time, dict(state)) for time, state in trace if time <= past.stretches()[0][-1].time]
    begin = past.stretches()[0][0].time
    for time, state in seen:
        for atom in state:
            observed = any(r.atom == atom and r.begin <= time <= r.end for r in reasons)
            if not observed and time >= begin:
                state[atom] = data.draw(st.booleans())

    assert evaluate(formula, seen, model) is verdict


def test_the_search_ends(monkeypatch):
    """When it takes too long, what is found by then is told: it suffices, but may be too much."""
    monkeypatch.setattr(module, "_MOST_STEPS", 30)
    features = {"p": "01" * 10 + "0000", "q": "0" * 24}

    reasons = reasons_for("eventually [0, 20] q or p", trace_of(**features))

    assert "not q 0-20" in reasons
    assert len(reasons) > 2
