"""Merged blobs cut apart, and pieces joined."""

import cv2
import numpy as np

from perception.blobs import Blobs, find_blobs
from perception.camera import Calibration, Camera
from perception.joining import join
from perception.locating import locate
from perception.splitting import split
from tests.perception.sightings import tracks

CAMERA = Camera.looking_at(
    0.0, 0.0, 70.0, calibration=Calibration.from_field_of_view(width=640, height=360)
)


def blobs_of(*boxes):
    """Return the blobs of boxes (x, y, length, width) that lie flat along x."""
    mask = np.zeros((360, 640), dtype=np.uint8)
    for x, y, length, width in boxes:
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (length / 2, width / 2)
        pixels = CAMERA.image_from_ground(corners + np.array([x, y]))
        cv2.fillPoly(mask, [np.rint(pixels).astype(np.int32)], 255.0)
    return find_blobs(mask)


def seen(blobs):
    """Return the sightings of blobs."""
    return locate(blobs, CAMERA, noise_px=0.4)


def test_a_blob_over_two_tracks_is_cut_in_two():
    """Two cars side by side that have grown together are located one by one."""
    blobs = blobs_of((0.0, 1.6, 5.0, 5.0))
    known = tracks((1, 0.1, 0.1, 0.0, 5.0, 1.8), (2, -0.1, 3.1, 0.0, 5.0, 1.8))

    parts, outlines, is_part = split(seen(blobs), blobs.outlines, known, CAMERA)

    assert is_part.tolist() == [True, True]
    np.testing.assert_allclose(parts.position, [[0.0, 0.35], [0.0, 2.85]], atol=0.5)
    assert len(outlines) == 3
    assert parts.blob.tolist() == [1, 2]


def test_a_queue_in_one_blob_is_cut_into_its_cars():
    """Three cars one behind the other come apart at the gaps that are known."""
    blobs = blobs_of((0.0, 0.0, 18.0, 1.8))
    known = tracks(*[(i, 6.5 * i - 6.5, 0.0, 0.0, 5.0, 1.8) for i in range(3)])

    parts, _, _ = split(seen(blobs), blobs.outlines, known, CAMERA)

    np.testing.assert_allclose(np.sort(parts.position[:, 0]), [-6.2, 0.0, 6.2], atol=0.6)


def test_a_blob_over_one_track_stays_whole():
    """One vehicle, one sighting, whatever else is tracked far away."""
    blobs = blobs_of((0.0, 0.0, 5.0, 1.8))
    known = tracks((1, 0.0, 0.0, 0.0, 5.0, 1.8), (2, 20.0, 0.0, 0.0, 5.0, 1.8))

    whole, _, is_part = split(seen(blobs), blobs.outlines, known, CAMERA)

    assert len(whole) == 1
    assert not is_part.any()


def test_what_is_no_larger_than_a_car_is_not_cut():
    """Two tracks on the pieces of one car do not keep it in pieces."""
    blobs = blobs_of((0.0, 0.0, 5.0, 1.8))
    known = tracks((1, 1.5, 0.0, 0.0, 2.0, 1.7), (2, -1.2, 0.0, 0.0, 2.6, 1.7))

    whole, _, _ = split(seen(blobs), blobs.outlines, known, CAMERA)

    assert len(whole) == 1


def test_the_pieces_of_a_tracked_car_are_joined():
    """Bonnet and boot, seen apart, are one sighting of the car's length."""
    blobs = blobs_of((1.9, 0.0, 1.2, 1.8), (-1.2, 0.0, 2.6, 1.8))
    shown = seen(blobs)

    joined, outlines = join(
        shown, blobs.outlines, shown, tracks((1, 0.1, 0.0, 0.0, 5.0, 1.8)), CAMERA
    )

    assert len(joined) == 1
    np.testing.assert_allclose(joined.position, [[0.0, 0.0]], atol=0.2)
    np.testing.assert_allclose(joined.length, [5.0], atol=0.4)
    assert joined.blob.tolist() == [2]
    assert len(outlines) == 3


def test_a_car_that_is_whole_is_left_as_it_is():
    """Nothing is joined when a blob has the length of the track."""
    blobs = blobs_of((0.0, 0.0, 5.0, 1.8), (9.0, 0.0, 5.0, 1.8))
    shown = seen(blobs)

    joined, outlines = join(
        shown, blobs.outlines, shown, tracks((1, 0.1, 0.0, 0.0, 5.0, 1.8)), CAMERA
    )

    assert joined is shown
    assert outlines is blobs.outlines


def test_without_tracks_nothing_is_cut_or_joined():
    """What is not known cannot be cut or joined."""
    blobs = blobs_of((0.0, 0.0, 12.0, 2.5))
    shown = seen(blobs)

    assert len(split(shown, blobs.outlines, tracks(), CAMERA)[0]) == 1
    assert join(shown, blobs.outlines, shown, tracks(), CAMERA)[0] is shown
    nothing = Blobs((), np.zeros(0, dtype=bool))
    assert len(split(seen(nothing), (), tracks((1, 0, 0, 0, 5, 1.8)), CAMERA)[0]) == 0
