"""States of several streams at one valid time."""

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import Constraint, Order, Policy, SampleEvery
from dyknow.streams.process import HearsHeartbeats
from dyknow.streams.sample import END_OF_TIME, NO_VALUE, Heartbeat, Sample
from dyknow.streams.state_buffers import Buffer, Category
from dyknow.streams.state_policy import Occasion, Settling, StateApproximation, StatePolicy
from dyknow.streams.synchronisation import Synchronisation
from dyknow.time import TimePoint
from tests.support.laws import assert_unit_laws
from tests.support.states import (
    Given,
    delayed_again,
    given_inputs,
    naive_states,
    run_synchronisation,
    samples_of,
    state_policies,
    timeless_states,
)
from tests.support.streams import GivenSource, ms, stream, text

MOST_RECENT = StateApproximation.MOST_RECENT
LINEAR = StateApproximation.LINEAR

SPEED = "1000:s1@1010 1100:s2@1110 1200:s3@1280 1300:s4@1320"
WINCH = "1050:w1@1120 1150:w2@1170 1250:w3@1260"
"""The streams of the thesis' example, table 7.1."""

KEPT = Policy(change=SampleEvery(ms(100)), max_delay=ms(100))
"""What both of them keep."""


def _run(policy, *notations, inputs=(), until=2000):
    """Return the states as text, with values side by side, and the violations."""
    unit = Synchronisation([f"s{n}" for n in range(len(notations))], policy, inputs)
    made = run_synchronisation(unit, [list(stream(n)) for n in notations], ms(until))
    return _text(samples_of(made)), unit.take_violations()


def _text(states):
    return text(
        Sample("".join("-" if v is NO_VALUE else str(v) for v in s.value), *_times(s))
        for s in states
    )


def _times(sample):
    return sample.valid_time, sample.available_time


# States of common valid times


def test_a_state_comes_when_every_stream_has_its_valid_time():
    """The state is available when the last of its values is."""
    states, violations = _run(StatePolicy(), "0:a@2 10:b@11", "0:c@5 10:d@20")

    assert states == "0:ac@5 10:bd@20"
    assert violations == []


def test_a_time_that_a_stream_leaves_out_gives_no_state_and_is_published():
    """When the stream is beyond it, no state can come."""
    states, (violation,) = _run(StatePolicy(), "0:a 10:b 20:c", "0:d 20:e")

    assert states == "0:ad 20:ce"
    assert violation.constraint is Constraint.CHANGE
    assert violation.valid_time == ms(10)
    assert violation.noticed_at == ms(20)
    assert violation.reason == "no state, for want of a sample of 's1'"


def test_the_last_estimate_before_the_state_is_complete_counts():
    """A stream in monotone order may correct itself as long as the others are not there."""
    states, violations = _run(StatePolicy(), "0:a 0:b@1", "0:c@5")

    assert states == "0:bc@5"
    assert violations == []


def test_a_stream_in_strict_order_does_not_correct_itself():
    """The first sample of a valid time counts, so that states do not depend on delays."""
    strict = (Policy(order=Order.STRICT),) * 2
    states, (violation,) = _run(StatePolicy(), "0:a 0:b@1", "0:c@5", inputs=strict)

    assert states == "0:ac@5"
    assert violation.constraint is Constraint.ORDER
    assert violation.sample == Sample("b", ms(0), ms(1))


def test_a_sample_out_of_order_is_published():
    """Streams must be in monotone order, and a state is not made twice."""
    states, violations = _run(StatePolicy(), "10:a 5:b@11 10:c@13", "10:d@12")

    assert states == "10:ad@12"
    assert [(v.constraint, v.noticed_at, v.reason) for v in violations] == [
        (Constraint.ORDER, ms(11), "'s0' is out of order: it has reached 10"),
        (Constraint.ORDER, ms(13), "'s0' is out of order: the state of that time has been made"),
    ]
    assert [v.sample.value for v in violations] == ["b", "c"]


