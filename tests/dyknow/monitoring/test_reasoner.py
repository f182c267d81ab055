"""Formulas over the streams of networks that are declared in KPL."""

import re

import numpy as np
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
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.semantics import deciding_state
from dyknow.mtl.syntax import Comparison, TimeModel, Verdict, descendants
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.streams.policy import Constraint
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from tests.dyknow.mtl.formulas import small_formulas
from tests.support.networks import network_of, samples_at
from tests.support.states import given_inputs, state_policies, timeless_states
from tests.support.streams import ms

_INPUTS = given_inputs(is_ended=True).filter(lambda given: len(given.elements) > 2)
_POLICIES = state_policies(is_patient=True)
_APPROXIMATING = _POLICIES.filter(lambda policy: policy.is_approximated)
_LEAVES = st.sampled_from([parse_formula(text) for text in ("p > 1", "q > 1", "p = q")])
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
        'strmgen verdicts[winch_up] = EvaluateFormulas(states_1, name = "winch_up", formulas = '
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


def test_formulas_of_a_group_share_states_and_are_told_apart_in_the_verdicts():
    """Each has its own verdict, once; the whole is false as soon as one of them is."""
    reasoner = _distances({0: 20, 100: 15, 300: 9}, {0: 50, 200: 40, 300: 30})
    formulas = {
        "near": "eventually XYDist[uav2, uav1] < 16",
        "far": "always XYDist[uav3, uav1] > 35",
    }
    group = reasoner.add("distances", formulas)
    verdicts = _received(reasoner, "verdicts[distances]")

    reasoner.network.kernel.run()

    assert [(sample.valid_time, sample.value) for sample in verdicts] == [
        (ms(100), {"formula": "near", "verdict": "true"}),
        (ms(300), {"formula": "far", "verdict": "false"}),
    ]
    assert group.verdicts == {"near": TRUE, "far": FALSE}
    assert (group.verdict, group.decided_at) == (FALSE, ms(300))
    assert [(d.formula, d.decided_at) for d in group.decisions] == [
        ("near", ms(100)),
        ("far", ms(300)),
    ]
    with pytest.raises(ValueError, match="expected the name of one of the formulas 'near', 'far'"):
        group.residual()
    assert text_from_formula(group.residual("far")) == "false"


def test_verdicts_are_a_stream_like_any_other():
    """Other declarations may use them, and then they cannot be removed."""
    reasoner = _distances({0: 20, 100: 9, 300: 9}, {0: 50, 200: 40, 300: 30})
    reasoner.add("apart", APART)
    reasoner.network.add(
        'stream alarms = select formula from verdicts[apart] where verdict = "false"'
    )
    alarms = []
    reasoner.network.subscribe("alarms", alarms.append)

    reasoner.network.kernel.run()
    assert [(a.valid_time, a.value) for a in alarms] == [(ms(100), {"formula": "apart"})]
    with pytest.raises(LabelInUseError, match="in use by 'alarms'"):
        reasoner.remove("apart")
    assert list(reasoner.evaluations) == ["apart"]
    reasoner.network.remove("alarms")
    reasoner.remove("apart")


def test_formulas_come_and_go_within_an_instant():
    """What receives a sample may add and remove them; that has its effect after the instant."""
    times = range(0, 600, 100)
    reasoner = _distances(dict.fromkeys(times, 20), {t: 60 - t / 10 for t in times})
    reasoner.network.add("stream far = XYDist[uav3, uav1]")
    added = []

    def receive(sample):
        if sample.valid_time == ms(200):
            added.append(reasoner.add("near", "eventually XYDist[uav3, uav1] < 45"))
            added.append(reasoner.add("gone", "eventually XYDist[uav3, uav1] < 45"))
        if sample.valid_time == ms(300):
            reasoner.remove("gone")

    reasoner.network.subscribe("far", receive)
    reasoner.network.kernel.run()

    near, gone = added
    assert (near.verdict, near.decided_at) == (TRUE, ms(200))
    assert gone.verdict is TRUE
    assert list(reasoner.evaluations) == ["near"]


