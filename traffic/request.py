"""What a user asks of a run, read from the command line and checked before anything starts."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from dyknow.time import MILLISECOND, SECOND, Duration, duration_from_text
from traffic.errors import RequestError
from traffic.scenarios import CameraSettings, Scenario, find_scenario, scenario_of_configuration
from traffic.settings import SCENARIO

__all__ = [
    "DEFAULT_PERIOD",
    "FRAME_PERIOD",
    "OPTIONS",
    "RecordingRequest",
    "RunRequest",
    "View",
    "labels_from",
]

DEFAULT_PERIOD = Duration(100 * MILLISECOND)
"""Of the reasoning."""

FRAME_PERIOD = Duration(40 * MILLISECOND)
"""Of the cameras."""

_EVERYTHING = "all"
OPTIONS = frozenset(
    (
        "duration",
        "look_at",
        "position_noise",
        "recognise",
        "sample_period",
        "specification",
        "view",
    )
)
"""Settings of an experiment that are options of a run."""

_LONGEST_STEP = 100
_SHORTEST_PERIOD = 10
_FARTHEST = 1e7
_HOVER = CameraSettings(look_at=(0.0, 0.0), altitude=150.0, field_of_view=84.0)
"""From where a crossing is watched of which no scenario says how."""


class View(StrEnum):
    """Who makes the percepts."""

    VISION = "vision"
    TRUTH = "truth"


@dataclass(frozen=True, slots=True)
class RecordingRequest:
    """What a user wants to have recorded.

    Attributes:
        path: The file to write.
        streams: Labels of the streams that are wanted; None for all but images.
        images: Whether images are wanted as well, to be looked at.
    """

    path: Path
    streams: tuple[str, ...] | None = None
    images: bool = False

    @classmethod
    def from_texts(
        cls,
        *,
        record: Path | None = None,
        streams: str | None = None,
        record_images: bool = False,
    ) -> "RecordingRequest | None":
        """Read what a user wrote on the command line; None if nothing is to be recorded.

        Raises:
            RequestError: An option is impossible, or has no meaning without `--record`.
        """
        if record is None:
            for option, value in (("--streams", streams), ("--record-images", record_images)):
                if value:
                    fault = "nothing, because it only has a meaning with --record"
                    raise RequestError(option, fault, value)
            return None
        _check_new_file(record, "--record", ".mcap")
        labels = None
        if streams is not None:
            labels = labels_from(streams, "--streams")
        return cls(record, labels, record_images)


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRequest:
    """What a user asks of a run.

    Attributes:
        scenario: Where and what; its duration and camera are those asked for.
        view: Through the cameras, or from the simulator's positions.
        sample_period: Period of the reasoning.
        position_noise: Largest error of positions per axis, metres; only without cameras.
        seed: Of everything random.
        out: Folder of the run; None for a new one in `runs`.
        overlay: Video of what is believed, if wanted.
        recording: The streams in a file, if wanted.
        specification: File of the network of processes; None for the bundled one.
        real_time: Whether to keep to the clock on the wall.
        longest_frame_period: How far apart images may be when the work falls behind that clock.
        recognise: Names of what is to be recognised, such as `turns`; None for everything.
        changes: New values of settings of the specification (`traffic.settings`), by name.
    """

    scenario: Scenario
    view: View
    sample_period: Duration
    position_noise: float
    seed: int
    out: Path | None
    overlay: Path | None
    recording: RecordingRequest | None = None
    specification: Path | None = None
    real_time: bool = False
    longest_frame_period: Duration = FRAME_PERIOD
    recognise: tuple[str, ...] | None = None
    changes: Mapping[str, object] = field(default_factory=dict)

    @property
    def simulated_seconds(self) -> float:
        """How long the run is, with its warm-up."""
        return (self.scenario.warm_up + self.scenario.duration) / SECOND

    @classmethod
    def from_settings(
        cls, scenario: str, settings: Mapping[str, object], *, seed: int, out: Path
    ) -> "RunRequest":
        """Return a request with the settings of an experiment.

        Those that are called like options of the command line are these options (`view`,
        `sample_period`, `position_noise`, `duration`, `recognise`, `look_at`, `specification`),
        all others are changes, as `--set` makes them.

        Raises:
            RequestError: A setting is impossible, or has no meaning beside another one.
            ScenarioError: There is no such scenario, or it has faults.
        """
        options = {k: _option(k, v) for k, v in settings.items() if k in OPTIONS}
        changes = {k: v for k, v in settings.items() if k not in OPTIONS}
        texts: Any = options
        return cls.from_texts(scenario=scenario, seed=seed, out=out, changes=changes, **texts)

    @classmethod
    def from_texts(  # noqa: PLR0913, one for each option of the command
        cls,
        *,
        scenario: str | None = None,
        sumocfg: Path | None = None,
        look_at: str | None = None,
        view: str = "vision",
        sample_period: str = "100",
        position_noise: float = 0.0,
        seed: int = 1,
        duration: str | None = None,
        out: Path | None = None,
        overlay: Path | None = None,
        record: Path | None = None,
        streams: str | None = None,
        record_images: bool = False,
        specification: Path | None = None,
        real_time: bool = False,
        longest_frame_period: str | None = None,
        recognise: str | None = None,
        changes: Mapping[str, object] | None = None,
    ) -> "RunRequest":
        """Read what a user wrote on the command line.

        Raises:
            RequestError: An option is impossible, or has no meaning beside another one.
            ScenarioError: There is no such scenario, or it has faults.
        """
        seen = _view(view)
        if seen is View.TRUTH:
            _refuse(look_at, "--look-at", View.VISION)
            _refuse(overlay, "--overlay", View.VISION)
            _refuse(record_images, "--record-images", View.VISION)
            _refuse(longest_frame_period, "--longest-frame-period", View.VISION)
        else:
            _refuse(position_noise, "--position-noise", View.TRUTH)
        if not 0 <= position_noise < math.inf:
            raise RequestError(
                "--position-noise", "a number of metres, at least 0", position_noise
            )
        if overlay is not None:
            _check_new_file(overlay, "--overlay", ".mp4")
        recording = RecordingRequest.from_texts(
            record=record, streams=streams, record_images=record_images
        )
        if seed < 0:
            raise RequestError("--seed", "a number of at least 0", seed)
        period = _period(sample_period, seen)
        wanted = dict(changes or {})
        asked = _scenario(scenario, sumocfg, wanted).model_copy(
            update={"step_length": FRAME_PERIOD if seen is View.VISION else _step(period)}
        )
        if duration is not None:
            asked = asked.model_copy(update={"duration": _duration(duration, "--duration")})
        if look_at is not None:
            asked = asked.model_copy(update={"camera": _hover(look_at, asked.camera)})
        if seen is View.VISION and asked.camera is None:
            raise RequestError("--look-at", "a junction or x,y to hover over", "nothing")
        return cls(
            scenario=asked,
            view=seen,
            sample_period=period,
            position_noise=position_noise,
            seed=seed,
            out=out,
            overlay=overlay,
            recording=recording,
            specification=specification,
            real_time=real_time,
            longest_frame_period=_longest_frame_period(longest_frame_period, real_time=real_time),
            recognise=_recognise(recognise, asked, is_bundled=specification is None),
            changes={k: v for k, v in wanted.items() if not k.startswith(SCENARIO)},
        )


def labels_from(text: str, option: str, what: str = "labels of streams") -> tuple[str, ...]:
    """Return the labels in *text*, which are separated by commas; those in brackets are not.

    Raises:
        RequestError: There is none; the message says *what* was expected.
    """
    parts, depth = [""], 0
    for character in text:
        depth += (character in "([") - (character in ")]")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    labels = [label.strip() for label in parts if label.strip()]
    if not labels:
        raise RequestError(option, f"{what}, separated by commas", text)
    return tuple(dict.fromkeys(labels))


def _recognise(
    text: str | None, scenario: Scenario, *, is_bundled: bool
) -> tuple[str, ...] | None:
    """Return what is to be recognised: what is asked for, or else what the scenario says.

    A scenario speaks of the bundled specification; of another one everything is wanted.
    """
    if text is None:
        return scenario.recognise if is_bundled else None
    names = labels_from(text, "--recognise", "'all', or names such as turns and overtakes")
    return None if names == (_EVERYTHING,) else names


def _view(text: str) -> View:
    try:
        return View(text)
    except ValueError:
        raise RequestError("--view", "'vision' or 'truth'", text) from None


def _refuse(value: object, option: str, view: View) -> None:
    if value:
        raise RequestError(
            option, f"nothing, because it only has a meaning with --view {view}", value
        )


def _check_new_file(path: Path, option: str, ending: str) -> None:
    if path.suffix != ending:
        raise RequestError(option, f"a name that ends in {ending}", path)
    if path.exists():
        raise RequestError(option, "a file that does not exist yet", path)
    if not path.parent.is_dir():
        raise RequestError(option, "a file in a folder that exists", path)


def _scenario(name: str | None, sumocfg: Path | None, changes: Mapping[str, object]) -> Scenario:
    if (name is None) == (sumocfg is None):
        found = "both" if name is not None else "neither"
        raise RequestError("traffic run", "either a scenario or --sumocfg", found)
    of_scenario = {
        key.removeprefix(SCENARIO): value
        for key, value in changes.items()
        if key.startswith(SCENARIO)
    }
    if sumocfg is not None:
        if of_scenario:
            expected = "a setting of the specification, because --sumocfg is no scenario"
            raise RequestError("--set", expected, SCENARIO + next(iter(of_scenario)))
        return scenario_of_configuration(sumocfg)
    return find_scenario(name or "", of_scenario)


def _option(name: str, value: object) -> object:
    """Return the value of an option as the command line has it."""
    match name, value:
        case "position_noise", bool() | str():
            raise RequestError(name, "a number of metres", value)
        case "position_noise", _:
            return value
        case "specification", _:
            return Path(str(value))
        case _:
            return str(value)


def _duration(text: str, option: str) -> Duration:
    try:
        duration = duration_from_text(text)
    except ValueError as error:
        raise RequestError(option, "a duration such as '200', '1.5 s' or '1 min'", text) from error
    if duration <= 0:
        raise RequestError(option, "a duration above zero", text)
    return duration


def _period(text: str, view: View) -> Duration:
    period = _duration(text, "--sample-period")
    shortest = FRAME_PERIOD if view is View.VISION else Duration(_SHORTEST_PERIOD * MILLISECOND)
    if period < shortest or period % (_SHORTEST_PERIOD * MILLISECOND):
        wanted = f"a multiple of {_SHORTEST_PERIOD} ms, at least {shortest // MILLISECOND} ms"
        raise RequestError("--sample-period", wanted, text)
    return period


def _longest_frame_period(text: str | None, *, real_time: bool) -> Duration:
    option = "--longest-frame-period"
    if text is None:
        return FRAME_PERIOD
    if not real_time:
        raise RequestError(option, "nothing, because it only has a meaning with --real-time", text)
    longest = _duration(text, option)
    if longest % FRAME_PERIOD:
        raise RequestError(option, f"a multiple of {FRAME_PERIOD // MILLISECOND} ms", text)
    return longest


def _step(period: Duration) -> Duration:
    """Return the longest step of at most 100 ms of which *period* is a multiple."""
    length = period // MILLISECOND
    longest = next(step for step in range(_LONGEST_STEP, 0, -1) if length % step == 0)
    return Duration(longest * MILLISECOND)


def _hover(look_at: str, camera: CameraSettings | None) -> CameraSettings:
    return (camera or _HOVER).model_copy(update={"look_at": _place(look_at)})


def _place(text: str) -> str | tuple[float, float]:
    """Return the point that *text* says, or *text* itself as the name of a junction."""
    x, _, y = text.partition(",")
    try:
        point = float(x), float(y)
    except ValueError:
        return text
    if not all(abs(number) <= _FARTHEST for number in point):
        raise RequestError("--look-at", f"metres, at most {_FARTHEST:.0f}", text)
    return point