def test_states_of_a_stream_out_of_order_come_in_order():
    """With a maximal delay a stream may be in any order; a state waits for earlier ones."""
    delayed = Policy(max_delay=ms(20))
    states, violations = _run(
        StatePolicy(), "10:b@11 0:a@15", "0:c 10:d", inputs=(delayed, Policy())
    )

    assert states == "0:ac@15 10:bd@29+999999"
    assert violations == []


# The example of the thesis, section 7.8


def test_example_7_8_1():
    """A state at each update of any stream, or when all have been updated (figure 7.9)."""
    inputs = (Policy(change=SampleEvery(ms(100))),) * 2
    any_update = StatePolicy(Occasion.ANY_UPDATE, approximation=MOST_RECENT)
    all_updates = StatePolicy(Occasion.ALL_UPDATES, approximation=MOST_RECENT)

    states, _ = _run(any_update, SPEED, WINCH, inputs=inputs)
    fewer, _ = _run(all_updates, SPEED, WINCH, inputs=inputs)

    assert states == (
        "1050:s1w1@1120 1100:s2w1@1120 1150:s2w2@1170 1200:s3w2@1280 1250:s3w3@1280 1300:s4w3@1320"
    )
    assert fewer == "1050:s1w1@1120 1150:s2w2@1170 1250:s3w3@1280"


def test_example_7_8_2():
    """The basic algorithm makes each state when the maximal delay has passed (figure 7.12)."""
    policy = StatePolicy(
        Occasion.SAMPLED,
        ms(100),
        start=ms(1050),
        end=ms(1250),
        max_delay=ms(80),
        approximation=MOST_RECENT,
        settling=Settling.AT_MAX_DELAY,
    )

    states, violations = _run(policy, SPEED, WINCH)

    assert states == "1050:s1w1@1130 1150:s2w2@1230 1250:s3w3@1330"
    assert violations == []


def test_sample_periods_follow_from_those_of_the_inputs():
    """With periods of 75 and 100 there is a state every 25, the greatest common divisor."""
    inputs = Policy(change=SampleEvery(ms(100))), Policy(change=SampleEvery(ms(75)))
    policy = StatePolicy(Occasion.SAMPLED, approximation=MOST_RECENT)

    states, _ = _run(policy, "0:a 100:b", "0:c 75:d 150:e", inputs=inputs, until=150)

    assert states == "0:ac 25:ac 50:ac 75:ad 100:bd 125:bd 150:be"


def test_example_7_8_3():
    """How long the winch is waited for at 1150 depends on the delay before approximation."""
    policy = _policy_of_table_7_2(10)
    longer = _policy_of_table_7_2(20)

    states, _ = _run(policy, SPEED, WINCH, inputs=(KEPT, KEPT))
    better, _ = _run(longer, SPEED, WINCH, inputs=(KEPT, KEPT))

    assert "1150:s2w1@1160" in states
    assert "1150:s2w2@1170" in better


def _policy_of_table_7_2(patience):
    return StatePolicy(
        Occasion.SAMPLED,
        ms(100),
        start=ms(1050),
        end=ms(1250),
        max_delay=ms(100),
        approximation=MOST_RECENT,
        delay_before_approximation=ms(patience),
    )


EXACT = Category.EXACT
APRX_FINAL = Category.APPROXIMATION_FINAL
APRX_MORE = Category.APPROXIMATION_MORE
NO_APRX_MORE = Category.NO_APPROXIMATION_MORE

TABLE_7_2 = [
    (1000, 1050, "", NO_APRX_MORE, "", NO_APRX_MORE, None),
    (1010, 1050, "s1", APRX_FINAL, "", NO_APRX_MORE, None),
    (1110, 1050, "s1 s2", APRX_FINAL, "", NO_APRX_MORE, None),
    (1120, 1050, "s1 s2", APRX_FINAL, "w1", EXACT, "1050:s1w1@1120"),
    (1120, 1150, "s2", APRX_FINAL, "w1", APRX_MORE, None),
    (1170, 1150, "s2", APRX_FINAL, "w2", EXACT, "1150:s2w2@1170"),
    (1170, 1250, "s2", APRX_MORE, "w2", APRX_MORE, None),
    (1260, 1250, "s2", APRX_MORE, "w3", EXACT, None),
    (1280, 1250, "s3", APRX_FINAL, "w3", EXACT, "1250:s3w3@1280"),
]
"""Now, synchronisation time, buffer and category of speed and of winch, new state.

Two cells of the printed table contradict its text and are corrected: in the seventh row the winch
buffer holds w1, which w2 has replaced; in the ninth the speed buffer has the value s2 at 1200.
"""


