"""The link of the bundled specification from cars to reckless drivers."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from anchoring.links import LinkSettings
from anchoring.processes import LinkProcess
from anchoring.reckless_drivers import RecklessDriver
from chronicles.events import Recognition
from chronicles.marking import RecognitionMarks
from dyknow.kpl.implementations import Implementations
from dyknow.kpl.network import Network
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.syntax import GeneratorDeclaration, Specification
from dyknow.streams.process import Element
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import MINUTE, SECOND, TimePoint
from traffic.system import read_specification

_ACT = "tailgating"
_DELAY = 500_000_000
"""How long after its time a recognition is known, in nanoseconds."""

Acts = Sequence[tuple[int, int]]
"""Time of recognition in nanoseconds, and number of the car."""


class _Cars:
    """A source of tables of cars.

    Args:
        period: Nanoseconds from one to the next.
        presence: For each table, which cars are in it.
    """

    def __init__(self, period: int, presence: Sequence[set[int]]) -> None:
        self._period = period
        self._presence = presence

    def samples(self) -> Iterator[Element]:
        """Yield a table for each frame."""
        for number, ids in enumerate(self._presence):
            time = TimePoint(number * self._period)
            columns = {
                "position": np.zeros((len(ids), 2)),
                "observed": np.ones(len(ids), dtype=np.bool_),
            }
            yield Sample(Table("car", sorted(ids), columns), time, time)


class _Recognitions:
    """A source of recognitions that are known a while later, and of heartbeats as often."""

    def __init__(self, acts: Acts, period: int, n_frames: int) -> None:
        times = sorted(
            {0, *(number * period for number in range(n_frames)), *(t for t, _ in acts)}
        )
        self._acts = acts
        self._times = times

    def samples(self) -> Iterator[Element]:
        """Yield what is recognised at each time, and that this was all."""
        for time in self._times:
            found = tuple(_recognition(at, car) for at, car in self._acts if at == time)
            if found:
                yield Sample(found, TimePoint(time), TimePoint(time + _DELAY))
            yield Heartbeat(TimePoint(time), TimePoint(time + _DELAY))


def _recognition(at: int, car: int) -> Recognition:
    time = TimePoint(at)
    arguments = {"c1": f"car{car}", "c2": "car99"}
    return Recognition(_ACT, arguments, {"t": time}, (), time, time, time)


def _block() -> tuple[Specification, set[str]]:
    """Return the part of the bundled specification about reckless drivers, and its streams."""
    names = ("car_acts", "reckless_drivers")
    declarations = [
        each
        for each in read_specification().declarations
        if isinstance(each, GeneratorDeclaration) and each.label.text in names
    ]
    (marks,) = (each for each in declarations if each.label.text == "car_acts")
    streams = {each.provider.text for each in marks.process.streams} - {"cars"}
    declared = "\n".join(
        [
            "source cars cars strmgen cars = cars",
            *(f"source recognitions {name} strmgen {name} = {name}" for name in sorted(streams)),
            "compunit car_acts RecognitionMarks(cars, recognitions, ...)",
            "compunit reckless_drivers RecklessDriver(car_acts)",
        ]
    )
    outputs = parse_specification("stream reckless_drivers = reckless_drivers", "test")
    all_of_it = (
        *parse_specification(declared, "test").declarations,
        *declarations,
        *outputs.declarations,
    )
    return Specification(all_of_it), streams


def _drivers(
    period: int, presence: Sequence[set[int]], acts: Acts
) -> tuple[list[Sample[Table]], LinkProcess]:
    """Return the tables of reckless drivers, and the process that makes them."""
    specification, streams = _block()
    processes: list[LinkProcess] = []

    def link(_unit: str, *conditions: Any) -> LinkProcess:
        *formulas, chosen = conditions
        processes.append(LinkProcess(RecklessDriver(), LinkSettings(*formulas, **chosen)))
        return processes[-1]

    def recognitions(name: str) -> Any:
        own = acts if name == "following" else ()
        return lambda: _Recognitions(own, period, len(presence))

    sources: dict[str, Any] = {name: recognitions(name) for name in streams}
    sources["cars"] = lambda: _Cars(period, presence)
    network = Network(Implementations(sources, {"RecognitionMarks": RecognitionMarks}, link))
    network.add(specification)
    found: list[Sample[Table]] = []
    network.subscribe("reckless_drivers", found.append)
    network.kernel.run(TimePoint(len(presence) * period + SECOND))
    return found, processes[0]


def _spans(process: LinkProcess) -> list[tuple[str, int, float | None]]:
    """Return the car of each link, and when it began and ended, in seconds."""
    return [
        (link.lower, link.begin // SECOND, None if link.end is None else link.end / SECOND)
        for link in process.history
    ]


@pytest.fixture(scope="module")
def hour() -> tuple[list[Sample[Table]], LinkProcess]:
    """Return what comes of an hour and a half with three cars and four reckless acts.

    Car 1 does something at 5 and at 20 minutes and drives away at 10 for half an hour, coming
    back at 40; car 2 does something at 50 minutes; car 3 does nothing.
    """
    presence = [{2, 3} if 600 <= second < 2400 else {1, 2, 3} for second in range(5400)]
    acts = [(300 * SECOND, 1), (301 * SECOND + 1, 1), (1200 * SECOND, 1), (3000 * SECOND, 2)]
    return _drivers(SECOND, presence, acts)


def test_who_does_something_reckless_is_linked_until_half_an_hour_after_the_last_act(hour):
    """The link begins with the act, goes on with each further one, also out of sight, and ends."""
    _, process = hour

    assert _spans(process) == [("car1", 300, 3001.0), ("car2", 3000, 4801.0)]


def test_the_stream_tells_who_is_a_reckless_driver_now(hour):
    """It has a row for each as long as the link stands, and what was done how often and when."""
    tables, _ = hour
    at = {sample.valid_time // SECOND: sample.value for sample in tables}

    assert [len(at[second]) for second in (299, 300, 3000, 3001, 4800, 4801)] == [0, 1, 2, 1, 1, 0]
    row = at[1200].row(1)
    assert row is not None
    assert (row["car"], row["n_acts"], row["present"]) == (1, 3, False)
    assert (row["since"], row["last_act_at"]) == (300 * SECOND, 1200 * SECOND)
    assert at[1200].symbol(1) == "reckless_driver1"
    assert all(sample.available_time - sample.valid_time <= _DELAY for sample in tables)


@settings(derandomize=True, deadline=None, max_examples=30)
@given(
    st.lists(st.sets(st.sampled_from((1, 2))), min_size=1, max_size=180),
    st.lists(st.tuples(st.integers(0, 120 * 60), st.sampled_from((1, 2))), max_size=6),
)
def test_links_are_those_that_a_look_at_each_car_alone_gives(
    presence: list[set[int]], drawn: list[tuple[int, int]]
) -> None:
    """With a table each minute, whoever comes and goes: links follow from acts alone."""
    presence = [{1, 2}, *presence]
    acts = [(second * SECOND, car) for second, car in drawn]

    _, process = _drivers(MINUTE, presence, acts)

    found = sorted((link.lower, link.begin, link.end) for link in process.history)
    assert found == sorted(_naive(len(presence), presence, acts))


def _naive(
    n_frames: int, presence: list[set[int]], acts: Acts
) -> Iterator[tuple[str, int, int | None]]:
    """Yield the links of each car: an act lasts until the next table, and counts for 30 min."""
    for car in (1, 2):
        frames = sorted({-(-time // MINUTE) for time, one in acts if one == car})
        frames = [
            frame for frame in frames if frame < n_frames and _is_known(car, frame, presence)
        ]
        begin, last = None, -1
        for frame in range(n_frames):
            if begin is not None and frame > last + 30 and frame not in frames:
                yield f"car{car}", begin * MINUTE, frame * MINUTE
                begin = None
            if frame in frames:
                begin = frame if begin is None else begin
                last = frame
        if begin is not None:
            yield f"car{car}", begin * MINUTE, None


def _is_known(car: int, frame: int, presence: list[set[int]]) -> bool:
    """Return whether a car is in a table, or has left it at most an hour ago."""
    return any(car in ids for ids in presence[max(0, frame - 60) : frame + 1])
