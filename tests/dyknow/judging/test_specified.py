"""Judging recordings of networks that were specified in KPL."""

from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dyknow.judging.judge import judge
from dyknow.judging.judgement import Judgement
from dyknow.judging.recorded import RecordedExecution
from dyknow.judging.specified import declared_network
from dyknow.kpl.implementations import Implementations
from dyknow.kpl.network import Network
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import build_network
from dyknow.kpl.syntax import Specification
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.streams.process import Element, Reactive, Source
from dyknow.streams.sample import NO_SAMPLE, Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from tests.support.mutations import alter, drop
from tests.support.rewriting import rewrite
from tests.support.streams import GivenSource, ms, stream

STATIC = """
source number numbers
source number others
compunit number Sum(number, number)
compunit any Names(number)
strmgen numbers = numbers
strmgen others = others
strmgen sum = Sum(numbers with sample every 100, max delay 20, others with monotone order)
strmgen merged = merge(numbers, sum with strict order)
strmgen states = sync(numbers, others)
strmgen names = Names(sum)
strmgen chosen = select x from names where y = 2
stream sum = sum with any change
stream merged = merged with max delay 10
stream states = states
stream chosen = chosen
"""

CHANGING = """
source any cars
compunit any Speed(any)
compunit any Sum(any, any)
compunit any Members(any)
strmgen cars = cars
strmgen members = Members(cars)
for each car in members {
    strmgen speed[car] = Speed(cars[car] with strict order)
    strmgen speed_twice[car] = Sum(speed[car], speed[car] with max delay 0)
    stream speed[car] = speed[car] with any change
}
strmgen speeds = merge(speed_twice[car] for each car in members)
compunit any Last(any)
strmgen last = Last(speeds with monotone order)
stream last = last
stream speeds = speeds
"""


class Sum(Reactive):
    """Emits the sum of the last values."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Emit the sum of what is there."""
        there = [each for each in inputs if each is not NO_SAMPLE]
        yield Sample(sum(each.value for each in there), max(s.valid_time for s in there), now)