def test_table_7_2():
    """The states of the improved algorithm, and what it knows between them."""
    policy = _policy_of_table_7_2(100)
    unit = Synchronisation(["speed", "winch"], policy, [KEPT, KEPT])
    streams = [list(stream(SPEED)), list(stream(WINCH))]

    for now, time, *row in TABLE_7_2:
        if row[-1] is not None:
            continue  # here the unit goes on to the next state at once
        known = Synchronisation(["speed", "winch"], policy, [KEPT, KEPT])
        run_synchronisation(known, streams, ms(now))
        for buffer in known.buffers:
            buffer.forget(ms(time))
        found = [(_values(b.samples), b.category(ms(time), ms(now))) for b in known.buffers]
        assert known.time == ms(time)
        assert [part for pair in found for part in pair] == row[:-1]
    states = samples_of(run_synchronisation(unit, streams, ms(2000)))

    assert _text(states) == " ".join(row[-1] for row in TABLE_7_2 if row[-1])
    assert unit.take_violations() == []
    assert unit.counts.early == 0


@pytest.mark.parametrize("row", range(len(TABLE_7_2)))
def test_rows_of_table_7_2(row):
    """Each row, from what has arrived alone: the buffers, the categories, whether all is known."""
    now, time, speed, of_speed, winch, of_winch, state = TABLE_7_2[row]
    buffers = [Buffer(KEPT, _policy_of_table_7_2(100)) for _ in range(2)]

    for buffer, notation in zip(buffers, (SPEED, WINCH), strict=True):
        for sample in stream(notation):
            if sample.available_time <= ms(now):
                buffer.add(sample)
        buffer.forget(ms(time))

    assert [_values(buffer.samples) for buffer in buffers] == [speed, winch]
    assert [buffer.category(ms(time), ms(now)) for buffer in buffers] == [of_speed, of_winch]
    assert (state is not None) == all(
        buffer.complete_at(ms(now)) >= buffer.needed(ms(time)) for buffer in buffers
    )


def _values(samples):
    return " ".join(sample.value for sample in samples)


def test_the_variant_of_table_7_2_with_a_delay_of_70():
    """The third speed has a delay of 80, so that it is not waited for; it comes too late."""
    policy = _policy_of_table_7_2(70)
    unit = Synchronisation(["speed", "winch"], policy, [KEPT, KEPT])
    streams = [list(stream(SPEED)), list(stream(WINCH))]

    states = samples_of(run_synchronisation(unit, streams, ms(2000)))

    assert _text(states) == "1050:s1w1@1120 1150:s2w2@1170 1250:s2w3@1270"
    assert unit.counts.early == 1
    (violation,) = unit.take_violations()
    assert violation.constraint is Constraint.DELAY
    assert violation.sample.value == "s3"
    assert violation.reason == "'speed' is late by 80: states up to 1250 were made without it"


def test_sync_with_a_sample_period():
    """The value before stands for a stream without a sample at the time (ROS paper, III)."""
    policy = StatePolicy(Occasion.SAMPLED, ms(2), start=ms(1), approximation=MOST_RECENT)

    states, _ = _run(policy, "1:a 3:b 5:c 7:d", "1:x 4:y 5:z@6 8:w")

    assert states == "1:ax 3:bx@4 5:cz@6 7:dz@8"


# The example of docs/synchronisation.md