def test_a_violated_formula_calls_for_recovery_exactly_once():
    """The action may change what is monitored; a formula that becomes true calls for none."""
    times = range(0, 400, 20)
    reasoner = _distances({t: 20 - t // 20 for t in times}, dict.fromkeys(times, 50))
    called = []

    def recover(decision):
        called.append((decision.formula, decision.decided_at, reasoner.network.kernel.now))
        reasoner.remove("apart")
        reasoner.add("apart", APART.replace("10", "5"), on_violation=called.append)

    reasoner.add("apart", APART, on_violation=recover)
    reasoner.add("near", "eventually XYDist[uav2, uav1] < 16", on_violation=recover)

    reasoner.network.kernel.run()

    first, second = called
    assert first == ("apart", ms(200), ms(200))
    assert (second.formula, second.verdict, second.decided_at) == ("apart", FALSE, ms(300))


SLOW = """
source truth flag
source metres height
strmgen attached[uav1, box1] = flag
strmgen altitude[uav1] = height
stream attached = attached[uav1, box1]
stream altitude = altitude[uav1]
"""
DROPPED = "always (altitude(uav1) > 4 -> attached(uav1, box1))"
PATIENT = EvaluationSettings("any update, use most recent, max delay 50")


def test_a_formula_that_is_added_later_knows_what_streams_have_said():
    """A stream that spoke only once is not waited for; states begin with what comes next."""
    heights = {t: t / 100 for t in range(0, 1000, 100)}
    sources = {"flag": samples_at({0: True, 650: False}), "height": samples_at(heights)}
    reasoner = StreamReasoner(network_of(SLOW, sources), settings=PATIENT)
    reasoner.network.kernel.run(ms(520))

    evaluation = reasoner.add("kept", DROPPED)
    soon = reasoner.add("soon", "eventually [0, 80] altitude(uav1) >= 6 and attached(uav1, box1)")
    states = _received(reasoner, evaluation.states)
    reasoner.network.kernel.run(ms(620))
    assert states == []
    reasoner.network.kernel.run()

    assert states[:2] == _samples((600, 650, (6.0, True)), (650, 700, (6.0, False)))
    assert (evaluation.verdict, evaluation.decided_at) == (FALSE, ms(650))
    assert (soon.verdict, soon.decided_at) == (TRUE, ms(600))


def test_regular_states_that_begin_later_follow_on_the_newest_sample():
    """Their times are those at which the streams go on speaking."""
    reasoner = _distances(dict.fromkeys(range(3, 900, 100), 20), {0: 50, 350: 5})
    reasoner.network.add("stream near = XYDist[uav2, uav1] stream far = XYDist[uav3, uav1]")
    reasoner.network.kernel.run(ms(420))
    settings = EvaluationSettings("sample every 50, use most recent, max delay 0, to 600")
    evaluation = reasoner.add("apart", APART, settings=settings)
    states = _received(reasoner, evaluation.states)

    reasoner.network.kernel.run(ms(1000))
    assert [s.valid_time for s in states] == [ms(t) for t in (453, 503, 553)]
    assert evaluation.decided_at == ms(453)


MISSING = "sample every 100, use most recent, from 0, max delay 20"


def test_a_missing_state_ends_the_evaluation_where_it_matters():
    """States before it still count; what is not decided by then is told to be undecided."""
    reasoner = _distances({0: 20, 100: 20}, {150: 50, 200: 50, 300: 5})
    settings = EvaluationSettings(MISSING)
    near = reasoner.add("near", "always XYDist[uav2, uav1] > 10", settings=settings)
    both = reasoner.add("both", APART, settings=settings)
    verdicts = _received(reasoner, "verdicts[both]")
    told = []
    reasoner.network.kernel.subscribe_violations(told.append)

    reasoner.network.kernel.run(ms(420))

    assert verdicts == _samples((0, 20, {"formula": "both", "verdict": "undecided"}))
    assert both.ended_by.reason == "no value of 'XYDist[uav3, uav1]'"
    assert both.ended_by.constraint is Constraint.APPROXIMATION
    assert (both.verdict, both.decided_at, both.gaps) == (UNDECIDED, None, 1)
    assert [each.receiver for each in told] == ["states_2", "states_2"]
    assert (near.ended_by, near.gaps) == (None, 0)


def test_an_evaluation_goes_on_without_the_state_if_it_is_told_to():
    """The last state holds on until the next one."""
    reasoner = _distances({0: 20, 100: 20}, {150: 50, 200: 50, 300: 5})
    both = reasoner.add("both", APART, settings=EvaluationSettings(MISSING, on_gap=OnGap.CONTINUE))

    reasoner.network.kernel.run(ms(420))

    assert (both.verdict, both.decided_at, both.gaps) == (FALSE, ms(300), 2)
    assert both.ended_by is None


def test_a_late_sample_ends_the_evaluation_with_the_next_state():
    """States that were made without it may have been wrong."""
    late = _samples((0, 0, 20), (100, 250, 3), (300, 300, 20))
    sources = {"near": late, "far": samples_at(dict.fromkeys(range(0, 500, 100), 50))}
    reasoner = StreamReasoner(network_of(DISTANCES, sources), THREE)
    settings = EvaluationSettings("any update, use most recent, max delay 50")
    evaluation = reasoner.add("apart", APART, settings=settings)

    reasoner.network.kernel.run()

    assert evaluation.verdict is UNDECIDED
    assert evaluation.ended_by.constraint is Constraint.DELAY
    assert evaluation.ended_by.valid_time == ms(100)


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ("close", "a side of '>'|a number, found 'close' \\(str\\)"),
        (float("nan"), "expected a number, found NaN"),
        (NO_VALUE, "expected a value, found none"),
        (None, "expected a boolean, a number or a text, found None"),
    ],
)
def test_an_unfit_value_is_published_as_a_violation(value, reason):
    """It is one of the stream of verdicts, and says what was expected and what came."""
    reasoner = _distances({0: 20, 100: value, 200: 5}, {0: 50, 100: 50, 200: 50})
    ending = reasoner.add("ending", APART)
    going = reasoner.add("going", APART, settings=EvaluationSettings(on_gap=OnGap.CONTINUE))
    told = []
    reasoner.network.kernel.subscribe_violations(told.append)

    reasoner.network.kernel.run()

    assert [each.receiver for each in told] == ["verdicts[ending]", "verdicts[going]"]
    assert all(re.search(reason, each.violation.reason) for each in told)
    assert all(each.violation.valid_time == ms(100) for each in told)
    assert ending.ended_by is told[0].violation
    assert (going.verdict, going.decided_at, going.gaps) == (FALSE, ms(200), 1)


