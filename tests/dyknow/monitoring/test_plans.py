"""Plans whose execution is monitored over streams."""

import pytest

from dyknow.monitoring.errors import NoFeaturesError
from dyknow.monitoring.plans import PlanMonitor
from dyknow.monitoring.reasoner import EvaluationSettings, StreamReasoner
from dyknow.mtl.operators import Action, Condition, DurationConstraint, Effect, Operator
from dyknow.mtl.operators import causal_links as links_of
from dyknow.time import milliseconds
from tests.support.networks import network_of, samples_at
from tests.support.streams import ms

NETWORK = """
source truth magnet
source metres altimeter
strmgen attached[uav1, box1] = magnet
strmgen altitude[uav1] = altimeter
stream attached = attached[uav1, box1]
stream altitude = altitude[uav1]
"""
REMAINS = "EXEC until [0, 5000] (attached(uav, box) until executing_detach_box(uav, box))"
ATTACH = Operator(
    "attach_box",
    ("uav", "box", "x"),
    preconditions=(Condition("altitude(uav) < 4"),),
    effects=(Effect("attached(uav, box)", recovery="again"),),
    formulas=(Condition(REMAINS, recovery="search"),),
    flag_parameters=("uav", "box"),
)
DETACH = Operator("detach_box", ("uav", "box"), preconditions=(Condition("attached(uav, box)"),))
ATTACHING, DETACHING = Action(ATTACH, ("uav1", "box1", 7.5)), Action(DETACH, ("uav1", "box1"))
OFTEN = EvaluationSettings("sample every 100, use most recent, max delay 0")


def _monitor(attached, recoveries=()):
    heights = {t: t / 1000 for t in range(0, 20_001, 500)}
    sources = {"magnet": samples_at(attached), "altimeter": samples_at(heights)}
    reasoner = StreamReasoner(network_of(NETWORK, sources), settings=OFTEN)
    called = []
    monitor = PlanMonitor(reasoner, dict.fromkeys(recoveries, called.append))
    return monitor, reasoner, called


def _names(called):
    return [(each.name.rpartition(": ")[2], each.time) for each in called]


def test_example_7_6_4():
    """A box that is dropped before it is detached is missed at the next state, and once."""
    monitor, reasoner, called = _monitor({0: False, 2400: True, 9000: False}, ["again", "search"])
    kernel = reasoner.network.kernel
    kernel.run(ms(1050))
    evaluation = monitor.begin(ATTACHING)
    kernel.run(ms(3030))
    monitor.end(ATTACHING)
    kernel.run(ms(12_000))

    assert _names(called) == [("formula 3", ms(9000))]
    assert {name.rpartition(": ")[2]: v.name for name, v in evaluation.verdicts.items()} == {
        "precondition 1": "TRUE",
        "effect 2": "TRUE",
        "formula 3": "FALSE",
    }
    assert set(kernel.labels) == {"attached[uav1, box1]", "altitude[uav1]"}


def test_example_7_6_4_when_all_goes_well():
    """An action that begins is a flag for formulas of others; then everything is true."""
    monitor, reasoner, called = _monitor({0: False, 2400: True, 9050: False}, ["again", "search"])
    links = [
        link.monitor_formula([ATTACHING, DETACHING]) for link in links_of([ATTACHING, DETACHING])
    ]
    kernel = reasoner.network.kernel
    kernel.run(ms(1050))
    attaching = monitor.begin(ATTACHING, links)
    kernel.run(ms(3030))
    monitor.end(ATTACHING)
    kernel.run(ms(8950))
    assert monitor.executing == ()
    detaching = monitor.begin(DETACHING)
    assert monitor.executing == ("detach_box(uav1, box1)",)
    kernel.run(ms(12_000))

    assert called == []
    assert [d.verdict.name for e in (attaching, detaching) for d in e.decisions] == ["TRUE"] * 5
    assert len(attaching.verdicts) == 4


def test_an_action_that_fails_calls_its_recovery():
    """Within five seconds the box should have been attached, and at the end of the action."""
    monitor, reasoner, called = _monitor({0: False}, ["again", "search"])
    kernel = reasoner.network.kernel
    kernel.run(ms(1050))
    evaluation = monitor.begin(ATTACHING)
    kernel.run(ms(4030))
    monitor.end(ATTACHING)
    kernel.run(ms(9000))

    assert _names(called) == [("effect 2", ms(4100)), ("formula 3", ms(4100))]
    assert evaluation.decided_at == ms(4100)


def test_verdicts_that_others_use_stay():
    """Who looks at them removes them."""
    monitor, reasoner, _ = _monitor({0: True})
    monitor.begin(DETACHING)
    reasoner.network.kernel.subscribe("verdicts[detach_box_1]", lambda _: None)
    reasoner.network.kernel.run(ms(1000))
    assert list(reasoner.evaluations) == ["detach_box_1"]


def test_what_cannot_be_monitored_is_refused_and_nothing_begins():
    """An action twice at once, a recovery that is not known, formulas without states."""
    monitor, _, _ = _monitor({0: True}, ["again"])
    with pytest.raises(ValueError, match="no recovery called 'search'"):
        monitor.begin(ATTACHING)
    with pytest.raises(ValueError, match=r"'detach_box\(uav1, box1\)' is not being executed"):
        monitor.end(DETACHING)
    waiting = Operator("wait", duration=DurationConstraint(milliseconds(500)))
    with pytest.raises(NoFeaturesError):
        monitor.begin(Action(waiting))
    assert monitor.begin(Action(Operator("hover"))) is None
    monitor.begin(DETACHING)
    with pytest.raises(ValueError, match=r"'detach_box\(uav1, box1\)' is being executed already"):
        monitor.begin(DETACHING)
    assert monitor.executing == ("hover", "detach_box(uav1, box1)")
