"""Tests of `dyknow.service.application`."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest

from dyknow.errors import (
    KPLSyntaxError,
    LabelInUseError,
    NoSuchLabelError,
    PolicyNotSupportedError,
    SpecificationErrors,
)
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, build_network
from dyknow.runtime.clock import WallClock
from dyknow.runtime.generators import ANYTHING, Label
from dyknow.service.application import DyKnow
from dyknow.service.governor import GovernorSettings
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.time import Duration, TimePoint
from tests.support.streams import GivenSource, ms

GPS = """
source position gps
compunit position Filter(position)
strmgen gps = gps with sample every 20
strmgen filtered = Filter(gps with sample every 20 up to 80 under load)
stream position = filtered
"""


def gps() -> GivenSource:
    """Return a receiver of positions at 50 Hz, for four seconds."""
    times = [ms(20 * n) for n in range(200)]
    return GivenSource([Sample(n, time, time) for n, time in enumerate(times)])


class Stopwatch:
    """A clock outside the network, on which work and waiting take the time that the test says."""

    def __init__(self) -> None:
        self.now = 0

    def now_ns(self) -> int:
        """Return the time outside."""
        return self.now

    def sleep(self, seconds: float) -> None:
        """Let the time pass."""
        self.now += round(seconds * 1e9)


class Filter(Reactive):
    """A copy of its input, each of which takes 30 ms of the time outside."""

    def __init__(self, watch: Stopwatch) -> None:
        self._watch = watch

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterator[Sample[Any]]:
        """Emit the sample again."""
        self._watch.now += ms(30)
        yield Sample(inputs[0].value, inputs[0].valid_time, now)


@pytest.fixture
def watch() -> Stopwatch:
    """Return a clock outside the network."""
    return Stopwatch()


@pytest.fixture
def service(watch: Stopwatch) -> DyKnow:
    """Return an application that filters positions."""
    implementations = Implementations(
        sources={"gps": gps}, units={"Filter": lambda: Filter(watch)}
    )
    return DyKnow(build_network(parse_specification(GPS), implementations), implementations)


def test_a_chain_that_lags_behind_is_sampled_less_often(service: DyKnow, watch: Stopwatch) -> None:
    """Work of 30 ms every 20 ms falls ever further behind; under a governor it does not."""
    received: list[Sample[Any]] = []
    service.subscribe("filtered", received.append)
    clock = WallClock(ms(20), watch.now_ns, watch.sleep)
    settings = GovernorSettings(late_after=ms(40), patience=ms(100), relief=ms(400))
    service.run(clock=clock, govern=settings)
    assert clock.lateness.largest < ms(400)
    assert service.governor is not None
    assert service.governor.changes[0].after == ms(40)
    steps = {later.valid_time - one.valid_time for one, later in pairwise(received)}
    assert steps <= {ms(20), ms(40), ms(80)}
    assert ms(20) in steps
    assert ms(40) in steps


def test_without_a_governor_the_same_chain_lags(service: DyKnow, watch: Stopwatch) -> None:
    """Each of 200 positions adds 10 ms."""
    clock = WallClock(ms(20), watch.now_ns, watch.sleep)
    service.run(clock=clock)
    assert clock.last_lateness >= ms(2000)


def test_governing_needs_a_clock_outside(service: DyKnow) -> None:
    """In virtual time nothing is ever late."""
    with pytest.raises(ValueError, match="wall clock"):
        service.run(govern=GovernorSettings(late_after=Duration(1)))


def test_declared_symbols_are_prototypes(service: DyKnow) -> None:
    """The factory makes a second filter of what the specification declares."""
    service.factory.create_knowledge_process(
        Label("twice"), "Filter", [(Label("filtered"), ANYTHING)]
    )
    received: list[Sample[Any]] = []
    service.subscribe("twice", received.append)
    service.run(ms(100))
    assert [sample.value for sample in received] == [0, 1, 2, 3, 4, 5]


def test_declarations_come_and_go_while_it_runs(service: DyKnow) -> None:
    """An output that is added in the middle brings what comes from then on, until it goes."""
    received: list[Sample[Any]] = []

    def on_time(now: TimePoint) -> None:
        if now == ms(1000):
            service.add("stream late = filtered with any change")
            service.network.subscribe("late", received.append)
        if now == ms(2000):
            service.remove("stream late")

    service.run(on_time=on_time)
    times = [sample.valid_time for sample in received]
    assert (times[0], times[-1]) == (ms(1000), ms(1980))
    assert "late" not in service.network.outputs


def test_removed_declarations_are_no_prototypes(service: DyKnow) -> None:
    """With its declaration a prototype goes, and with a new one it comes back."""
    service.add("source position spare")
    service.remove("source spare")
    assert "spare" not in service.factory.prototypes
    service.remove(["stream position", "strmgen filtered", "compunit Filter"])
    assert set(service.factory.prototypes) == {"gps"}
    service.add("compunit position Filter(position)")
    assert set(service.factory.prototypes) == {"gps", "Filter"}


def test_what_is_in_use_is_not_removed(service: DyKnow) -> None:
    """A generator that feeds another one stays, and the message says whom it feeds."""
    with pytest.raises(LabelInUseError, match="filtered"):
        service.remove("strmgen gps")


def test_faults_leave_everything_as_it_was(service: DyKnow) -> None:
    """A declaration with a fault changes neither network nor prototypes."""
    before = service.network.specification, set(service.factory.prototypes)
    with pytest.raises(SpecificationErrors):
        service.add("compunit position Other(position)\nstrmgen a = Other(nothing)")
    assert (service.network.specification, set(service.factory.prototypes)) == before


def test_policies_of_clients_are_written_as_in_kpl(service: DyKnow) -> None:
    """A client's policy is adapted to, refused if it cannot be kept, and told if it is none."""
    received: list[Sample[Any]] = []
    proxy = service.subscribe("gps", received.append, "sample every 100", name="display")
    service.run(ms(300))
    assert [sample.valid_time for sample in received] == [ms(0), ms(100), ms(200), ms(300)]
    assert (proxy.provider, proxy.receiver) == ("gps", "display")
    with pytest.raises(PolicyNotSupportedError, match="every 20"):
        service.subscribe("gps", received.append, "sample every 50")
    with pytest.raises(KPLSyntaxError):
        service.subscribe("gps", received.append, "now and then")
    with pytest.raises(NoSuchLabelError, match="did you mean 'gps'"):
        service.subscribe("gpd", received.append)


def test_a_client_may_ask_by_another_name(service: DyKnow) -> None:
    """A label that the manager was given stands for the same stream."""
    service.manager.add_stream_generator(
        Label("where"), service.manager.get_stream_generator(Label("gps"))
    )
    received: list[Sample[Any]] = []
    service.subscribe("where", received.append)
    service.run(ms(40))
    assert len(received) == 3


def test_a_policy_is_refined_while_it_runs(service: DyKnow) -> None:
    """Half way the positions are asked for at 25 Hz, and the specification says so."""
    received: list[Sample[Any]] = []
    service.subscribe("filtered", received.append)
    service.run(ms(1000))
    service.replace_policy(("filtered", 1), "sample every 40")
    service.run(ms(2000))
    steps = [later.valid_time - one.valid_time for one, later in pairwise(received)]
    assert steps == [ms(20)] * 50 + [ms(40)] * 25
    assert "sample every 40" in str(service.network.description)
