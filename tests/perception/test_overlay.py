"""Drawing over images, and films."""

import cv2
import numpy as np
import pytest

from perception.overlay import FilmError, FilmWriter, Mark, Trail, draw_overlay, side_by_side

GREY = np.full((120, 160), 90, dtype=np.uint8)
BOX = np.array([[40.0, 40.0], [80.0, 40.0], [80.0, 60.0], [40.0, 60.0]])


def test_marks_trails_and_captions_are_drawn_on_a_copy():
    """Each of them changes pixels near its place; the given image stays as it is."""
    drawn = draw_overlay(
        GREY,
        [Mark("car3", BOX, (255, 60, 60))],
        [Trail(np.array([[10.0, 20.0], [60.0, 20.0]]), (60, 255, 60))],
        ["turned left"],
    )

    assert (GREY == 90).all()
    assert drawn.shape == (120, 160, 3)
    red = drawn[40, 45:75].astype(int)
    assert (red[:, 2] > red[:, 0] + 50).all()
    assert drawn[20, 12:58, 1].mean() > 120
    assert drawn[100, 150].max() < 90


def test_points_without_a_pixel_are_left_out():
    """NaN corners, of what lies behind the camera, do no harm."""
    nowhere = np.full((4, 2), np.nan)

    drawn = draw_overlay(GREY, [Mark("a", nowhere, (1, 2, 3))], [Trail(nowhere, (1, 2, 3))], [])

    assert (drawn == 90).all()


def test_a_grey_and_a_coloured_image_stand_side_by_side():
    """The width doubles and both halves keep their pixels."""
    colour = np.full((120, 160, 3), (10, 20, 30), dtype=np.uint8)

    both = side_by_side(colour, GREY)

    assert both.shape == (120, 320, 3)
    assert both[0, 0].tolist() == [10, 20, 30]
    assert both[0, 319].tolist() == [90, 90, 90]


def test_a_film_has_the_frames_that_were_written(tmp_path):
    """What is written can be read again, shrunk to the size of the film."""
    path = tmp_path / "film.mp4"
    frame = side_by_side(GREY, GREY)

    with FilmWriter(path, (160, 60), frames_per_second=25.0) as film:
        for _ in range(5):
            film.write(frame)

    capture = cv2.VideoCapture(str(path))
    assert capture.get(cv2.CAP_PROP_FRAME_COUNT) == 5
    assert capture.get(cv2.CAP_PROP_FRAME_WIDTH) == 160
    capture.release()


def test_a_film_in_a_missing_folder_is_refused(tmp_path):
    """The error names the file."""
    with pytest.raises(FilmError, match=r"cannot write a film to '.*film\.mp4'"):
        FilmWriter(tmp_path / "none" / "film.mp4", (160, 60), frames_per_second=25.0)
