"""From images to percepts, on filmed scenes."""

import numpy as np
import pytest

from perception.pipeline import Pipeline, road_mask
from tests.perception.scenes import BUS, CAR, FRAME, Film, camera, road

CAMERA = camera()


def watch(drive, frames, *, view=CAMERA, seed=0):
    """Film *drive* (frame to rows) and return the rows and the percepts of each frame."""
    film = Film(seed)
    pipeline = Pipeline(film.ground.paved)
    seen = []
    for frame in range(frames):
        rows = drive(frame)
        colour, thermal = film.take(rows, view)
        seen.append((rows, pipeline.perceive(frame * FRAME, colour, thermal, view)))
    return seen


def errors_of(seen, first=3):
    """Return the distances from each vehicle to its nearest percept, from frame *first* on."""
    distances = []
    for rows, percepts in seen[first:]:
        for row in rows:
            offset = percepts.position - np.array(row[1:3])
            distances.append(np.hypot(*offset.T).min(initial=99.0))
    return np.array(distances)


def ids_of(seen, first=3):
    """Return all ids of percepts from frame *first* on."""
    return {int(i) for _, percepts in seen[first:] for i in percepts.ids}


def test_moving_cars_are_seen_where_they_are_and_keep_their_ids():
    """Every car has one percept, one id, the right size, and the right velocity."""
    seen = watch(
        lambda f: [(1, -40 + 0.5 * f, -3.0, 0.0, CAR), (2, 40 - 0.4 * f, 3.0, np.pi, CAR)], 60
    )

    assert np.sqrt(np.mean(errors_of(seen) ** 2)) < 0.15
    assert ids_of(seen) == {1, 2}
    percepts = seen[-1][1]
    assert len(percepts) == 2
    np.testing.assert_allclose(np.sort(percepts.velocity[:, 0]), [-10.0, 12.5], atol=0.6)
    np.testing.assert_allclose(percepts.length, 5.0, atol=0.5)
    np.testing.assert_allclose(percepts.width, 1.8, atol=0.4)


def test_cars_of_the_first_frame_are_seen_while_they_stand_and_leave_no_ghosts():
    """A queue that is there from the beginning is seen at once; nothing is left behind it."""

    def drive(frame):
        gone = max(0, frame - 25)
        return [(i, -10 - 7.5 * i + 0.003 * gone**2, -3.0, 0.0, CAR) for i in range(1, 4)]

    seen = watch(drive, 120)

    assert errors_of(seen).max() < 0.5
    assert ids_of(seen) == {1, 2, 3}
    assert all(len(percepts) == len(rows) for rows, percepts in seen[3:])


def test_a_standing_car_is_not_absorbed():
    """After a long stop the car still has its percept, and the same id."""
    seen = watch(lambda f: [(1, -0.004 * max(0, 80 - f) ** 2, -3.0, 0.0, CAR)], 200)

    assert errors_of(seen).max() < 0.4
    assert ids_of(seen) == {1}


def test_side_by_side_with_little_between_them_two_cars_stay_two():
    """Cars that pass with a gap of 1.4 m keep their ids and positions."""
    seen = watch(
        lambda f: [(1, -30 + 0.5 * f, -3.0, 0.0, CAR), (2, -36 + 0.7 * f, 0.2, 0.0, CAR)], 60
    )

    assert errors_of(seen).max() < 0.5
    assert ids_of(seen) == {1, 2}


def test_a_long_vehicle_is_one_percept():
    """A bus is seen as one thing of its length, its middle where it is."""
    seen = watch(lambda f: [(1, -25 + 0.4 * f, 3.0, 0.0, BUS)], 40)

    assert ids_of(seen) == {1}
    assert errors_of(seen).max() < 0.4
    assert seen[-1][1].length[0] == pytest.approx(12.0, abs=0.8)


def test_an_oblique_camera_sees_where_cars_are_too():
    """At 60° below the horizon the position is still good to a third of a metre."""
    seen = watch(lambda f: [(1, -20 + 0.5 * f, -3.0, 0.0, CAR)], 50, view=camera(pitch=60.0))

    assert np.sqrt(np.mean(errors_of(seen) ** 2)) < 0.3


def test_a_vehicle_that_leaves_the_image_has_no_percept():
    """What is cut by the border of the image is not reported."""
    seen = watch(lambda f: [(1, 40 + 0.8 * f, -3.0, 0.0, CAR)], 60)

    assert len(seen[10][1]) == 1
    assert len(seen[-1][1]) == 0


def test_one_camera_alone_suffices():
    """Without the other image, vehicles are seen by the one there is."""
    film = Film()
    colour_only, thermal_only = Pipeline(film.ground.paved), Pipeline(film.ground.paved)
    percepts = []
    for frame in range(12):
        colour, thermal = film.take([(4, -20 + 0.5 * frame, -3.0, 0.0, CAR)], CAMERA)
        percepts = [
            colour_only.perceive(frame * FRAME, colour, None, CAMERA),
            thermal_only.perceive(frame * FRAME, None, thermal, CAMERA),
        ]

    assert [len(p) for p in percepts] == [1, 1]
    assert np.isnan(percepts[0].temperature).all()
    assert np.isnan(percepts[1].colour).all()


def test_colour_and_temperature_are_those_of_the_vehicle():
    """A white car is brighter than a black one; the temperature is within the vehicle's."""
    seen = watch(
        lambda f: [(1, -20 + 0.5 * f, -3.0, 0.0, CAR), (4, 20 - 0.5 * f, 3.0, np.pi, CAR)], 20
    )

    percepts = seen[-1][1]
    black, white = np.argsort(percepts.position[:, 1])
    assert percepts.colour[white].mean() > percepts.colour[black].mean() + 50.0
    assert np.all((percepts.temperature > 15.0) & (percepts.temperature < 65.0))


def test_no_image_no_percepts():
    """Without any image nothing is seen, and nothing fails."""
    assert len(Pipeline(road().paved).perceive(0, None, None, CAMERA)) == 0


def test_an_empty_map_has_no_percepts():
    """Without roads nothing is looked for."""
    film = Film()
    pipeline = Pipeline(())

    for frame in range(5):
        colour, thermal = film.take([(1, 0.0, 0.0, 0.0, CAR)], CAMERA)
        assert len(pipeline.perceive(frame * FRAME, colour, thermal, CAMERA)) == 0


def test_a_change_of_light_everywhere_is_learned_at_once():
    """When most of the road looks unlike the background, the background begins anew."""
    film = Film()
    pipeline = Pipeline(film.ground.paved)
    for frame in range(10):
        colour, thermal = film.take([], CAMERA)
        if frame > 4:
            colour, thermal = colour + np.uint8(60), thermal + np.uint8(60)
        percepts = pipeline.perceive(frame * FRAME, colour, thermal, CAMERA)

        assert len(percepts) == 0


def test_the_road_mask_follows_the_map():
    """The mask holds the road with its margin and nothing else."""
    mask = road_mask(road().paved, CAMERA, margin=1.0)

    edge = CAMERA.image_from_ground(np.array([[0.0, 6.5], [0.0, 7.5]])).round().astype(int)
    assert mask[edge[0, 1], edge[0, 0]] == 255
    assert mask[edge[1, 1], edge[1, 0]] == 0
