"""States of several streams at one valid time."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.policy import Constraint
from dyknow.streams.sample import Sample
from dyknow.streams.stream import is_fluent_stream
from dyknow.streams.synchronisation import Synchronisation
from tests.support.laws import assert_unit_laws
from tests.support.streams import ms, run_unit, stream, text


def _states(*notations):
    unit = Synchronisation([f"s{n}" for n in range(len(notations))])
    states = run_unit(unit, *map(stream, notations), until=ms(1000))
    for state in states:
        state.value = "".join(state.value)
    return text(states), unit.take_violations()


def test_a_state_comes_when_every_stream_has_its_valid_time():
    """The state is available when the last of its values is."""
    states, violations = _states("0:a@2 10:b@11", "0:c@5 10:d@20")

    assert states == "0:ac@5 10:bd@20"
    assert violations == []


def test_a_time_that_a_stream_leaves_out_gives_no_state_and_is_published():
    """When the stream is beyond it, no state can come."""
    states, (violation,) = _states("0:a 10:b 20:c", "0:d 20:e")

    assert states == "0:ad 20:ce"
    assert violation.constraint is Constraint.CHANGE
    assert violation.valid_time == ms(10)
    assert violation.noticed_at == ms(20)
    assert violation.reason == "no state, for want of a sample of 's1'"


def test_the_last_estimate_before_the_state_is_complete_counts():
    """A stream may correct itself as long as the others are not there."""
    states, violations = _states("0:a 0:b@1", "0:c@5")

    assert states == "0:bc@5"
    assert violations == []


def test_a_sample_out_of_order_is_published():
    """Streams must be in monotone order, and a state is not made twice."""
    states, violations = _states("10:a 5:b@11 10:c@13", "10:d@12")

    assert states == "10:ad@12"
    assert [(v.constraint, v.noticed_at) for v in violations] == [
        (Constraint.ORDER, ms(11)),
        (Constraint.ORDER, ms(13)),
    ]


MONOTONE = st.lists(
    st.tuples(st.integers(0, 3), st.integers(0, 4), st.sampled_from("ab")), max_size=10
)


def _monotone(steps):
    valid = available = -1
    samples = []
    for gap, delay, value in steps:
        valid = valid + 1 + gap
        available = max(valid + delay, available + 1)
        samples.append(Sample(value, ms(valid), ms(available)))
    return samples


@settings(derandomize=True, deadline=None, max_examples=100)
@given(MONOTONE, MONOTONE, MONOTONE)
def test_states_are_the_common_valid_times_whatever_the_delays(one, two, three):
    """Values and valid times of the states do not depend on when samples arrive."""
    streams = [_monotone(steps) for steps in (one, two, three)]

    states = run_unit(Synchronisation("abc"), *streams, until=ms(1000))

    by_time = [{sample.valid_time: sample.value for sample in given} for given in streams]
    common = sorted(set(by_time[0]) & set(by_time[1]) & set(by_time[2]))
    expected = [(time, tuple(values[time] for values in by_time)) for time in common]
    assert [(state.valid_time, state.value) for state in states] == expected


@settings(derandomize=True, deadline=None, max_examples=100)
@given(MONOTONE, MONOTONE)
def test_synchronisation_keeps_the_laws_of_units(one, two):
    """It is repeatable, does not depend on ticks, and the future does not change the past."""
    streams = [_monotone(one), _monotone(two)]

    assert all(map(is_fluent_stream, streams))
    assert_unit_laws(lambda: Synchronisation("ab"), *streams, until=ms(60), tick=ms(3))