TABLES = """
source car tracker
strmgen cars = tracker
"""


def _cars(time, rows):
    columns = {"speed": np.array([float(row[1]) for row in rows])}
    return Sample(Table("car", [row[0] for row in rows], columns), ms(time), ms(time))


def test_features_can_be_columns_of_tables():
    """Every object has its row in the one stream; a row that is missing is a missing value."""
    tables = [_cars(0, [(7, 10), (3, 12)]), _cars(100, [(3, 13)]), _cars(200, [(7, 10), (3, 21)])]
    meaning = Interpretation({"speed": "cars.speed"}, domains={"Car": ["car3", "car7"]})
    reasoner = StreamReasoner(network_of(TABLES, {"tracker": tables}), meaning)
    going = EvaluationSettings(on_gap=OnGap.CONTINUE)
    slow = reasoner.add("slow", "always forall c in Car speed(c) < 20", settings=going)
    one = reasoner.add("one", "always cars.speed[car3] < 20")
    both = reasoner.add("both", "always speed[car7] < 20")

    reasoner.network.kernel.run()

    assert slow.states == one.states
    assert text_from(reasoner.network.specification).count("sync(cars)") == 1
    assert (slow.decided_at, slow.gaps) == (ms(200), 1)
    assert (one.verdict, one.gaps) == (FALSE, 0)
    assert both.ended_by.reason == (
        "feature 'speed(car7)': expected a row of 'car7', found none in the table"
    )