@pytest.mark.parametrize(
    ("policy", "expected"),
    [
        (StatePolicy(), ""),
        (StatePolicy(approximation=MOST_RECENT), "10:s0w1@40 40:s1w1@100 70:s1w2@100"),
        (
            StatePolicy(Occasion.ALL_UPDATES, approximation=MOST_RECENT),
            "10:s0w1@40 70:s1w2@100",
        ),
        (
            StatePolicy(Occasion.SAMPLED, ms(20), approximation=MOST_RECENT),
            "10:s0w1@40 30:s0w1@100 50:s1w1@100 70:s1w2@100",
        ),
    ],
)
def test_the_example_of_the_guide(policy, expected):
    """The guide says the truth about the states of each kind, and about when they are made."""
    inputs = (Policy(change=SampleEvery(ms(40))), Policy())

    states, _ = _run(policy, "0:s0@5 40:s1@45 80:s2@85", "10:w1@40 70:w2@100", inputs=inputs)

    assert states == expected


# What is missing


def test_a_sampled_state_is_made_without_values_when_the_maximal_delay_has_passed():
    """The absence of a value is explicit, and published."""
    policy = StatePolicy(
        Occasion.SAMPLED, ms(10), start=ms(0), end=ms(10), max_delay=ms(30), approximation=LINEAR
    )

    states, violations = _run(policy, "0:1 10:2", "")

    assert states == "0:1-@30 10:2-@40"
    assert [(v.constraint, v.valid_time, v.noticed_at, v.reason) for v in violations] == [
        (Constraint.APPROXIMATION, ms(0), ms(30), "no value of 's1'"),
        (Constraint.APPROXIMATION, ms(10), ms(40), "no value of 's1'"),
    ]


def test_a_state_without_a_value_comes_early_if_none_can_come():
    """An input that has gone on without a value will not have one later."""
    policy = StatePolicy(Occasion.SAMPLED, ms(10), start=ms(0), end=ms(10))

    states, _ = _run(policy, "0:a 10:b", "3:c 10:d")

    assert states == "0:a-@3 10:bd"


def test_states_of_updates_begin_when_every_input_has_a_value():
    """What comes before is not missed: without a start the inputs say when states begin."""
    policy = StatePolicy(approximation=MOST_RECENT)

    states, violations = _run(policy, "0:a 10:b 20:c", "15:x 30:y")

    assert states == "15:bx@20 20:cx@30"
    assert violations == []


def test_a_silent_input_is_given_up_after_the_maximal_delay():
    """With a maximal delay nothing waits for ever, and what is given up is published."""
    policy = StatePolicy(max_delay=ms(50))

    states, violations = _run(policy, "0:a 10:b", "")

    assert states == ""
    assert [(v.valid_time, v.noticed_at) for v in violations] == [
        (ms(0), ms(50)),
        (ms(10), ms(60)),
    ]


def test_samples_wait_for_a_silent_input_up_to_the_capacity():
    """Without a maximal delay memory is bounded by a number of samples; that is published."""
    unit = Synchronisation("ab", StatePolicy(capacity=100))
    streams = [[Sample(n, ms(n), ms(n)) for n in range(1000)], []]

    run_synchronisation(unit, streams, ms(2000))

    assert max(len(buffer.samples) for buffer in unit.buffers) == 100
    assert unit.counts.crowded == unit.counts.given_up == 900
    first, second = unit.take_violations()[:2]
    assert first.reason == (
        "not waited for any longer: more than 100 samples of 'a' wait for other inputs"
    )
    assert second.reason == "no state, for want of a sample of 'b'"


def test_samples_wait_for_the_first_sample_of_a_silent_input_up_to_the_capacity():
    """Before states have begun the oldest samples are forgotten; each is published."""
    policy = StatePolicy(Occasion.SAMPLED, ms(10), approximation=MOST_RECENT, capacity=100)
    unit = Synchronisation("ab", policy)
    late = Sample("x", ms(980), ms(1500))
    streams = [[Sample(n, ms(n), ms(n)) for n in range(1000)], [late]]

    made = samples_of(run_synchronisation(unit, streams, ms(1400)))
    made += samples_of(unit.push(ms(1500), (streams[0][-1], late)))

    assert unit.counts.crowded == 900
    assert [(state.valid_time, state.value) for state in made] == [(ms(980), (980, "x"))]
    assert unit.take_violations()[0].sample.value == 0


