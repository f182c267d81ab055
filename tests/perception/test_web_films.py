"""Films for web browsers: the codec, the times of the frames, the size."""

from pathlib import Path

import av
import numpy as np
import pytest

from perception.overlay import FilmWriter
from perception.web_films import FilmReadError, count_frames, write_web_film

SIZE = (320, 96)


@pytest.fixture
def film(tmp_path: Path) -> Path:
    """Return a film of 30 frames, each brighter than the one before."""
    path = tmp_path / "film.mp4"
    with FilmWriter(path, SIZE, frames_per_second=25.0) as writer:
        for number in range(30):
            writer.write(np.full((SIZE[1], SIZE[0], 3), 8 * number, dtype=np.uint8))
    return path


def test_all_frames_are_counted(film):
    """As many as were written."""
    assert count_frames(film) == 30


def test_frames_are_shown_at_the_times_given(film, tmp_path):
    """Every third frame, at uneven times: each is where it is to be, and shows what it showed."""
    times = [100 * n + n % 2 if n % 3 == 0 else -1 for n in range(30)]
    made = tmp_path / "film.webm"

    write_web_film(film, made, times, width=1000, bits_per_second=200_000)

    with av.open(str(made)) as opened:
        frames = list(opened.decode(video=0))
    assert [round(1000 * frame.time) for frame in frames] == [t for t in times if t >= 0]
    shown = [frame.to_ndarray(format="gray").mean() for frame in frames]
    np.testing.assert_allclose(shown, 24 * np.arange(10), atol=12)


def test_films_are_vp9_and_no_wider_than_asked_for(film, tmp_path):
    """Browsers play VP9; the height goes with the width, and both are even."""
    made = tmp_path / "film.webm"

    write_web_film(film, made, range(0, 1200, 40), width=162, bits_per_second=200_000)

    with av.open(str(made)) as opened:
        stream = opened.streams.video[0]
        assert stream.codec_context.name in {"vp9", "libvpx-vp9"}
        assert (stream.width, stream.height) == (162, 48)
        keys = sum(packet.is_keyframe for packet in opened.demux(stream) if packet.size)
    assert keys == 1


@pytest.mark.parametrize("content", [b"", b"no film at all" * 99])
def test_what_is_no_film_is_refused(tmp_path, content):
    """The message names the file."""
    path = tmp_path / "film.mp4"
    path.write_bytes(content)

    with pytest.raises(FilmReadError, match=r"cannot read the film .*film\.mp4"):
        count_frames(path)


def test_a_missing_film_is_refused(tmp_path):
    """As by everything that reads files."""
    with pytest.raises(FilmReadError, match="No such file"):
        write_web_film(tmp_path / "x", tmp_path / "y", [0], width=100, bits_per_second=1000)
