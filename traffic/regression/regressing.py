"""Replays the recordings of a suite, and tells what is recognised otherwise than expected."""

import difflib
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from traffic.errors import RequestError
from traffic.recording.rebuilding import describe, open_run, simulation_of, system_of, world_of
from traffic.regression.cutting import Piece, cut
from traffic.regression.expectations import text_from_result
from traffic.regression.suite import Entry
from traffic.results import RunResult
from traffic.running import scorer_for
from traffic.sumo.replayed import FramePacer
from traffic.system import outputs_of, read_specification
from traffic.watching import Watch, told_of

__all__ = ["Addition", "Regression", "add", "regress", "replayed", "update"]


@dataclass(frozen=True, slots=True)
class Regression:
    """What became of a recording.

    Attributes:
        entry: Of the suite.
        difference: What is otherwise, as lines of a unified diff; empty if nothing is.
        seconds: How long the replay took.
    """

    entry: Entry
    difference: tuple[str, ...]
    seconds: float


@dataclass(frozen=True, slots=True)
class Addition:
    """What is to be added to a suite.

    Attributes:
        recording: The recording of a run.
        piece: The piece of it.
        entry: What it becomes.
    """

    recording: Path
    piece: Piece
    entry: Entry


def regress(entries: Iterable[Entry]) -> Iterator[Regression]:
    """Replay each recording with the bundled specification and chronicles, as they are now.

    Raises:
        RequestError: What is expected of a recording is not written down.
        RecordingError: A recording cannot be read.
        TrafficError: A recording cannot be replayed.
    """
    for entry in entries:
        began = time.perf_counter()
        expected = _expected(entry).splitlines()
        found = text_from_result(replayed(entry.recording)).splitlines()
        names = (str(entry.expected), "now")
        difference = tuple(difflib.unified_diff(expected, found, *names, n=1, lineterm=""))
        yield Regression(entry, difference, time.perf_counter() - began)


def replayed(path: Path) -> RunResult:
    """Replay a recording with the bundled specification and chronicles, as they are now."""
    with open_run(path) as recording:
        said, world = describe(recording), world_of(recording)
        specification = read_specification()
        outputs = [name for name in outputs_of(specification) if name in said.outputs]
        system = system_of(recording, specification, world, outputs)
        truth = simulation_of(recording)
        scorer = None if truth is None else scorer_for(world, truth, system)
        watch = Watch(system, scorer, is_governed=False)
        pacer = None
        if truth is not None and scorer is not None:
            pacer = FramePacer(truth, [scorer.observe_frame])
        return watch.complete(told_of(said.origin), _ignore, pacer)


def update(entries: Iterable[Entry]) -> Iterator[Entry]:
    """Write down what is recognised now as what is expected; yield those that have changed."""
    for entry in entries:
        text = text_from_result(replayed(entry.recording))
        if not entry.expected.exists() or entry.expected.read_text("utf-8") != text:
            entry.expected.write_text(text, encoding="utf-8")
            yield entry


def add(addition: Addition) -> Entry:
    """Add a piece of a recording to a suite, with what is recognised in it now.

    Raises:
        RequestError: There is a recording of this name, or the piece is not in the recording.
        RecordingError: The recording cannot be read.
    """
    entry = addition.entry
    if entry.recording.exists():
        raise RequestError("--name", f"a name that '{entry.folder}' does not have", entry.name)
    cut(addition.recording, addition.piece, entry.recording)
    return next(update([entry]), entry)


def _expected(entry: Entry) -> str:
    try:
        return entry.expected.read_text(encoding="utf-8")
    except OSError as error:
        expected = f"what is to be recognised in '{entry.expected}' ({error.strerror})"
        raise RequestError("traffic regress", expected, "nothing") from error


def _ignore(_done: float, _total: float) -> None:
    """Tell nobody how far a replay has come."""