def test_samples_between_two_sampled_states_are_not_kept():
    """A fast input waits for a slow one with as many samples as states need."""
    for approximation, at_most in [(MOST_RECENT, 12), (LINEAR, 22)]:
        policy = StatePolicy(Occasion.SAMPLED, ms(100), start=ms(0), approximation=approximation)
        unit = Synchronisation("ab", policy)
        fast = [Sample(n, ms(n), ms(n)) for n in range(1000)]
        slow = [Sample(n, ms(100 * n), ms(100 * n + 1000)) for n in range(10)]

        early = run_synchronisation(unit, [fast, []], ms(999))

        assert early == []
        assert len(unit.buffers[0].samples) <= at_most
        whole = Synchronisation("ab", policy)
        states = samples_of(run_synchronisation(whole, [fast, slow], ms(3000)))
        assert [state.value for state in states[:9]] == [(100 * n, n) for n in range(9)]


def test_values_that_cannot_be_interpolated_are_published():
    """Between two words there is none."""
    policy = StatePolicy(approximation=LINEAR)

    states, (violation,) = _run(policy, "0:1 5:2 10:3", "0:up 10:down")

    assert states == "0:1up 5:2-@10 10:3down"
    assert violation.reason == "values of 's1' cannot be interpolated, found str"


def test_the_absence_of_a_value_is_not_interpolated():
    """Next to an explicit absence there is none, which needs no report."""
    unit = Synchronisation("ab", StatePolicy(approximation=LINEAR))
    absent = [Sample(1, ms(0), ms(0)), Sample(NO_VALUE, ms(10), ms(10)), *stream("20:c")]

    made = run_synchronisation(unit, [stream("0:x 5:y 10:z"), absent], ms(100))

    assert [state.value[1] for state in samples_of(made)] == [1, NO_VALUE, NO_VALUE]
    assert unit.take_violations() == []


@pytest.mark.parametrize(
    ("notation", "kept"),
    [
        ("0:0 30:1@50 30:3@51", Policy(order=Order.MONOTONE)),
        ("0:0 40:5@49 30:3@51", Policy(max_delay=ms(30))),
    ],
)
def test_the_first_sample_after_the_end_counts_for_interpolation(notation, kept):
    """Of the samples beyond the end the earliest is kept, as it was last said."""
    numbers = [Sample(int(s.value), *_times(s)) for s in stream(notation)]
    others = Policy(max_delay=ms(60))
    unit = Synchronisation("ab", StatePolicy(end=ms(10), approximation=LINEAR), [others, kept])

    made = run_synchronisation(unit, [stream("0:a 10:b"), numbers], ms(100))

    assert samples_of(made)[-1].value == ("b", 1.0)
    assert len(unit.buffers[1].samples) == 2


def test_an_input_may_come_to_keep_another_policy():
    """When a stream is sampled more often from now on, its samples are not out of order."""
    policy = StatePolicy(Occasion.SAMPLED, ms(50), start=ms(0), approximation=MOST_RECENT)
    unit = Synchronisation("a", policy, [KEPT])
    samples = stream("0:a 100:b 150:c 200:d")

    made = run_synchronisation(unit, [samples[:2]], ms(149))
    unit.expect(0, Policy(change=SampleEvery(ms(50))))
    made += run_synchronisation(unit, [samples[2:]], ms(300))

    assert _text(samples_of(made)) == "0:a 50:a 100:b 150:c 200:d"
    assert unit.take_violations() == []


# Heartbeats


def test_a_heartbeat_stands_for_samples_that_will_not_come():
    """A silent stream that says that it has nothing does not hold up the others."""
    policy = StatePolicy(approximation=MOST_RECENT)
    unit = Synchronisation("ab", policy)
    streams = [
        list(stream("0:a 10:b 20:c")),
        [*stream("0:x"), Heartbeat(ms(15), ms(21))],
    ]

    made = run_synchronisation(unit, streams, ms(100))

    assert isinstance(unit, HearsHeartbeats)
    assert _text(samples_of(made)) == "0:ax 10:bx@21"
    assert made[-1] == Heartbeat(ms(15), ms(21))


