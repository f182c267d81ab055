"""The page of a run: map with tracks, film, time line, and why each thing was recognised."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from dyknow.time import MILLISECOND
from networks.errors import NetworkError
from networks.roads import RoadMap
from networks.signals import SignalState
from traffic.errors import TrafficError
from traffic.explaining.kept import KeptRun, open_kept_run, records_of
from traffic.explaining.walking import Walker
from traffic.reporting.drawn_maps import Box, drawn_map
from traffic.reporting.films import EmbeddedFilm, embedded_film
from traffic.reporting.items import items_of
from traffic.reporting.pages import embedded, render
from traffic.reporting.reasons import conditions_of, processes_of, reasons_of
from traffic.reporting.scores import ScoreRow, score_rows
from traffic.reporting.tracks import tracks_of
from traffic.results import RunResult, Score
from traffic.watching import OnProgress

__all__ = ["page_of_run", "page_of_runs"]

_Found = TypeVar("_Found")
_UNIT_SETTINGS = {"sample period ms": "ms", "position noise m": "m", "duration s": "s"}


def page_of_run(
    folder: Path, result: RunResult, film: Path | None, on_progress: OnProgress
) -> str:
    """Return the page of a run as one self-contained HTML document.

    What the run does not keep, or cannot be read any more, the page says.

    Args:
        folder: Of the run.
        result: What it found out.
        film: Its overlay film, if it is to be part of the page.
        on_progress: Told how many recognitions and misses have been explained, and of how many.

    Raises:
        FilmReadError: *film* is no film.
        RequestError: It is that of another run.
    """
    kept = _Kept(folder)
    shown = None if film is None else embedded_film(film, kept.run)
    if shown is not None and not shown.is_timed:
        kept.missing.append("when each frame of the film was taken: it is taken to be 25 a second")
    return render(
        "run.html",
        {
            "title": result.scenario,
            "folder": folder.name,
            "result": result,
            "facts": list(_facts(result)),
            "settings": {k: v for k, v in result.settings.items() if v is not None},
            "scores_shown": score_rows(result.score),
            "missing": kept.missing,
            "has_map": kept.tracks is not None or kept.map is not None,
            "has_film": shown is not None,
            "data": embedded(_data(result, kept, shown, on_progress)),
        },
    )


def page_of_runs(results: Mapping[Path, RunResult], total: Mapping[str, Score]) -> str:
    """Return the page of several runs: the scores of each, and their sum."""
    return render(
        "runs.html",
        {
            "title": f"{len(results)} runs",
            "total": score_rows(total),
            "runs": [
                (str(folder), result, list(_facts(result)), _by_kind(result.score, total))
                for folder, result in results.items()
            ],
            "seconds": sum(result.timing.simulated_s for result in results.values()),
            "recognitions": sum(len(result.recognitions) for result in results.values()),
        },
    )


def _by_kind(
    score_by_kind: Mapping[str, Score], kinds: Mapping[str, Score]
) -> list[ScoreRow | None]:
    """Return the row of each of some kinds; None for a kind that a run could not recognise."""
    rows = dict(zip(score_by_kind, score_rows(score_by_kind), strict=True))
    return [rows.get(kind) for kind in kinds]


@dataclass
class _Kept:
    """What a page shows of what a run keeps, as far as it is there.

    Attributes:
        folder: Of the run.
        missing: What is not there, and why.
    """

    folder: Path
    missing: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.run = self._unless_missing("map, tracks and explanations", self._opened)
        self.walker = None
        self.tracks = None
        self.map = None
        self.signals: dict[str, Any] = {}
        if self.run is not None:
            run = self.run
            self.tracks = self._unless_missing("the tracks", lambda: tracks_of(run))
            self.walker = self._unless_missing("map and explanations", lambda: Walker(run))
        if self.walker is not None:
            walker = self.walker
            self.map = self._unless_missing("the map", lambda: self._drawn(walker))
            self.signals = _signals(walker.run, walker.road_map) if self.map else {}

    def _opened(self) -> KeptRun:
        return open_kept_run(self.folder)

    def _drawn(self, walker: Walker) -> dict[str, Any]:
        reached = None if self.tracks is None else _reached(self.tracks)
        return drawn_map(walker.road_map, walker.camera, reached)

    def _unless_missing(self, what: str, read: Callable[[], _Found]) -> _Found | None:
        try:
            return read()
        except (TrafficError, NetworkError) as error:
            self.missing.append(f"{what}: {error}")
            return None


def _data(
    result: RunResult, kept: _Kept, film: EmbeddedFilm | None, on_progress: OnProgress
) -> dict[str, Any]:
    walker = kept.walker
    return {
        "end": round(1000 * result.timing.simulated_s),
        "items": items_of(result),
        "map": kept.map,
        "tracks": kept.tracks,
        "signals": kept.signals,
        "reasons": {} if walker is None else reasons_of(walker, on_progress),
        "processes": {} if walker is None else processes_of(walker),
        "conditions": {} if walker is None else conditions_of(walker),
        "film": None if film is None else film.data,
        "command": f"traffic explain {kept.folder}",
    }


def _facts(result: RunResult) -> Iterator[tuple[str, str]]:
    settings = result.settings
    for name in ("view", "seed", "position noise m", "sample period ms"):
        value = settings.get(name)
        if value is not None:
            unit = _UNIT_SETTINGS.get(name, "")
            text = f"{value:g}" if isinstance(value, float) else str(value)
            yield name.removesuffix(f" {unit}"), f"{text} {unit}".strip()
    yield "simulated", f"{result.timing.simulated_s:g} s"
    yield "times real time", f"{result.timing.real_time_factor:.1f}"
    yield "recognised", str(len(result.recognitions))
    yield "violations of policies", str(sum(result.violations.values()))


def _signals(run: KeptRun, road_map: RoadMap) -> dict[str, list[tuple[float, str | None]]]:
    """Return when each signal of a map came to show what, as far as the run's events tell."""
    shown: dict[str, list[tuple[float, str | None]]] = {}
    names = set(road_map.signals.names)
    if not names:
        return shown
    for row in records_of(run.events.sort_values("time", kind="stable")):
        arguments = list(row["arguments"])
        is_state = str(row["after"]).upper() in SignalState.__members__
        if is_state and len(arguments) == 1 and arguments[0] in names:
            shown.setdefault(arguments[0], []).append((row["time"] / MILLISECOND, row["after"]))
    return shown


def _reached(tracks: Mapping[str, Any]) -> Box | None:
    """Return the box in which all objects were seen, metres; None if there were none."""
    seen = [_seen(piece) for car in tracks["cars"] for piece in car["pieces"]]
    points = np.concatenate([np.empty((0, 2)), *seen])
    if not len(points):
        return None
    (left, bottom), (right, top) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return left, bottom, right, top


def _seen(piece: Mapping[str, Any]) -> npt.NDArray[np.float64]:
    """Return where on a stretch of a track its object was seen, shape (n, 2), metres."""
    points = np.cumsum([piece["x"], piece["y"]], axis=1).T / [10, -10]
    return np.delete(points, piece["unseen"], axis=0)
