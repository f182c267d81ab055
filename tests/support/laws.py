"""The laws that every computational unit keeps; see STYLE on streams and processes."""

from collections.abc import Callable
from typing import Any

from dyknow.streams.process import ComputationalUnit
from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint
from tests.support.streams import run_unit

__all__ = ["assert_unit_laws", "same_streams"]


def assert_unit_laws(
    make: Callable[[], ComputationalUnit],
    *inputs: list[Sample[Any]],
    until: TimePoint,
    tick: int,
) -> None:
    """Check the four laws for the unit that *make* makes, on the given input streams.

    The same input gives the same output; the output does not depend on how often time is
    advanced; it is in order of available time; the future does not change the past.
    """
    output = run_unit(make(), *inputs, until=until)
    assert same_streams(run_unit(make(), *inputs, until=until), output), "not repeatable"
    ticked = run_unit(make(), *inputs, until=until, tick=tick)
    assert same_streams(ticked, output), "depends on how often time is advanced"
    times = [sample.available_time for sample in output]
    assert times == sorted(times), "not in order of available time"
    middle = TimePoint(until // 2)
    past = [[s for s in given if s.available_time <= middle] for given in inputs]
    early = run_unit(make(), *past, until=middle)
    assert same_streams(early, output[: len(early)]), "the future has changed the past"


def same_streams(left: list[Sample[Any]], right: list[Sample[Any]]) -> bool:
    """Return whether two streams have the same samples."""
    return len(left) == len(right) and all(
        one.valid_time == other.valid_time
        and one.available_time == other.available_time
        and are_equal(one.value, other.value)
        for one, other in zip(left, right, strict=True)
    )
