"""Several streams into one."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.conformance import satisfies
from dyknow.streams.merging import Merge
from dyknow.streams.policy import Order, Policy
from dyknow.streams.sample import Sample
from dyknow.streams.stream import is_fluent_stream
from dyknow.time import TimePoint
from tests.support.laws import assert_unit_laws
from tests.support.policies import adapted, policies, streams
from tests.support.streams import ms, run_unit, stream, text

END = ms(400)


def test_figure_3_two_streams_become_one():
    """Every sample of both streams is in the merged one, in order of available time."""
    s1 = stream("0:a 20:b@25 40:c")
    s2 = stream("10:x 15:y@30")

    assert text(run_unit(Merge(2), s1, s2, until=END)) == "0:a 10:x 20:b@25 15:y@30 40:c"


def test_samples_of_one_time_come_in_the_order_of_the_inputs():
    """In the merged stream they have different available times."""
    late = Sample("d", ms(10), TimePoint(ms(10) + 2))
    inputs = stream("10:a"), stream("10:b"), [*stream("5:c@10"), late]

    made = run_unit(Merge(3), *inputs, until=END)

    assert text(made) == "10:a 10:b@10+1 5:c@10+2 10:d@10+3"


def test_a_merge_needs_an_input():
    """A stream of nothing at all is a mistake."""
    with pytest.raises(ValueError, match="a merge needs at least one input, found 0"):
        Merge(0)


@settings(derandomize=True, deadline=None, max_examples=80)
@given(st.lists(streams(), min_size=1, max_size=4))
def test_nothing_is_lost_and_nothing_is_added(given_streams):
    """Sorted by available time and number of the input, all samples are there once."""
    made = run_unit(Merge(len(given_streams)), *given_streams, until=END)

    expected = sorted(
        (sample.available_time, at, sample.valid_time, sample.value)
        for at, one in enumerate(given_streams)
        for sample in one
    )
    assert is_fluent_stream(made)
    assert [(s.valid_time, s.value) for s in made] == [(v, value) for _, _, v, value in expected]
    assert all(0 <= s.available_time - e[0] < 4 for s, e in zip(made, expected, strict=True))


@settings(derandomize=True, deadline=None, max_examples=60)
@given(streams(), streams(), policies().filter(lambda policy: policy.period is None))
def test_the_merged_stream_keeps_the_policy_under_which_it_is_received(one, other, policy):
    """What does not fit into the order is left out, as of any stream."""
    merged = run_unit(Merge(2), one, other, until=END)

    made, _ = adapted(merged, policy, END)

    assert satisfies(made, policy)


def test_repetitions_and_what_is_out_of_order_can_be_left_out():
    """Two cameras that report the same thing make one stream in strict order."""
    merged = run_unit(Merge(2), stream("0:a 20:b 40:c"), stream("0:a 10:x@25 40:c"), until=END)

    made, published = adapted(merged, Policy(order=Order.STRICT), END)

    assert text(made) == "0:a 20:b 40:c"
    assert [text([v.sample]) for v in published if v.sample] == ["0:a@0+1", "10:x@25", "40:c@40+1"]


@settings(derandomize=True, deadline=None, max_examples=30)
@given(streams(), streams())
def test_merge_keeps_the_laws(one, other):
    """Merge is a unit like any other."""
    assert_unit_laws(lambda: Merge(2), one, other, until=END, tick=ms(7))
