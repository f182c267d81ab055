"""Tests of `dyknow.service.governor`."""

from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.service.governor import GovernorSettings, LoadGovernor
from dyknow.streams.conformance import satisfies
from dyknow.streams.policy import Policy, SampleEvery
from dyknow.streams.sample import Sample
from dyknow.time import SECOND, Duration, TimePoint
from tests.support.streams import GivenSource, ms

GPS = Label("gps")
YIELDING = Policy(change=SampleEvery(ms(20), longest=ms(100)))
FIRM = Policy(change=SampleEvery(ms(20)))
SETTINGS = GovernorSettings(late_after=ms(10), patience=ms(200), relief=ms(400))


class Load:
    """A network of one source, as late as the test says at each instant."""

    def __init__(self, late: list[bool]) -> None:
        self.kernel = Kernel()
        times = [TimePoint(n * ms(20)) for n in range(len(late))]
        self.kernel.add_source(GPS, GivenSource([Sample(n, t, t) for n, t in enumerate(times)]))
        self.governor = LoadGovernor(self.kernel, lambda: self.lateness, SETTINGS)
        self.lateness = Duration(0)
        self._late = late

    def receive(self, policy: Policy) -> list[Sample[Any]]:
        """Return a list that fills with what a stream under *policy* brings."""
        received: list[Sample[Any]] = []
        self.kernel.subscribe(GPS, received.append, policy)
        return received

    def run(self) -> None:
        """Let the governor watch each instant of a whole run."""
        self.kernel.run(on_time=self._on_time)

    def _on_time(self, now: TimePoint) -> None:
        self.lateness = ms(30) if self._late[now // ms(20)] else Duration(0)
        self.governor.watch(now)


def steps(samples: list[Sample[Any]]) -> list[int]:
    """Return the milliseconds between consecutive valid times."""
    return [(b.valid_time - a.valid_time) // ms(1) for a, b in pairwise(samples)]


def test_a_late_network_lengthens_only_what_may_stand_back() -> None:
    """The yielding stream goes to 40, 80 and 100 ms, the other one stays at 20."""
    load = Load([True] * 50)
    yielding, firm = load.receive(YIELDING), load.receive(FIRM)
    load.run()
    assert set(steps(firm)) == {20}
    assert [change.after for change in load.governor.changes] == [ms(40), ms(80), ms(100)]
    assert steps(yielding)[-2:] == [100, 100]


def test_periods_are_restored_when_the_network_has_kept_up() -> None:
    """Each step back needs the time of relief."""
    load = Load([True] * 25 + [False] * 75)
    yielding = load.receive(YIELDING)
    load.run()
    assert load.governor.level == 0
    assert steps(yielding)[-3:] == [20, 20, 20]
    back = [change for change in load.governor.changes if change.after < change.before]
    assert all(later.time - one.time >= ms(400) for one, later in pairwise(back))


def test_short_lateness_changes_nothing() -> None:
    """A network that is late now and then, for less than the patience, is left alone."""
    load = Load(([True] * 5 + [False] * 5) * 10)
    load.receive(YIELDING)
    load.run()
    assert load.governor.changes == []


def test_a_stream_that_begins_under_load_stands_back_too() -> None:
    """A stream that is asked for while the periods are longer gets a longer one."""
    load = Load([True] * 50)
    load.receive(YIELDING)
    load.kernel.run(ms(500), on_time=load._on_time)  # noqa: SLF001, the run goes on below
    late_comer = load.receive(YIELDING)
    load.run()
    assert steps(late_comer)[-1] == 100


@pytest.mark.parametrize(("patience", "relief"), [(ms(0), SECOND), (SECOND, ms(500))])
def test_settings_that_would_swing_are_refused(patience: Duration, relief: Duration) -> None:
    """Durations are positive, and restoring takes at least as long as lengthening."""
    with pytest.raises(ValueError, match="load governor"):
        GovernorSettings(late_after=ms(1), patience=patience, relief=relief)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(st.tuples(st.booleans(), st.integers(1, 40)), max_size=8))
def test_whatever_the_load_the_policy_is_kept(phases: list[tuple[bool, int]]) -> None:
    """The stream satisfies its policy, and the level is what a plain count of time gives."""
    late = [is_late for is_late, length in phases for _ in range(length)]
    load = Load(late)
    yielding = load.receive(YIELDING)
    load.run()
    assert satisfies(yielding, YIELDING)
    assert load.governor.level == counted_level(late)


def counted_level(late: list[bool]) -> int:
    """Return the level after a run, by counting instants of 20 ms one by one."""
    level, since, was_late = 0, 0, None
    for at, is_late in enumerate(late):
        if is_late is not was_late:
            since, was_late = at, is_late
        if is_late and at - since >= 10 and level < 3:
            level, since = level + 1, at
        elif not is_late and at - since >= 20 and level > 0:
            level, since = level - 1, at
    return level
