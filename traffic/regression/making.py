"""Makes recordings of a suite: cuts a piece out of a run, or does the runs of a suite again."""

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from dyknow.time import SECOND, Duration, text_from_duration
from traffic.errors import RequestError, ScenarioError, TrafficError
from traffic.origin import Origin, origin_of
from traffic.recording.describing import RunDescription
from traffic.recording.rebuilding import describe, open_run
from traffic.regression.cutting import Piece, cut
from traffic.regression.expectations import text_from_result
from traffic.regression.manifest import Making, Manifest
from traffic.regression.regressing import replayed
from traffic.regression.suite import Entry, written_whole
from traffic.request import DEFAULT_PERIOD, RecordingRequest
from traffic.running import outputs_recognising, run_scenario
from traffic.scenarios import find_scenario
from traffic.system import read_specification

__all__ = ["Addition", "add", "remake"]

_OPTIONS = frozenset({"view", "sample_period", "position_noise", "longest_frame_period"})
"""Parameters of the specification that are options of a run."""


@dataclass(frozen=True, slots=True)
class Addition:
    """What is to be added to a suite.

    Attributes:
        recording: The recording of a run.
        piece: The piece of it.
        entry: What it becomes.
        shows: What it is in the suite for.
        recognise: Names of what is to be recognised in it; None for what was in the run.
    """

    recording: Path
    piece: Piece
    entry: Entry
    shows: str = ""
    recognise: tuple[str, ...] | None = None


def add(addition: Addition, manifest: Manifest) -> Making:
    """Add a piece of a recording to a suite, with what is recognised in it now.

    Returns:
        How it was made, as the manifest of the suite has it now.

    Raises:
        RequestError: There is a recording of this name, the piece is not in the recording, or
            what is to be recognised was not in the run.
        RecordingError: The recording cannot be read.
    """
    entry = addition.entry
    if entry.recording.exists() or entry.name in manifest.makings:
        raise RequestError("--name", f"a name that '{entry.folder}' does not have", entry.name)
    with open_run(addition.recording) as recording:
        said = describe(recording)
    entry.folder.mkdir(exist_ok=True)
    making = _making(said, addition)
    _make(addition.recording, addition.piece, _outputs(said, addition), entry)
    manifest.add(making)
    return making


def remake(makings: Iterable[Making], folder: Path) -> Iterator[tuple[Entry, bool]]:
    """Do the runs of recordings again, cut them, and write down what is recognised now.

    Yields:
        Each recording, and whether something else is recognised in it than was expected.

    Raises:
        TrafficError: A run is not possible any more.
    """
    by_run = itertools.groupby(sorted(makings, key=lambda each: each.run), key=lambda m: m.run)
    for _, group in by_run:
        pieces = list(group)
        with TemporaryDirectory(prefix="traffic-remake-") as scratch:
            path = Path(scratch) / "run.mcap"
            request = pieces[0].request(Path(scratch) / "run")
            run_scenario(replace(request, recording=RecordingRequest(path)), lambda *_: None)
            for making in pieces:
                entry = Entry(folder, making.name)
                before = entry.expected.read_text("utf-8") if entry.expected.exists() else ""
                _make(path, making.piece, None, entry)
                yield entry, entry.expected.read_text("utf-8") != before


def _make(path: Path, piece: Piece, outputs: tuple[str, ...] | None, entry: Entry) -> None:
    with written_whole(entry) as unfinished:
        cut(path, piece, unfinished.recording, outputs)
        text = text_from_result(replayed(unfinished.recording))
        unfinished.expected.write_text(text, encoding="utf-8")


def _outputs(said: RunDescription, addition: Addition) -> tuple[str, ...] | None:
    """Return the output streams that are wanted of what the run had.

    Raises:
        RequestError: The run did not have one.
    """
    if addition.recognise is None:
        return None
    wanted = outputs_recognising(read_specification(), addition.recognise, "--recognise")
    known = outputs_recognising(read_specification(), (), "--recognise")
    for name in wanted:
        if name not in said.outputs and name not in known:
            expected = f"what '{addition.recording}' has: {', '.join(said.outputs)}"
            raise RequestError("--recognise", expected, name)
    return tuple(name for name in wanted if name in said.outputs)


def _making(said: RunDescription, addition: Addition) -> Making:
    """Return how a recording is made; without a scenario if no manifest can say that."""
    origin, piece = said.origin, addition.piece
    values: dict[str, Any] = {
        "name": addition.entry.name,
        "shows": addition.shows,
        "scenario": origin.scenario.name,
        "seed": int(origin.request["seed"] or 0),
        "settings": _settings(said, addition.recognise),
        "from": _text_from(piece.begin),
        "to": _text_from(piece.end),
    }
    making = Making.model_validate(values)
    if _is_that_of(making, origin):
        return making
    return Making.model_validate({**values, "scenario": None, "settings": {}})


def _text_from(time: Duration) -> str:
    """Return a time in seconds, or in milliseconds if it is no whole number of those."""
    whole, rest = divmod(time, SECOND)
    return f"{text_from_duration(time)} ms" if rest else f"{whole} s"


def _settings(said: RunDescription, recognise: tuple[str, ...] | None) -> dict[str, Any]:
    asked, scenario = said.origin.request, said.origin.scenario
    settings: dict[str, Any] = {"view": asked["view"]}
    if asked["position_noise"]:
        settings["position_noise"] = asked["position_noise"]
    if asked["sample_period_ns"] != DEFAULT_PERIOD:
        settings["sample_period"] = f"{text_from_duration(int(asked['sample_period_ns'] or 0))} ms"
    names = ",".join(recognise) if recognise else asked.get("recognise")
    settings["recognise"] = names or "all"
    if scenario.duration != _usual_duration(scenario.name):
        settings["duration"] = _text_from(scenario.duration)
    return settings | {k: v for k, v in said.parameters.items() if k not in _OPTIONS}


def _usual_duration(name: str) -> int | None:
    try:
        return find_scenario(name).duration
    except ScenarioError:
        return None


def _is_that_of(making: Making, origin: Origin) -> bool:
    """Return whether the run of *making* is the one of *origin*."""
    try:
        again = origin_of(making.request(Path("unwritten")))
    except TrafficError:
        return False
    one, other = ({**each.request, "recognise": None} for each in (again, origin))
    return one == other and again.scenario == origin.scenario
