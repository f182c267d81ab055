"""Who is inside a footprint, and when."""

from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.time import TimePoint
from traffic.truth.visibility import Visibility, inside

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])


def test_points_lie_inside_or_outside_the_footprint() -> None:
    """A footprint is a polygon on the ground; without one everything is inside."""
    points = np.array([[5.0, 5.0], [11.0, 5.0], [-0.1, 0.0]])

    assert inside(points, SQUARE).tolist() == [True, False, False]
    assert inside(points, None).all()
    assert inside(np.empty((0, 2)), SQUARE).shape == (0,)


FRAMES = st.lists(st.lists(st.sampled_from("IO."), min_size=3, max_size=3), min_size=1, max_size=8)


def watched(frames: list[list[str]]) -> Visibility:
    """Return what is remembered of vehicles that are inside (I), outside (O) or nowhere (.)."""
    visibility = Visibility()
    for time, frame in enumerate(frames):
        ids = np.array([i for i, where in enumerate(frame) if where != "."], dtype=np.int64)
        in_view = np.array([frame[i] == "I" for i in ids], dtype=np.bool_)
        visibility.observe(TimePoint(time), ids, in_view=in_view)
    return visibility


def times_in(spans: list[tuple[int, int]]) -> list[int]:
    """Return the frames that the spans hold."""
    return [time for first, last in spans for time in range(first, last + 1)]


@given(FRAMES)
@settings(derandomize=True, deadline=None, max_examples=200)
def test_spans_hold_the_frames_in_which_a_vehicle_is_inside(frames: list[list[str]]) -> None:
    """Spans are as long as can be, and hold every frame inside and no other."""
    visibility = watched(frames)

    for vehicle in range(3):
        spans = visibility.spans(vehicle)
        assert times_in(spans) == [t for t, frame in enumerate(frames) if frame[vehicle] == "I"]
        assert all(last + 1 < first for (_, last), (first, _) in pairwise(spans))


@given(FRAMES)
@settings(derandomize=True, deadline=None, max_examples=200)
def test_common_spans_hold_the_frames_in_which_all_are_inside(frames: list[list[str]]) -> None:
    """Several vehicles are in view together when each of them is."""
    common = watched(frames).common_spans([0, 2])

    assert times_in(common) == [
        time for time, frame in enumerate(frames) if frame[0] == frame[2] == "I"
    ]


def test_a_vehicle_that_never_came_was_never_in_view() -> None:
    """Ids that no frame has held have no spans."""
    assert Visibility().spans(1000) == []
