"""Formulas over the streams of networks that are declared in KPL."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import (
    KPLSyntaxError,
    LabelInUseError,
    PolicyError,
    PrototypeAlreadyExistsError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.kpl.policies import text_from_policy
from dyknow.kpl.printer import text_from
from dyknow.monitoring.errors import (
    EvaluationAlreadyExistsError,
    EvaluationEndedError,
    NoFeaturesError,
    NoSuchEvaluationError,
)
from dyknow.monitoring.interpretation import Interpretation
from dyknow.monitoring.reasoner import EvaluationSettings, StreamReasoner
from dyknow.monitoring.unit import OnGap
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.semantics import deciding_state
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.streams.policy import Constraint
from dyknow.streams.sample import Sample
from dyknow.streams.state_policy import Occasion, StateApproximation, StatePolicy
from tests.dyknow.mtl.formulas import small_formulas
from tests.support.networks import network_of, samples_at
from tests.support.states import given_inputs, timeless_states
from tests.support.streams import ms

TRUE, FALSE, UNDECIDED = Verdict.TRUE, Verdict.FALSE, Verdict.UNDECIDED

UAV = """
source speed speedometer
source length winch_sensor
strmgen speed[uav1] = speedometer with sample every 100, max delay 100
strmgen winch[uav1] = winch_sensor with sample every 100, max delay 100
"""
WINCH_UP = "always forall uav in UAV (speed(uav) > s_min -> winch(uav) <= w_min)"
MEANING = Interpretation(constants={"s_min": 0.5, "w_min": 1}, domains={"UAV": ["uav1"]})
AS_IN_THE_THESIS = EvaluationSettings(
    "from 1050 to 1250, sample every 100, use most recent, "
    "delay before approximation 100, max delay 100"
)

DISTANCES = """
source distance near
source distance far
strmgen XYDist[uav2, uav1] = near
strmgen XYDist[uav3, uav1] = far
"""
APART = "forall x in UAV (x != uav1 -> always XYDist[x, uav1] > 10)"
THREE = Interpretation(domains={"UAV": ["uav1", "uav2", "uav3"]})


def _samples(*rows):
    """Return samples of (valid time, available time, value), in milliseconds."""
    return [Sample(value, ms(valid), ms(available)) for valid, available, value in rows]


def _uav(winch):
    """Return the network of example 7.8.1 in the thesis, with delays as in figure 7.11."""
    speeds = _samples((1000, 1010, 0.1), (1100, 1110, 0.9), (1200, 1280, 0.9))
    lengths = zip((1050, 1150, 1250), (1120, 1170, 1260), winch, strict=True)
    sources = {"speedometer": speeds, "winch_sensor": _samples(*lengths)}
    return StreamReasoner(network_of(UAV, sources), MEANING)


def _distances(near, far):
    sources = {"near": samples_at(near), "far": samples_at(far)}
    return StreamReasoner(network_of(DISTANCES, sources), THREE)


def _received(reasoner, label):
    """Return a list to which the samples of a generator are added."""
    received = []
    reasoner.network.kernel.subscribe(label, received.append, name="test")
    return received


def test_example_7_8_1():
    """Whenever the UAV of example 7.5.1 moves, its winch is not lowered; here it is, at 1150."""
    reasoner = _uav([0.0, 30.0, 30.0])
    evaluation = reasoner.add("winch_up", WINCH_UP, settings=AS_IN_THE_THESIS)
    states, verdicts = _received(reasoner, "states_1"), _received(reasoner, "verdicts[winch_up]")

    reasoner.network.kernel.run()

    assert states == _samples(
        (1050, 1120, (0.1, 0.0)), (1150, 1170, (0.9, 30.0)), (1250, 1280, (0.9, 30.0))
    )
    assert verdicts == _samples((1150, 1170, {"formula": "winch_up", "verdict": "false"}))
    assert evaluation.verdict is FALSE
    assert evaluation.decided_at == ms(1150)
    assert [(o.feature, o.stream) for o in evaluation.origins] == [
        ("speed(uav1)", "speed[uav1]"),
        ("winch(uav1)", "winch[uav1]"),
    ]


def test_what_a_formula_needs_is_declared_and_taken_back():
    """The specification grows by the states, the verdicts and an output, and shrinks again."""
    reasoner = _uav([0.0, 0.0, 0.0])
    before = reasoner.network.specification
    reasoner.add("winch_up", WINCH_UP, settings=AS_IN_THE_THESIS)

    added = text_from(reasoner.network.specification).removeprefix(text_from(before))
    assert added == (
        "compunit verdict EvaluateFormulas(any)\n"
        "strmgen states_1 = sync(speed[uav1], winch[uav1]) with from 1050 to 1250, sample every "
        "100, use most recent, delay before approximation 100, max delay 100\n"
        "strmgen verdicts[winch_up] = EvaluateFormulas(states_1, name = winch_up, formulas = "
        '["always forall uav in UAV (speed(uav) > s_min -> winch(uav) <= w_min)"])\n'
        "stream verdicts[winch_up] = verdicts[winch_up]\n"
    )
    reasoner.remove("winch_up")
    assert reasoner.network.specification == before
    assert reasoner.evaluations == {}
    assert "states_1" not in reasoner.network.kernel.labels


def test_formula_of_the_stream_reasoning_paper():
    """All UAVs but uav1 always keep ten metres from it: each in its own stream, then joined."""
    reasoner = _distances({0: 20, 100: 15, 300: 9}, {0: 50, 200: 40, 300: 30})
    evaluation = reasoner.add("apart", APART)

    reasoner.network.kernel.run(ms(200))
    assert evaluation.verdict is UNDECIDED
    assert text_from_formula(evaluation.residual()) == (
        "always XYDist(uav2, uav1) > 10 and always XYDist(uav3, uav1) > 10"
    )
    reasoner.network.kernel.run(ms(300))
    assert evaluation.verdict is FALSE
    assert evaluation.decided_at == ms(300)


def test_formulas_over_the_same_features_share_their_states():
    """One stream of states serves both, and goes with the last of them."""
    reasoner = _distances({0: 20, 100: 15, 300: 9}, {0: 50, 200: 40, 300: 30})
    first = reasoner.add("apart", APART)
    near = "forall x in UAV (x != uav1 -> eventually XYDist[x, uav1] < 35)"
    reasoner.network.kernel.run(ms(100))
    second = reasoner.add("near", near)
    third = reasoner.add("far", APART, settings=EvaluationSettings("any change, use most recent"))

    assert first.states == second.states == "states_1"
    assert third.states == "states_2"
    reasoner.network.kernel.run()
    assert (first.verdict, first.decided_at) == (FALSE, ms(300))
    assert (second.verdict, second.decided_at) == (TRUE, ms(300))
    reasoner.remove("apart")
    assert "states_1" in reasoner.network.kernel.labels
    reasoner.remove("near")
    reasoner.remove("far")
    assert reasoner.network.kernel.labels == ("XYDist[uav2, uav1]", "XYDist[uav3, uav1]")
