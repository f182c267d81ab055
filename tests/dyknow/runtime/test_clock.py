"""Clocks let a run wait and change nothing else."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.runtime.clock import VirtualClock, WallClock, wait_seconds
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import Approximation, Policy, SampleEvery
from dyknow.streams.sample import Sample
from dyknow.time import SECOND
from tests.support.policies import streams
from tests.support.streams import GivenSource, ms

RECENT = Policy(
    approximation=Approximation.MOST_RECENT,
    change=SampleEvery(ms(10)),
    max_delay=ms(5),
    start=ms(0),
)


class Wall:
    """A clock on the wall that moves only when somebody sleeps or works."""

    def __init__(self):
        self.now = 1_000 * SECOND
        self.slept = []

    def sleep(self, seconds):
        """Let time pass."""
        self.slept.append(seconds)
        self.now += round(seconds * SECOND)


class Working:
    """Takes a while for each sample, on the wall."""

    def __init__(self, wall, takes):
        self.wall = wall
        self.takes = takes

    def push(self, now, inputs):
        """Work."""
        self.wall.now += self.takes
        return [Sample(inputs[0].value, inputs[0].valid_time, now)]

    def advance(self, now):
        """Say nothing."""
        return ()

    def due(self):
        """Wait for nothing."""


def run_with(clock, samples, takes=0, wall=None):
    """Return what a unit and a sampled subscription give under a clock."""
    kernel, received = Kernel(), []
    kernel.add_source(Label("a"), GivenSource(samples))
    unit = Working(wall or Wall(), takes)
    kernel.add_unit(Label("b"), unit, [(Label("a"), Policy())])
    kernel.subscribe(Label("b"), received.append, RECENT)
    kernel.subscribe(Label("b"), received.append)
    kernel.run(ms(300), clock=clock)
    return repr(received)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(streams(), st.integers(0, 30))
def test_the_clock_does_not_change_the_results(samples, takes):
    """In virtual time and in real time, late or not, the same samples come at the same times."""
    wall = Wall()
    clock = WallClock(ms(1), now_ns=lambda: wall.now, sleep=wall.sleep)

    assert run_with(clock, samples, ms(takes), wall) == run_with(VirtualClock(), samples)


def test_an_instant_begins_when_it_is_that_time_outside():
    """The work waits for the wall, and the run ends when its end has come."""
    wall = Wall()
    begun = []
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource("0:a 40:b 100:c"))
    kernel.subscribe(Label("a"), lambda sample: begun.append(wall.now - 1_000 * SECOND))

    kernel.run(ms(150), clock=WallClock(ms(1), now_ns=lambda: wall.now, sleep=wall.sleep))

    assert begun == [ms(0), ms(40), ms(100)]
    assert wall.now == 1_000 * SECOND + ms(150)


def test_what_passes_between_two_runs_is_left_out():
    """A run goes on at the time at which the last one stopped."""
    wall = Wall()
    clock = WallClock(ms(1), now_ns=lambda: wall.now, sleep=wall.sleep)
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource("0:a 40:b 100:c"))
    kernel.run(ms(50), clock=clock)
    wall.now += 3600 * SECOND
    wall.slept.clear()

    kernel.run(ms(100), clock=clock)

    assert wall.slept == [pytest.approx(0.05)]
    assert clock.n_missed == 0


def test_lateness_is_measured_and_deadlines_count():
    """The work of an instant is late by when it is done; what it delays is late as well."""
    wall = Wall()
    clock = WallClock(ms(20), now_ns=lambda: wall.now, sleep=wall.sleep)
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource("0:a 10:b 20:c 100:d"))
    kernel.add_unit(Label("b"), Working(wall, ms(15)), [(Label("a"), Policy())])

    kernel.run(ms(200), clock=clock)

    assert clock.lateness.samples == 4
    assert clock.lateness.mean == (ms(15) + ms(20) + ms(25) + ms(15)) / 4
    assert clock.lateness.largest == ms(25)
    assert clock.n_missed == 1
    assert clock.last_lateness == ms(15)


def test_real_waiting_takes_real_time():
    """The default way to wait returns, and not before its time."""
    clock = WallClock(ms(1_000))
    clock.start(ms(0))

    clock.await_instant(ms(2))
    clock.finish(ms(2))
    wait_seconds(0.0)

    assert clock.lateness.samples == 1
    assert clock.last_lateness >= 0