class Each(Reactive):
    """Emits a function of each new value."""

    def __init__(self, function: Callable[[Any], Any]) -> None:
        self._function = function

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Emit what becomes of the value."""
        (sample,) = inputs
        yield Sample(self._function(sample.value), sample.valid_time, now)


def cars() -> list[Element]:
    """Return tables of cars that come, go and come back."""
    present = [[1], [1, 2], [1, 2, 3], [2, 3], [3], [1, 3], [1], [1, 2]]
    return [
        Sample(
            Table("car", ids, {"x": np.array([10.0 * at * each for each in ids])}),
            ms(100 * at),
            ms(100 * at + 5),
        )
        for at, ids in enumerate(present)
    ]


def numbers(notation: str) -> list[Element]:
    """Return a stream of numbers, and a heartbeat at its end."""
    samples = [
        Sample(int(each.value), each.valid_time, each.available_time) for each in stream(notation)
    ]
    last = samples[-1]
    return [*samples, Heartbeat(last.valid_time, last.available_time)]


SOURCES: Mapping[str, Callable[[], Source]] = {
    "numbers": lambda: GivenSource(numbers("0:1 100:2 200:3@230 300:4 400:4 500:5")),
    "others": lambda: GivenSource(numbers("0:7 100:8@150 50:9@160 300:10 400:11")),
    "cars": lambda: GivenSource(cars()),
}
UNITS: Mapping[str, Callable[..., Any]] = {
    "Sum": Sum,
    "Names": lambda: Each(lambda value: {"x": value, "y": value % 3}),
    "Speed": lambda: Each(lambda row: float(row["x"]) / 2),
    "Members": lambda: Each(lambda table: frozenset(map(table.symbol, table.ids.tolist()))),
    "Last": lambda: Each(lambda value: value),
}


class Made:
    """Makes the network of a specification."""

    def __init__(self, text: str) -> None:
        self._specification = parse_specification(text)

    def __call__(
        self,
        specification: Specification | None = None,
        sources: Mapping[str, Callable[[], Source]] | None = None,
        outputs: Collection[str] = (),
    ) -> Network:
        """Return a new network."""
        declared = specification or self._specification
        symbols = Implementations({**SOURCES, **(sources or {})}, UNITS)
        return build_network(declared, symbols)


def recorded(text: str, path: Path) -> Path:
    """Run the network of a specification and record it."""
    network = Made(text)()
    with Recorder(path, metadata={}) as recorder:
        recorder.attach(network)
        network.kernel.run(ms(1000))
    return path


def judged(text: str, path: Path) -> Judgement:
    """Judge a recording by a specification."""
    with open_recording(path) as recording:
        return judge(declared_network(Made(text)), RecordedExecution(recording, ms(1000)))


@pytest.mark.parametrize("text", [STATIC, CHANGING], ids=["static", "changing"])
def test_what_was_specified_is_judged_correct(text: str, tmp_path: Path) -> None:
    """A network of every kind of process satisfies its specification."""
    judgement = judged(text, recorded(text, tmp_path / "run.mcap"))

    assert judgement.breaches == ()
    assert judgement.unjudged == ()
    assert {each.stream for each in judgement.findings if each.unjudged} <= SOURCES.keys()
    assert sum(each.samples for each in judgement.findings) > 40


@pytest.mark.parametrize("spoil", [drop, alter])
@pytest.mark.parametrize(
    ("text", "topic"),
    [
        (STATIC, topic)
        for topic in (
            "sum", "sum/1", "sum/2", "merged", "merged/2", "states", "states/1", "chosen",
            "output/sum", "output/merged",
        )
    ]
    + [
        (CHANGING, topic)
        for topic in (
            "members", "speed[car1]", "speed[car3]/1", "speed_twice[car2]", "speeds", "speeds/2",
            "last", "last/1", "output/speed[car1]",
        )
    ],
)  # fmt: skip
def test_every_kind_of_stream_is_judged(text: str, topic: str, spoil: Any, tmp_path: Path) -> None:
    """Whatever makes a stream, and however it comes and goes, a wrong sample of it is found."""
    path = recorded(text, tmp_path / "run.mcap")
    altered = rewrite(path, tmp_path / "x.mcap", {topic: lambda e: _spoilt(e, spoil)})

    judgement = judged(text, altered)

    assert topic in {breach.stream for breach in judgement.breaches}


def _spoilt(elements: list[Element], spoil: Any) -> list[Element]:
    """Return the elements with a sample in the middle spoilt."""
    samples = [each for each in elements if isinstance(each, Sample)]
    assert samples
    spoilt = spoil(samples, len(samples) // 2)
    return spoilt + [each for each in elements if isinstance(each, Heartbeat)]


def test_what_is_declared_and_was_not_there_is_missed(tmp_path: Path) -> None:
    """A generator, an input or an output that the execution has not had is a breach."""
    path = recorded(STATIC, tmp_path / "run.mcap")
    more = STATIC.replace("= Names(sum)", "= Names(twice)") + (
        "strmgen twice = Sum(sum, sum)\nstream twice = twice\n"
    )

    judgement = judged(more, path)

    absent = {each.stream for each in judgement.breaches if each.definition == "4.5.3"}
    assert absent == {"twice", "twice/1", "twice/2", "output/twice"}


def test_what_nothing_declares_is_told(tmp_path: Path) -> None:
    """Streams that were recorded and that are not in the specification are left open."""
    path = recorded(STATIC, tmp_path / "run.mcap")

    judgement = judged(STATIC.replace("stream states = states", ""), path)

    assert judgement.unjudged == (
        "nothing declares 'output/states'",
        "nothing declares 'states'",
        "nothing declares 'states/1'",
        "nothing declares 'states/2'",
    )


def test_a_recording_that_was_cut_off_is_judged_as_far_as_it_goes(tmp_path: Path) -> None:
    """Of a file that ends anywhere, what is there is correct."""
    path = recorded(STATIC, tmp_path / "run.mcap")
    whole = path.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole[: len(whole) * 2 // 3])

    assert judged(STATIC, cut).breaches == ()
