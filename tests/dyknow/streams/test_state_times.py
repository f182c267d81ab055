"""At which valid times there are states."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.policy import Policy
from dyknow.streams.sample import Sample
from dyknow.streams.state_buffers import FOREVER, Buffer
from dyknow.streams.state_policy import StatePolicy
from dyknow.streams.state_times import Grid, Updates
from dyknow.time import TimePoint
from tests.support.streams import ms


def _buffer(policy=Policy(), *valid_times):  # noqa: B008, a frozen value
    buffer = Buffer(policy, StatePolicy())
    for time in valid_times:
        buffer.add(Sample("a", ms(time), ms(time)))
    return buffer


def test_a_grid_goes_on_by_its_period():
    """Each time-point is one period after the one before."""
    grid = Grid(ms(5), ms(10))

    grid.move_on()

    assert grid.current == ms(15)
    assert grid.has(ms(5))
    assert not grid.has(ms(10))
    assert not grid.has(ms(-5))


def test_a_grid_without_a_start_begins_where_the_last_input_does():
    """The latest of the first valid times is the start, once it is certain."""
    grid = Grid(None, ms(10))
    buffers = [_buffer(Policy(), 3, 8), _buffer()]
    silent = grid.begins(buffers)

    buffers[1].add(Sample("a", ms(7), ms(7)))

    assert silent == FOREVER
    assert grid.current == FOREVER
    assert grid.begins(buffers) == -1  # certain at any time
    assert grid.begin(buffers) == grid.current == ms(7)


def test_the_first_valid_time_of_a_stream_out_of_order_is_certain_after_its_delay():
    """Until then an earlier sample may come."""
    grid = Grid(None, ms(10))

    assert grid.begins([_buffer(Policy(max_delay=ms(50)), 20)]) == ms(70) - 1


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.integers(0, 20).map(TimePoint)), st.integers(0, 20))
def test_updates_are_in_order_and_each_there_once(noted, settled):
    """Whatever the order of arrival, times are passed in order."""
    updates = Updates()
    passed = []

    for time in noted:
        updates.note(_buffer(), time)
    while updates.current != FOREVER:
        passed.append(updates.current)
        updates.move_on()

    assert passed == sorted(set(noted))
