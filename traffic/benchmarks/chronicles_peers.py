"""The overtake pattern in other engines, where they are installed: Siddhi and pychronicles.

Siddhi is written in Java. Its libraries come with the distribution `pysiddhi`; a short program of
ours, which the Java launcher runs from its source, feeds it the changes and tells what it finds
and how much time of the processor all its threads took. Since Java becomes faster as it goes on,
it does the same work several times over.

pychronicles recognises off-line and knows neither variables nor forbidden events: it gets the
events of each pair alone, and what it finds is filtered by us.
"""

import shutil
import subprocess
import time
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from chronicles.events import Event
from dyknow.time import MILLISECOND
from traffic.benchmarks.chronicles_events import Instants
from traffic.benchmarks.machine import missing_distributions, version_of
from traffic.benchmarks.measuring import undisturbed

__all__ = ["PEERS", "ChroniclePeer", "Found", "installed_peers", "missing_peers"]

PEERS = ("pysiddhi", "pychronicles")

_PROGRAM = Path(__file__).with_name("Overtakes.java")
_NANOSECONDS = 1e9
_WITHIN = 60_000
_PATIENCE = 600


@dataclass(frozen=True, slots=True)
class Found:
    """What an engine found, and how long each round took it.

    Attributes:
        overtakes: Found in the last round.
        seconds: Of processor time, for each round.
    """

    overtakes: set[Instants]
    seconds: list[float]


@dataclass(frozen=True, slots=True)
class ChroniclePeer:
    """Another engine.

    Attributes:
        name: What it is called.
        version: Of the installed distribution.
        recognise: Finds the overtakes among changes, in so many rounds.
        keeps_every_choice: Whether it finds everything that the `noevent` forbids as well.
    """

    name: str
    version: str
    recognise: Callable[[Sequence[Event], int], Found]
    keeps_every_choice: bool


def installed_peers() -> list[ChroniclePeer]:
    """Return the engines that can be run here."""
    makers = {
        "pysiddhi": ("Siddhi", _recognise_with_siddhi, False),
        "pychronicles": ("pychronicles", _recognise_with_pychronicles, True),
    }
    found = []
    for distribution, (name, recognise, keeps) in makers.items():
        version = version_of(distribution)
        if version is not None and (distribution != "pysiddhi" or _java_and_libraries()):
            found.append(ChroniclePeer(name, version, recognise, keeps))
    return found


def missing_peers() -> list[str]:
    """Return a sentence for each engine that cannot be run here."""
    notes = missing_distributions(PEERS)
    if version_of("pysiddhi") is not None and not _java_and_libraries():
        notes.append("No comparison with Siddhi, for there is no Java development kit here.")
    return notes


def _java_and_libraries() -> tuple[str, Path] | None:
    """Return the Java launcher, if it can run sources, and the folder of Siddhi's libraries."""
    java, compiler = shutil.which("java"), shutil.which("javac")
    package = find_spec("__PySiddhiProxy")
    places = package.submodule_search_locations if package else None
    if java is None or compiler is None or not places:
        return None
    folder = Path(next(iter(places))) / "target" / "lib"
    return (java, folder) if folder.is_dir() else None


def _recognise_with_siddhi(events: Sequence[Event], rounds: int) -> Found:
    java_and_libraries = _java_and_libraries()
    assert java_and_libraries is not None
    java, libraries = java_and_libraries
    with TemporaryDirectory() as folder:
        path = Path(folder) / "changes.csv"
        path.write_text("".join(f"{_line(event)}\n" for event in events), encoding="utf-8")
        done = subprocess.run(
            [java, "-cp", f"{libraries}/*", str(_PROGRAM), str(path), str(rounds)],
            capture_output=True,
            text=True,
            check=True,
            timeout=_PATIENCE,
        )
    lines = [line.split() for line in done.stdout.splitlines()]
    return Found(
        {
            Instants(pair, int(t1), int(t2), int(t3))
            for _, pair, t1, t2, t3 in (line for line in lines if line[0] == "found")
        },
        [int(line[1]) / _NANOSECONDS for line in lines if line[0] == "cpu"],
    )


def _line(event: Event) -> str:
    time_of_event = event.time // MILLISECOND
    pair = "+".join(event.arguments)
    return f"{time_of_event},{event.attribute},{pair},{event.from_value},{event.to_value}"


def _recognise_with_pychronicles(events: Sequence[Event], rounds: int) -> Found:
    seconds = []
    found: set[Instants] = set()
    for _ in range(rounds):
        with undisturbed():
            began = time.process_time()
            found = _overtakes_by_pychronicles(events)
            seconds.append(time.process_time() - began)
    return Found(found, seconds)


def _overtakes_by_pychronicles(events: Sequence[Event]) -> set[Instants]:
    library, numpy = import_module("pychronicles"), import_module("numpy")
    pattern = library.Chronicle()
    for place, label in enumerate(("behind:true", "behind:false", "in_front:true")):
        pattern.add_event(place, label)
    pattern.add_constraint(0, 1, (1.0, float(_WITHIN)))
    pattern.add_constraint(1, 2, (0.0, float(_WITHIN)))
    pattern.add_constraint(0, 2, (1.0, float(_WITHIN)))
    by_pair: dict[tuple[str, ...], list[Event]] = {}
    for event in events:
        by_pair.setdefault(event.arguments, []).append(event)
    found = set()
    for pair, changes in by_pair.items():
        times = numpy.array([float(change.time // MILLISECOND) for change in changes])
        labels = numpy.array([f"{change.attribute}:{change.to_value}" for change in changes])
        rises = [int(t) for t, label in zip(times, labels, strict=True) if label == "behind:true"]
        for occurrence in pattern.recognize(library.TimedSequence(times, labels)):
            t1, t2, t3 = (int(each) for each in occurrence)
            following = bisect_right(rises, t1)
            if following == len(rises) or rises[following] >= t3:
                found.add(Instants("+".join(pair), t1, t2, t3))
    return found
