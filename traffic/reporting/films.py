"""The overlay film of a run as part of its page: in step with the run, in a browser's codec."""

import base64
import tempfile
from dataclasses import dataclass
from functools import reduce
from pathlib import Path

import numpy as np

from dyknow.time import MILLISECOND
from perception.web_films import count_frames, write_web_film
from traffic.errors import RequestError
from traffic.explaining.kept import KeptRun
from traffic.reporting.tracks import Whole

__all__ = ["EmbeddedFilm", "embedded_film", "film_beside"]

_WIDTH = 1_280
_BITS_PER_SECOND = 320_000
_STEP_MS = 80
_PERIOD_MS = 40
"""Between two frames of a film, where the run does not tell when they were taken."""


@dataclass(frozen=True, slots=True)
class EmbeddedFilm:
    """A film as text; its time is that of the run.

    Attributes:
        data: WebM, in base 64.
        is_timed: Whether the run has told when each frame was taken.
    """

    data: str
    is_timed: bool


def film_beside(folder: Path) -> Path | None:
    """Return the film beside the folder of a run, `runs/x.mp4` of `runs/x`; None without."""
    path = folder.with_name(f"{folder.name}.mp4")
    return path if path.is_file() else None


def embedded_film(path: Path, run: KeptRun | None) -> EmbeddedFilm:
    """Return the overlay film of a run, made small, at the times at which it was taken.

    Args:
        path: The film that `--overlay` has written.
        run: What the run keeps; None if it keeps nothing.

    Raises:
        FilmReadError: It is no film.
        RequestError: It is that of another run.
    """
    frames = count_frames(path)
    times = _PERIOD_MS * np.arange(frames) if run is None else _times(run)
    if not len(times):
        raise RequestError("--film", "no film, because this run was made without cameras", path)
    if len(times) != frames:
        expected = f"the film of this run, with {len(times)} frames"
        raise RequestError("--film", expected, f"{path}, with {frames}")
    with tempfile.TemporaryDirectory(prefix="traffic-") as folder:
        small = Path(folder) / "film.webm"
        write_web_film(
            path, small, _thinned(times), width=_WIDTH, bits_per_second=_BITS_PER_SECOND
        )
        data = base64.b64encode(small.read_bytes()).decode()
    return EmbeddedFilm(data, run is not None)


def _times(run: KeptRun) -> Whole:
    """Return when the frames were taken: the times of which there is an image in every stream."""
    by_stream = [
        of["valid_time"].to_numpy(np.int64)
        for _, of in run.images.groupby("stream", observed=True)
    ]
    if not by_stream:
        return np.empty(0, dtype=np.int64)
    return reduce(np.intersect1d, by_stream) // MILLISECOND


def _thinned(times: Whole) -> list[int]:
    """Return the times, with -1 in place of those that are too near to the one before."""
    shown, last = [], -_STEP_MS
    for time in times.tolist():
        is_shown = time - last >= _STEP_MS
        shown.append(time if is_shown else -1)
        last = time if is_shown else last
    return shown