def test_times_passed_over_give_a_heartbeat():
    """Who waits for states learns that there is none where an input has nothing."""
    unit = Synchronisation("ab")

    made = run_synchronisation(unit, [stream("0:a 10:b"), stream("0:c 20:d")], ms(100))

    assert made[1:] == [Heartbeat(ms(10), ms(20))]


def test_states_end_with_their_inputs():
    """When all inputs have ended there is no state after their last sample."""
    policy = StatePolicy(Occasion.SAMPLED, ms(10), start=ms(0), approximation=MOST_RECENT)
    unit = Synchronisation("a", policy)
    streams = [[*stream("0:a 25:b"), Heartbeat(END_OF_TIME, ms(30))]]

    made = run_synchronisation(unit, streams, ms(1000))

    assert _text(samples_of(made)) == "0:a 10:a@25 20:a@25"
    assert made[-1] == Heartbeat(END_OF_TIME, ms(30))


def test_a_heartbeat_is_believed():
    """A sample that a heartbeat has excluded is out of order."""
    unit = Synchronisation("ab")
    streams = [[Heartbeat(ms(10), ms(11)), *stream("5:a@12")], []]

    run_synchronisation(unit, streams, ms(100))

    (violation,) = unit.take_violations()
    assert violation.reason == "'a' is out of order: it has reached 10"


def test_states_of_silent_inputs_come_as_time_passes():
    """A heartbeat into the future does not bring states of the future."""
    policy = StatePolicy(Occasion.SAMPLED, ms(10), start=ms(0), approximation=MOST_RECENT)
    unit = Synchronisation("a", policy)
    streams = [[*stream("0:a"), Heartbeat(ms(10_000), ms(1))]]

    made = run_synchronisation(unit, streams, ms(25))

    assert _text(samples_of(made)) == "0:a 10:a 20:a"


def test_states_in_a_network_hear_that_a_stream_is_silent():
    """Heartbeats of a source, and its end, reach the states made of its stream, and go on."""
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource(list(stream("0:a 10:b 20:c 50:d"))))
    silent = [*stream("0:x"), Heartbeat(ms(15), ms(16)), Heartbeat(END_OF_TIME, ms(30))]
    kernel.add_source(Label("b"), GivenSource(silent))
    inputs = [(Label("a"), Policy()), (Label("b"), Policy())]
    recent = StatePolicy(approximation=MOST_RECENT)
    kernel.add_unit(Label("states"), Synchronisation("ab", recent), inputs)
    again = [(Label("states"), Policy()), (Label("a"), Policy())]
    kernel.add_unit(Label("both"), Synchronisation(["states", "a"]), again)
    states, both = [], []
    kernel.subscribe(Label("states"), states.append)
    kernel.subscribe(Label("both"), both.append)

    kernel.run(until=ms(100))

    assert _text(states) == "0:ax 10:bx@16 20:cx@30 50:dx"
    assert [state.valid_time for state in both] == [ms(0), ms(10), ms(20), ms(50)]


# What cannot be asked for


@pytest.mark.parametrize(
    ("names", "policy", "inputs", "reason"),
    [
        ("", StatePolicy(), (), "a synchronisation needs at least one input"),
        ("ab", StatePolicy(), (Policy(),), "expected 2 policies of inputs, found 1"),
        (
            "ab",
            StatePolicy(Occasion.SAMPLED),
            (KEPT, Policy()),
            "states without a sample period of their own need inputs that are sampled, 'b' is not",
        ),
    ],
)
def test_unfit_inputs_are_refused(names, policy, inputs, reason):
    """The reason says what is expected and what was found."""
    with pytest.raises(ValueError, match=reason):
        Synchronisation(names, policy, inputs)


# Laws


UNTIL = TimePoint(90)
INPUTS = st.lists(given_inputs(has_repeats=True), min_size=1, max_size=3)
ENDED_INPUTS = st.lists(given_inputs(is_ended=True), min_size=1, max_size=3)


def _made(streams, policy):
    unit = Synchronisation("abc"[: len(streams)], policy, [given.policy for given in streams])
    return run_synchronisation(unit, [given.elements for given in streams], UNTIL), unit


