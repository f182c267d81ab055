"""What a run found out, as a value and as a folder of files.

A run writes one folder, once. It is put together under a name ending in `.partial` and renamed
when it is whole, so that an interrupted run never looks like a finished one.
"""

import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from traffic.errors import ResultError

__all__ = [
    "Lateness",
    "Manoeuvre",
    "RecklessDriverResult",
    "RecognitionResult",
    "Replay",
    "RunResult",
    "Score",
    "StreamDifference",
    "Timing",
    "car_names",
    "new_folder",
    "read_result",
    "run_folder",
    "write_result",
]

_RESULT_FILE = "result.json"
_CAR = re.compile(r"c(ar)?\d*")


class _Value(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class RecognitionResult(_Value):
    """One recognised chronicle.

    Attributes:
        chronicle: Name of the model.
        arguments: Value of each variable of the model.
        times: Each instant of the model, milliseconds.
        begin: When what a person would count began, milliseconds.
        end: When it ended.
        recognised_at: When it was recognised, milliseconds.
        events: The changes that made it.
        truth: The simulator's id of each vehicle among the arguments, or None if a symbol
            belongs to no vehicle.
        agrees: Whether the truth knows this manoeuvre; None if it happened, but not wholly in
            view, or if no truth applies.
        kind: The line of the score in which it counts; None if no truth applies.
    """

    chronicle: str
    arguments: dict[str, str]
    times: dict[str, float]
    begin: float
    end: float
    recognised_at: float
    events: list[dict[str, Any]]
    truth: dict[str, str] | None
    agrees: bool | None
    kind: str | None = None


class Manoeuvre(_Value):
    """A true manoeuvre, for the list of what was missed.

    Attributes:
        kind: What happened, such as `turn_left` or `overtake`.
        vehicles: The simulator's ids, such as those of overtaker and overtaken.
        place: Where, by names of the map, if a recognition has to say so: of a turn the link,
            the crossing and the link.
        begin: milliseconds.
        end: milliseconds.
    """

    kind: str
    vehicles: list[str]
    place: list[str]
    begin: float
    end: float


class Score(_Value):
    """How recognitions of one kind compare with the truth.

    Attributes:
        truth: True manoeuvres wholly in view.
        recognised: Recognitions, without those of manoeuvres not wholly in view.
        correct: Recognitions that the truth confirms.
        precision: correct / recognised, None if nothing was recognised.
        recall: correct / truth, None if there was nothing to recognise.
        left_out: True manoeuvres that were not wholly in view.
    """

    truth: int
    recognised: int
    correct: int
    precision: float | None
    recall: float | None
    left_out: int

    @classmethod
    def of(cls, truth: int, recognised: int, correct: int, left_out: int) -> "Score":
        """Return a score with precision and recall, where there is something to divide by."""
        return cls(
            truth=truth,
            recognised=recognised,
            correct=correct,
            precision=correct / recognised if recognised else None,
            recall=correct / truth if truth else None,
            left_out=left_out,
        )


class Lateness(_Value):
    """How a run kept to the clock on the wall.

    The work of an instant is done late by the time from the instant until that.

    Attributes:
        max_ms: The most, milliseconds.
        mean_ms: Over all instants.
        late_share: Share of the instants whose work was not done one step of the simulation
            after them.
        period_changes: How often a sample period was lengthened or restored because of that.
    """

    max_ms: float
    mean_ms: float
    late_share: float
    period_changes: int = 0


class Timing(_Value):
    """How long a run took.

    Attributes:
        simulated_s: Simulated seconds.
        wall_s: Seconds on the clock, from the first step to the last.
        real_time_factor: Simulated seconds per second on the clock.
        stages: CPU seconds of each process of the network.
        lateness: In real time, how late it was; None if it ran as fast as possible.
    """

    simulated_s: float
    wall_s: float
    real_time_factor: float
    stages: dict[str, float]
    lateness: Lateness | None = None


class StreamDifference(_Value):
    """The first place at which a stream came out otherwise than it was recorded.

    Attributes:
        stream: The topic of the stream in the recording.
        at: Available time of the sample there, milliseconds.
        what: What was recorded there and what came.
    """

    stream: str
    at: float
    what: str


class Replay(_Value):
    """How a replay compares with what was recorded.

    Attributes:
        recording: The file.
        changes: Why streams may differ, a line each: what is not as it was when that was
            recorded (the specification, files, versions of libraries), and what it lacks.
        notes: What else one should know, a line each.
        taken: Labels of the streams that were taken from the recording.
        compared: Number of streams that were computed and had been recorded.
        identical: Number of these that came out byte by byte as they were recorded.
        differences: The first difference of each of the others.
    """

    recording: str
    changes: list[str]
    notes: list[str]
    taken: list[str]
    compared: int
    identical: int
    differences: list[StreamDifference]

    @property
    def is_fault(self) -> bool:
        """Whether the same system gave other streams for the same input."""
        return bool(self.differences) and not self.changes


class RecklessDriverResult(_Value):
    """A car that did something reckless, and for how long it counted as a reckless driver.

    Attributes:
        symbol: Of the reckless driver.
        car: The symbol of its car.
        since: When the car was linked to it, milliseconds.
        until: When that was dropped; None if it still stood at the end.
        acts: How many reckless acts of the car were recognised.
        last_act_at: When the last of them was, milliseconds.
    """

    symbol: str
    car: str
    since: float
    until: float | None
    acts: int
    last_act_at: float


class RunResult(_Value):
    """Everything that `traffic report` shows of a run.

    Attributes:
        scenario: Name of the scenario or of the SUMO configuration.
        settings: What was asked for: view, seed, noise, period, duration.
        recognitions: In order of time.
        missed: True manoeuvres in view that were not recognised.
        score: By kind of manoeuvre; empty if no truth is known.
        timing: How long it took.
        violations: How many violations of policies each stream had; without those that had none.
        failures: The processes that failed and ended while the rest went on, a line each.
        replay: If the run was a replay, how it compares with what was recorded.
        reckless_drivers: In the order in which they became so; None if nobody looked for them.
    """

    scenario: str
    settings: dict[str, str | int | float | None]
    recognitions: list[RecognitionResult]
    missed: list[Manoeuvre]
    score: dict[str, Score]
    timing: Timing
    violations: dict[str, int] = {}
    failures: list[str] = []
    replay: Replay | None = None
    reckless_drivers: list[RecklessDriverResult] | None = None


def car_names(arguments: Mapping[str, str]) -> tuple[str, ...]:
    """Return which arguments of a recognition are cars, by their names: `c`, `c2`, `car1`."""
    return tuple(name for name in arguments if _CAR.fullmatch(name))


@contextmanager
def run_folder(path: Path) -> Iterator[Path]:
    """Give a folder to write a run into, which becomes *path* when the block ends well.

    Raises:
        ResultError: *path* exists already or cannot be made, or another run is to become it.
    """
    try:
        partial = _reserve(path)
    except OSError as error:
        raise ResultError(f"cannot write to '{path}': {error.strerror}") from error
    try:
        yield partial
        _rename(partial, path)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def new_folder(name: str) -> Path:
    """Return the first of `runs/NAME-0001`, `runs/NAME-0002`, … that no run has or is writing."""
    number = 1
    while (path := Path("runs") / f"{name}-{number:04d}").exists() or _partial(path).exists():
        number += 1
    return path


def write_result(result: RunResult, folder: Path) -> None:
    """Write *result* into the folder of its run."""
    (folder / _RESULT_FILE).write_text(result.model_dump_json(indent=1) + "\n", encoding="utf-8")


def read_result(folder: Path) -> RunResult:
    """Read the result of the run in *folder*.

    Raises:
        ResultError: There is no finished run, or its file was damaged.
    """
    path = folder / _RESULT_FILE
    try:
        return RunResult.model_validate_json(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ResultError(f"'{folder}' holds no finished run: {error.strerror}") from error
    except (ValidationError, UnicodeDecodeError) as error:
        raise ResultError(f"'{path}' is not the result of a run: {_first_fault(error)}") from error


def _partial(path: Path) -> Path:
    return path.with_name(f"{path.name}.partial")


def _reserve(path: Path) -> Path:
    if path.exists():
        raise ResultError(f"'{path}' exists already; a run never changes what is there")
    partial = _partial(path)
    try:
        partial.mkdir(parents=True)
    except FileExistsError as error:
        raise ResultError(
            f"'{partial}' exists: a run is writing there, or was killed and left it; "
            "choose another folder, or remove that one"
        ) from error
    return partial


def _rename(partial: Path, path: Path) -> None:
    try:
        partial.rename(path)
    except OSError as error:
        raise ResultError(f"cannot write to '{path}': {error.strerror}") from error


def _first_fault(error: ValidationError | UnicodeDecodeError) -> str:
    if isinstance(error, UnicodeDecodeError):
        return "it is not UTF-8"
    fault = error.errors()[0]
    where = ".".join(str(part) for part in fault["loc"])
    return f"{where}: {fault['msg']}" if where else fault["msg"]
