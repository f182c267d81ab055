"""Who is inside a footprint, and since when."""

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


@given(st.lists(st.lists(st.sampled_from("IO."), min_size=3, max_size=3), min_size=1, max_size=8))
@settings(derandomize=True, deadline=None, max_examples=200)
def test_visibility_counts_from_the_last_break(frames: list[list[str]]) -> None:
    """A vehicle is in view since the frame after that in which it was last outside or absent."""
    visibility = Visibility()
    for time, frame in enumerate(frames):
        ids = np.array([i for i, where in enumerate(frame) if where != "."], dtype=np.int64)
        in_view = np.array([frame[i] == "I" for i in ids], dtype=np.bool_)
        visibility.observe(TimePoint(time), ids, in_view=in_view)

    for vehicle in range(3):
        history = [frame[vehicle] for frame in frames]
        breaks = [time for time, where in enumerate(history) if where != "I"]
        since = max(breaks, default=-1) + 1
        assert visibility.since(vehicle) == (since if since < len(frames) else None)


def test_a_vehicle_that_never_came_is_not_in_view() -> None:
    """Ids that no frame has held are unknown, which is not in view."""
    assert Visibility().since(1000) is None
