"""Films as web browsers play them: VP9 in WebM, small enough to be part of a page.

The codec is free of licence fees, and all browsers of today know it. What OpenCV writes without
help of others (MPEG-4 part 2) none of them plays.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from av.video.frame import PictureType

from perception.errors import PerceptionError

__all__ = ["FilmReadError", "count_frames", "write_web_film"]

_CODEC = "libvpx-vp9"
_MILLISECOND = Fraction(1, 1000)
_SECONDS_BETWEEN_KEYS = 2
_OPTIONS = {"deadline": "realtime", "cpu-used": "7", "row-mt": "1", "crf": "42"}


class FilmReadError(PerceptionError):
    """A film cannot be read."""

    def __init__(self, path: Path, why: str) -> None:
        super().__init__(f"cannot read the film '{path}': {why}")
        self.path = path


def count_frames(path: Path) -> int:
    """Return how many frames a film has.

    Raises:
        FilmReadError: It is no film.
    """
    try:
        with av.open(str(path)) as film:
            if not film.streams.video:
                raise FilmReadError(path, "there is no picture in it")
            packets = film.demux(film.streams.video[0])
            return sum(1 for packet in packets if packet.size)
    except (av.FFmpegError, OSError) as error:
        raise FilmReadError(path, _short(error)) from error


def write_web_film(
    source: Path, target: Path, times: Sequence[int], *, width: int, bits_per_second: int
) -> None:
    """Write some frames of the film *source* as WebM to *target*.

    Args:
        source: The film.
        target: A new file.
        times: When each frame of *source* is to be shown, milliseconds, ascending; -1 to leave it
            out.
        width: In pixels, at most; narrower films keep theirs.
        bits_per_second: On average, at most about.

    Raises:
        FilmReadError: *source* is no film.
    """
    try:
        with av.open(str(source)) as film, av.open(str(target), "w", format="webm") as made:
            shown = film.streams.video[0]
            factor = min(1.0, width / shown.width)
            size = [2 * round(factor * side / 2) for side in (shown.width, shown.height)]
            rate = _rate(times)
            stream: Any = made.add_stream(_CODEC, rate=rate, options=_OPTIONS)
            stream.width, stream.height = size
            stream.pix_fmt = "yuv420p"
            stream.bit_rate = bits_per_second
            stream.time_base = _MILLISECOND
            stream.codec_context.time_base = _MILLISECOND
            stream.codec_context.gop_size = max(1, round(rate * _SECONDS_BETWEEN_KEYS))
            for frame in _retimed(film.decode(shown), times, size):
                made.mux(stream.encode(frame))
            made.mux(stream.encode(None))
    except (av.FFmpegError, OSError) as error:
        raise FilmReadError(source, _short(error)) from error


def _retimed(
    frames: Iterator[av.VideoFrame], times: Sequence[int], size: Sequence[int]
) -> Iterator[av.VideoFrame]:
    for frame, time in zip(frames, times, strict=False):
        if time >= 0:
            made = frame.reformat(size[0], size[1], "yuv420p", interpolation="AREA")
            made.pts, made.time_base = time, _MILLISECOND
            made.pict_type = PictureType.NONE  # a key frame there need not be one here
            yield made


def _rate(times: Sequence[int]) -> Fraction:
    """Return how many frames there are in a second, on average."""
    shown = np.array([time for time in times if time >= 0])
    if len(shown) < 2:  # noqa: PLR2004, a beginning and an end
        return Fraction(25)
    return Fraction(1000 * (len(shown) - 1), int(shown[-1] - shown[0])).limit_denominator(1000)


def _short(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error).splitlines()[0]