def test_everything_that_is_not_found_is_told_at_once():
    """Each place in the formula with the nearest labels; nothing is declared."""
    reasoner = _distances({0: 20}, {0: 50})
    before = reasoner.network.specification

    with pytest.raises(SpecificationErrors) as caught:
        reasoner.add("apart", "forall x in UAV (XYDits[x, uav1] > 1 and height > 3)")

    first, second = caught.value.exceptions
    assert (first.span.place, second.span.place) == ("apart:1:18", "apart:1:42")
    assert first.message == (
        "no stream for the feature 'XYDits(uav1, uav1)': expected a stream generator called "
        "'XYDits[uav1, uav1]'; nearest are 'XYDist[uav3, uav1]', 'XYDist[uav2, uav1]'"
    )
    assert second.message == (
        "no stream for the feature 'height': expected a stream generator called 'height'"
    )
    assert reasoner.network.specification == before
    assert reasoner.evaluations == {}


@pytest.mark.parametrize(
    ("policy", "error", "message"),
    [
        ("sample evry 100", KPLSyntaxError, "expected 'every', found 'evry'"),
        ("sample every period", SpecificationError, "expected a time, found the name 'period'"),
        ("use latest", PolicyError, "formulas need one state for each valid time"),
        ("all updates", PolicyError, "'all updates' needs an approximation"),
    ],
)
def test_a_state_policy_that_cannot_be_is_refused(policy, error, message):
    """The message points into the policy."""
    reasoner = _distances({0: 20}, {0: 50})
    with pytest.raises(error, match=message) as caught:
        reasoner.add("apart", APART, settings=EvaluationSettings(policy))
    assert caught.value.span.place.startswith("<state policy>:1:")


def test_a_policy_that_the_streams_do_not_fit_is_refused():
    """What shows only when the network is checked leaves everything as it was."""
    reasoner = _distances({0: 20}, {0: 50})
    settings = EvaluationSettings("sample every common period, use most recent")
    with pytest.raises(SpecificationErrors) as caught:
        reasoner.add("apart", APART, settings=settings)
    (fault,) = caught.value.exceptions
    assert "need inputs that are sampled" in fault.message
    assert fault.span.place == "<state policy>:1:1"
    assert reasoner.evaluations == {}
    reasoner.add("apart", APART)


def test_names_are_unique_known_and_fit_for_labels():
    """What is wrong with a name is said before anything is done."""
    reasoner = _distances({0: 20}, {0: 50})
    reasoner.add("apart", APART)

    with pytest.raises(EvaluationAlreadyExistsError, match="'apart' is being evaluated already"):
        reasoner.add("apart", APART)
    reasoner.network.add("parameter period = 100")
    for name in ("keep apart", "link", "true", "1", "period"):
        with pytest.raises(ValueError, match=f"can stand in a label, found '{name}'"):
            reasoner.add(name, APART)
    with pytest.raises(NoSuchEvaluationError, match=r"called 'part' .*; did you mean 'apart'\?"):
        reasoner.remove("part")
    with pytest.raises(ValueError, match="expected at least one formula for 'none'"):
        reasoner.add("none", {})
    with pytest.raises(UnknownNameError, match=r"no domain called 'UVA'; did you mean 'UAV'\?"):
        reasoner.add("typo", "forall x in UVA XYDist[x, uav1] > 3")
    with pytest.raises(PrototypeAlreadyExistsError):
        StreamReasoner(reasoner.network)


def test_a_formula_without_features_has_no_states():
    """What is left of it is in the message: of an empty domain, the formula is true."""
    reasoner = _distances({0: 20}, {0: 50})
    with pytest.raises(NoFeaturesError, match="'apart' comes to 'true': expected a feature"):
        reasoner.add("apart", APART, Interpretation(domains={"UAV": ["uav1"]}))
    with pytest.raises(NoFeaturesError) as caught:
        reasoner.add("later", "eventually [5, oo] 3 < 5")
    assert caught.value.left == ("eventually [5, oo] true",)


def test_evaluating_blocks_until_the_verdict():
    """The run ends with the deciding instant and can go on; the formula is gone by then."""
    reasoner = _distances({0: 20, 100: 15, 300: 9}, dict.fromkeys(range(0, 500, 100), 50))
    before = reasoner.network.specification

    found = reasoner.evaluate("eventually XYDist[uav2, uav1] < 16")
    assert (found.verdict, found.decided_at, reasoner.network.kernel.now) == (
        TRUE,
        ms(100),
        ms(100),
    )
    found = reasoner.evaluate("always XYDist[uav2, uav1] > 10", ms(200))
    assert (found.verdict, found.decided_at, reasoner.network.kernel.now) == (
        UNDECIDED,
        None,
        ms(200),
    )
    assert text_from_formula(found.residual()) == "always XYDist(uav2, uav1) > 10"
    assert reasoner.network.specification == before


