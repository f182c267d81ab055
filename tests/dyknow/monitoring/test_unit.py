"""The unit that makes verdicts out of states."""

from dyknow.monitoring.interpretation import Origin
from dyknow.monitoring.reading import StateReader
from dyknow.monitoring.unit import Decision, FormulaUnit, OnGap
from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.syntax import Verdict
from dyknow.streams.policy import Constraint, Violation
from dyknow.streams.process import HearsHeartbeats
from dyknow.streams.sample import END_OF_TIME, Heartbeat, Sample
from tests.support.streams import ms

END, CONTINUE = OnGap.END, OnGap.CONTINUE


def _unit(on_gap=END, **formulas):
    group = FormulaGroup()
    for name, text in (formulas or {"calm": "always x < 5"}).items():
        group.add(name, text)
    return FormulaUnit(group, StateReader([Origin("x", "x")], ["x"], {}), on_gap)


def _push(unit, time, value):
    return list(unit.push(ms(time + 1), (Sample((value,), ms(time), ms(time + 1)),)))


def _beat(unit, until, now):
    return list(unit.beat(ms(now), 0, Heartbeat(ms(until), ms(now))))


def _verdict(name, verdict, time, now):
    return Sample({"formula": name, "verdict": verdict}, ms(time), ms(now))


def _gap(time, noticed_at=0):
    return Violation(Constraint.CHANGE, ms(time), ms(noticed_at), "for some reason")


def test_a_verdict_is_emitted_once_and_then_there_is_nothing_left_to_say():
    """With each state comes a heartbeat; the last one says that no verdict will follow."""
    unit, told = _unit(), []
    unit.on_decided, unit.on_over = told.append, lambda: told.append("over")

    assert isinstance(unit, HearsHeartbeats)
    assert _push(unit, 10, 3) == [Heartbeat(ms(10), ms(11))]
    assert _beat(unit, 15, 16) == [Heartbeat(ms(15), ms(16))]
    assert _push(unit, 20, 7) == [
        _verdict("calm", "false", 20, 21),
        Heartbeat(END_OF_TIME, ms(21)),
    ]
    assert _push(unit, 30, 7) == _beat(unit, 40, 41) == []
    assert told == [Decision("calm", Verdict.FALSE, ms(20), ms(21)), "over"]
    assert unit.due() is None


def test_a_gap_counts_from_its_valid_time_on():
    """States before it are evaluated, also when it is known already."""
    unit = _unit(calm="always x < 5", soon="eventually x = 4")
    unit.note(_gap(30))

    assert unit.pending == _gap(30)
    assert _push(unit, 10, 3) == [Heartbeat(ms(10), ms(11))]
    assert _push(unit, 20, 4)[0] == _verdict("soon", "true", 20, 21)
    assert _push(unit, 30, 9) == [
        _verdict("calm", "undecided", 30, 31),
        Heartbeat(END_OF_TIME, ms(31)),
    ]
    assert unit.ended_by == _gap(30)
    assert unit.group.verdicts["calm"] is Verdict.UNDECIDED
    unit.note(_gap(40))
    assert unit.pending is None


def test_a_state_that_was_passed_over_ends_the_evaluation():
    """What tells it is the heartbeat; the verdict is valid after what has been promised."""
    unit = _unit()
    _push(unit, 10, 3)
    unit.note(_gap(20))

    assert _beat(unit, 15, 16) == [Heartbeat(ms(15), ms(16))]
    assert _beat(unit, 25, 26)[0] == _verdict("calm", "undecided", 20, 26)


def test_a_gap_in_the_past_ends_the_evaluation_with_the_next_state():
    """A sample was late, or out of order: what was made without it does not count."""
    unit = _unit()
    _push(unit, 10, 3)
    unit.note(_gap(5))
    assert _push(unit, 20, 9)[0] == _verdict("calm", "undecided", 20, 21)

    unit = _unit()
    _push(unit, 10, 3)
    unit.note(_gap(5))
    (sample, _) = _beat(unit, 12, 13)
    assert sample.valid_time == ms(10) + 1


def test_gaps_can_be_passed_over():
    """They are counted; an unfit state is published, once, and the last one holds on."""
    unit = _unit(CONTINUE, short="always [0, 30] x < 5")
    unit.note(_gap(5))
    assert unit.pending is None
    assert _push(unit, 10, 3) == [Heartbeat(ms(10), ms(11))]
    assert _push(unit, 20, "far") == [Heartbeat(ms(20), ms(21))]
    unit.note(_gap(30))
    assert _push(unit, 30, "far") == [Heartbeat(ms(30), ms(31))]

    (violation,) = unit.take_violations()
    assert (violation.valid_time, violation.noticed_at) == (ms(20), ms(21))
    assert violation.definition == "7.8.1"
    assert unit.take_violations() == []
    assert unit.gaps == 3
    assert _push(unit, 50, 3)[0] == _verdict("short", "true", 50, 51)
    assert unit.ended_by is None
