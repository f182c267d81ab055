"""Replays the recordings of a suite, and tells what is recognised otherwise than expected."""

import difflib
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from dyknow.kpl.syntax import Specification
from dyknow.recordings.errors import RecordingError
from networks.errors import NetworkError
from traffic.errors import RequestError, TrafficError
from traffic.recording.rebuilding import describe, open_run, simulation_of, system_of, world_of
from traffic.regression.cutting import refuse_unfinished
from traffic.regression.expectations import text_from_result
from traffic.regression.suite import Entry, replace_text
from traffic.results import RunResult
from traffic.running import scorer_for
from traffic.settings import Changes, changed_specification, parameters_in
from traffic.sumo.replayed import FramePacer
from traffic.system import outputs_of, read_specification
from traffic.watching import Watch, told_of

__all__ = ["Regression", "System", "regress", "replayed", "update"]


@dataclass(frozen=True, slots=True)
class Regression:
    """What became of a recording.

    Attributes:
        entry: Of the suite.
        difference: What is otherwise, as lines of a unified diff; empty if nothing is.
        seconds: How long the replay took.
        fault: Why it could not be replayed, or compared; empty if it could.
    """

    entry: Entry
    difference: tuple[str, ...]
    seconds: float
    fault: str = ""


@dataclass(frozen=True, slots=True)
class System:
    """What recordings are replayed with: the bundled specification, perhaps changed.

    Attributes:
        specification: Which processes and streams there are.
        parameters: Values of parameters that replace recorded ones.
    """

    specification: Specification = field(default_factory=read_specification)
    parameters: Mapping[str, object] = field(default_factory=dict)

    @classmethod
    def changed(cls, changes: Changes) -> "System":
        """Return the bundled system with new values of settings (`traffic.settings`).

        Raises:
            RequestError: A setting is not there, or cannot have the new value.
        """
        bundled = read_specification()
        parameters = parameters_in(changes, bundled)
        return cls(changed_specification(bundled, changes), parameters)


def regress(
    entries: Iterable[Entry], system: System | None = None, hints: Mapping[str, str] | None = None
) -> Iterator[Regression]:
    """Replay each recording with the specification and the chronicles as they are now.

    One that cannot be read is told of, and the others go on.

    Args:
        entries: Of a suite.
        system: What they are replayed with; by default what comes with the program.
        hints: What to do about a recording that cannot be read, by name.
    """
    system = system or System()
    for entry in entries:
        yield _compared(entry, system, (hints or {}).get(entry.name, ""))


def replayed(path: Path, system: System | None = None) -> RunResult:
    """Replay a recording with the specification and the chronicles as they are now.

    Raises:
        RecordingError: It cannot be read.
        ReplayError: It was made of another network, or does not have all of its run.
    """
    system = system or System()
    with open_run(path) as recording:
        said, world = describe(recording), world_of(recording)
        refuse_unfinished(recording, said)
        outputs = [name for name in outputs_of(system.specification) if name in said.outputs]
        monitoring = system_of(recording, system.specification, world, outputs, system.parameters)
        truth = simulation_of(recording)
        scorer = None if truth is None else scorer_for(world, truth, monitoring)
        watch = Watch(monitoring, scorer, is_governed=False)
        pacer = None
        if truth is not None and scorer is not None:
            pacer = FramePacer(truth, [scorer.observe_frame])
        return watch.complete(told_of(said.origin), _ignore, pacer)


def update(
    entries: Iterable[Entry], hints: Mapping[str, str] | None = None
) -> Iterator[Regression]:
    """Replay each recording, and write down what is recognised now as what is expected.

    Args:
        entries: Of a suite.
        hints: What to do about a recording that cannot be read, by name.
    """
    system = System()
    for entry in entries:
        yield _compared(entry, system, (hints or {}).get(entry.name, ""), is_accepted=True)


def _compared(entry: Entry, system: System, hint: str, *, is_accepted: bool = False) -> Regression:
    """Return what became of a recording, which is expected from now on if it *is_accepted*."""
    began = time.perf_counter()
    difference: tuple[str, ...] = ()
    fault = ""
    try:
        text = text_from_result(replayed(entry.recording, system))
        expected = _expected_so_far(entry) if is_accepted else entry.read_expected()
        names = (str(entry.expected), "now")
        lines = expected.splitlines(), text.splitlines()
        difference = tuple(difflib.unified_diff(*lines, *names, n=1, lineterm=""))
        if difference and is_accepted:
            replace_text(entry.expected, text)
    except RequestError as error:
        fault = str(error)
    except (RecordingError, TrafficError, NetworkError, OSError) as error:
        fault = "; ".join(filter(None, [entry.fault_of(error), hint]))
    return Regression(entry, difference, time.perf_counter() - began, fault)


def _expected_so_far(entry: Entry) -> str:
    try:
        return entry.read_expected()
    except RequestError:
        return ""


def _ignore(_done: float, _total: float) -> None:
    """Tell nobody how far a replay has come."""
