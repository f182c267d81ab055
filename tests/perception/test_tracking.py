"""Tracks from frame to frame."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.tracking import Tracker, TrackingSettings
from tests.perception.sightings import sightings

FRAME = 40_000_000


def follow(frames, settings_=None):
    """Show a tracker one list of rows for each frame; return ids by sighting for each frame."""
    tracker = Tracker(settings_)
    answers = []
    for number, rows in enumerate(frames):
        tracker.predict(number * FRAME)
        seen, rows_seen = tracker.update(sightings(*rows), np.zeros(len(rows), dtype=bool))
        answers.append(dict(zip(rows_seen.tolist(), seen.ids.tolist(), strict=True)))
    return answers


def car(x, y=0.0):
    """Return the row of a car."""
    return (x, y, 0.0, 5.0, 1.8)


def test_a_track_counts_after_three_sightings():
    """The first two frames give nothing, the third gives an id that stays."""
    answers = follow([[car(0.5 * f)] for f in range(6)])

    assert answers == [{}, {}, {0: 1}, {0: 1}, {0: 1}, {0: 1}]


def test_a_short_gap_is_bridged_and_a_long_one_is_not():
    """The id survives 0.28 s without a sighting; after half a second there is a new one."""
    short = [[car(0.5 * f)] if not 10 <= f < 17 else [] for f in range(30)]
    long = [[car(0.5 * f)] if not 10 <= f < 23 else [] for f in range(40)]

    assert follow(short)[-1] == {0: 1}
    assert follow(long)[-1] == {0: 2}


def test_nothing_is_reported_while_nothing_is_seen():
    """During a gap the track is not in the answer: perception does not predict for others."""
    frames = [[car(0.5 * f)] if f < 10 else [] for f in range(14)]

    assert follow(frames)[10:] == [{}, {}, {}, {}]


def test_a_blob_of_one_frame_never_counts():
    """Noise that is seen now and then has no id."""
    answers = follow([[car(0.0)] if f % 4 == 0 else [] for f in range(20)])

    assert all(answer == {} for answer in answers)


def test_a_piece_on_a_followed_vehicle_starts_no_track():
    """A second blob within the vehicle's outline is taken for a part of it."""
    frames = [[car(0.5 * f)] for f in range(8)]
    frames += [[car(0.5 * f), (0.5 * f + 1.5, 0.2, 0, 1.0, 0.8)] for f in range(8, 20)]

    assert follow(frames)[-1] == {0: 1}


def test_the_velocity_is_found():
    """After a second the filtered velocity is that of the motion, the heading too."""
    tracker = Tracker()
    for number in range(30):
        tracker.predict(number * FRAME)
        tracks, _ = tracker.update(
            sightings((0.0, 0.4 * number, 0.0, 5.0, 1.8)), np.zeros(1, dtype=bool)
        )

    np.testing.assert_allclose(tracks.states[0, 2:], [0.0, 10.0], atol=0.1)
    np.testing.assert_allclose(tracks.heading, [np.pi / 2], atol=0.05)


def test_sizes_are_running_means_that_parts_do_not_touch():
    """A part cut from a larger blob leaves length and width as they were."""
    tracker = Tracker(TrackingSettings(hits_to_count=1))
    for is_part, length in ((False, 5.0), (True, 9.0)):
        tracker.predict(0 if not is_part else FRAME)
        tracks, _ = tracker.update(sightings((0, 0, 0, length, 1.8)), np.array([is_part]))

    np.testing.assert_allclose(tracks.length, [5.0])


@settings(derandomize=True, deadline=None, max_examples=25)
@given(st.integers(0, 2**32 - 1), st.integers(1, 8))
def test_ids_do_not_depend_on_the_order_of_sightings(seed, count):
    """Cars in lanes 3.2 m apart keep one id each, however the sightings are shuffled."""
    generator = np.random.default_rng(seed)
    speeds = generator.uniform(0.0, 0.8, count)
    ids_by_car = [set() for _ in range(count)]
    tracker = Tracker()
    for number in range(25):
        order = generator.permutation(count)
        rows = [car(speeds[c] * number + generator.normal(0, 0.05), 3.2 * c) for c in order]
        tracker.predict(number * FRAME)
        tracks, seen = tracker.update(sightings(*rows), np.zeros(count, dtype=bool))
        for track, row in zip(tracks.ids.tolist(), seen.tolist(), strict=True):
            ids_by_car[order[row]].add(track)

    assert all(len(ids) == 1 for ids in ids_by_car)
    assert len(set.union(*ids_by_car)) == count