def test_evaluating_ends_with_an_error_when_states_are_missing():
    """Otherwise nobody would know why there is no verdict."""
    reasoner = _distances({0: 20, 100: "?"}, {0: 50, 100: 50, 200: 50})
    with pytest.raises(
        EvaluationEndedError, match=r"the evaluation of .* ended at 100 ms"
    ) as caught:
        reasoner.evaluate(APART)
    assert caught.value.violation.valid_time == ms(100)
    assert reasoner.evaluations == {}


def test_verdicts_are_recorded_like_every_stream(tmp_path):
    """Those of formulas that are added while the network runs, too."""
    reasoner = _distances({0: 20, 100: 15, 300: 9}, {0: 50, 200: 40, 300: 30})
    path = tmp_path / "run.mcap"
    with Recorder(path, metadata={}) as recorder:
        recorder.attach(reasoner.network)
        reasoner.network.kernel.run(ms(50))
        reasoner.add("apart", APART)
        reasoner.network.kernel.run()

    with open_recording(path) as recording:
        samples = list(recording.samples("verdicts[apart]"))
    assert [(s.valid_time, s.value) for s in samples] == [
        (ms(300), {"formula": "apart", "verdict": "false"})
    ]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.data())
def test_verdicts_are_those_of_the_naive_evaluator_in_the_states_by_definition(data):
    """Verdict and deciding time are found again, for states and formulas of all kinds.

    A formula that speaks of a feature twice may be decided earlier than by that evaluator, which
    does not see how its parts depend on each other; a `Monitor` decides it at the same state.
    """
    streams = {"p": data.draw(_INPUTS), "q": data.draw(_INPUTS)}
    formula = data.draw(small_formulas(_LEAVES, longest=9, size=5))
    policy = data.draw(_APPROXIMATING | _POLICIES)
    time_model = data.draw(st.sampled_from(TimeModel))
    reasoner = StreamReasoner(_network_of_given(streams))
    written = EvaluationSettings(_text(policy), time_model, OnGap.CONTINUE)

    evaluation = reasoner.add("formula", formula, settings=written)
    reasoner.network.kernel.run(TimePoint(1000))

    used = [origin.stream for origin in evaluation.origins]
    states = timeless_states([streams[name] for name in used], policy)
    whole = [(time, values) for time, values in states if NO_VALUE not in values]
    trace = [(time, dict(zip(used, values, strict=True))) for time, values in whole]
    found = evaluation.verdict, evaluation.decided_at
    assert found == _monitored(formula, trace, time_model)
    verdict, at = deciding_state(formula, trace, time_model)
    if _has_no_repetition(formula):
        assert found == (verdict, None if at is None else trace[at][0])
    elif at is not None:
        assert found[0] is verdict
        assert found[1] <= trace[at][0]


def _monitored(formula, trace, time_model):
    monitor = Monitor(formula, time_model)
    for time, state in trace:
        verdict = monitor.step(time, state)
        if verdict is not UNDECIDED:
            return verdict, time
    return UNDECIDED, None


def _has_no_repetition(formula):
    found = [node for node, _ in descendants(formula) if isinstance(node, Comparison)]
    return len(found) == len(set(found))


def _network_of_given(streams):
    declared = "".join(
        f"source n {name} strmgen {name} = {name} {_with(each.policy)}\n"
        for name, each in streams.items()
    )
    return network_of(declared, {name: each.elements for name, each in streams.items()})


def _with(policy):
    text = text_from_policy(policy)
    return f"with {text}" if text else ""


def _text(policy):
    """Return a state policy without delays as KPL writes it."""
    period = "" if policy.period is None else f" {policy.period} ns"
    start = "" if policy.start is None else f"from {policy.start} ns"
    end = "" if policy.end is None else f"to {policy.end} ns"
    duration = " ".join(filter(None, [start, end]))
    written = [policy.occasion.value + period, policy.approximation.value, duration]
    return ", ".join(filter(None, written))