def _rows(states):
    return [(state.valid_time, state.value, state.available_time) for state in states]


@settings(derandomize=True, deadline=None, max_examples=120)
@given(INPUTS, state_policies())
def test_states_are_made_as_defined(streams, policy):
    """Values, valid times and available times are those of the definition, tried naively."""
    made, _ = _made(streams, policy)

    assert _rows(samples_of(made)) == _rows(naive_states(streams, policy, UNTIL))


@settings(derandomize=True, deadline=None, max_examples=120)
@given(ENDED_INPUTS, state_policies(is_patient=True))
def test_patient_states_depend_on_valid_times_alone(streams, policy):
    """Without delays of its own a synchronisation gives the states of the complete streams."""
    made, unit = _made(streams, policy)

    states = [(state.valid_time, state.value) for state in samples_of(made)]
    assert states == timeless_states(streams, policy)
    assert unit.counts.early == unit.counts.late == unit.counts.out_of_order == 0


@settings(derandomize=True, deadline=None, max_examples=120)
@given(st.data(), ENDED_INPUTS, state_policies(is_patient=True))
def test_patient_states_do_not_depend_on_delays(data, streams, policy):
    """The same streams with other delays and heartbeats give the same states."""
    again = [data.draw(delayed_again(given)) for given in streams]

    made, _ = _made(streams, policy)
    other, _ = _made(again, policy)

    assert [(s.valid_time, s.value) for s in samples_of(made)] == [
        (s.valid_time, s.value) for s in samples_of(other)
    ]


@settings(derandomize=True, deadline=None, max_examples=80)
@given(INPUTS, state_policies())
def test_heartbeats_are_true(streams, policy):
    """States come in strict order, and none where a heartbeat has excluded it."""
    made, _ = _made(streams, policy)

    times = [e.until if isinstance(e, Heartbeat) else e.valid_time for e in made]
    assert all(one < other for one, other in pairwise(times))


@settings(derandomize=True, deadline=None, max_examples=80)
@given(INPUTS, state_policies(), st.integers(1, 5))
def test_synchronisation_keeps_the_laws_of_units(streams, policy, tick):
    """It is repeatable, does not depend on ticks, and the future does not change the past."""
    inputs = [samples_of(given.elements) for given in streams]
    assert_unit_laws(
        lambda: _StatesAlone(Synchronisation("abc"[: len(streams)], policy, _kept(streams))),
        *inputs,
        until=TimePoint(60),
        tick=tick,
    )


def _kept(streams: list[Given]) -> list[Policy]:
    return [given.policy for given in streams]


class _StatesAlone:
    """A synchronisation without its heartbeats."""

    def __init__(self, unit):
        self._unit = unit
        self.due = unit.due

    def push(self, now, inputs):
        return samples_of(self._unit.push(now, inputs))

    def advance(self, now):
        return samples_of(self._unit.advance(now))


@settings(derandomize=True, deadline=None, max_examples=80)
@given(
    st.lists(
        st.lists(st.tuples(st.integers(0, 40), st.integers(0, 30)), max_size=12),
        min_size=2,
        max_size=3,
    ),
    state_policies(),
)
def test_every_sample_is_used_or_published(disorder, policy):
    """Streams that keep nothing: samples out of order and too late are published, not lost."""
    streams = [_disordered(pairs) for pairs in disorder]
    unit = Synchronisation("abc"[: len(streams)], policy)

    made = samples_of(run_synchronisation(unit, streams, TimePoint(500)))

    published = [v.sample for v in unit.take_violations() if v.sample is not None]
    for samples in streams:
        reached = -1
        for sample in samples:
            is_in_order = sample.valid_time >= reached
            assert is_in_order or any(each is sample for each in published)
            reached = max(reached, sample.valid_time)
    assert unit.counts.late + unit.counts.out_of_order == len(published)
    times = [state.valid_time for state in made]
    assert times == sorted(set(times))


def _disordered(pairs):
    available = -1
    samples = []
    for valid_time, gap in pairs:
        available += 1 + gap
        samples.append(Sample(valid_time, TimePoint(valid_time), TimePoint(available)))
    return samples
