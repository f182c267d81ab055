"""Bodies that are dragged by their front."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.sumo.bodies import Bodies

LENGTH = 10.0


def follow(path: np.ndarray, angle: float = 0.0, length: float = LENGTH) -> list[float]:
    """Return the headings of one body whose front takes *path*."""
    bodies = Bodies()
    return [
        float(
            bodies.headings(np.array([3]), point[None, :], np.array([angle]), np.array([length]))[
                0
            ]
        )
        for point in path
    ]


def test_a_standing_body_keeps_its_heading():
    """Without motion nothing turns, whatever the simulator says of the angle."""
    path = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 0.0]])

    assert np.allclose(follow(path), 0.0)


def test_a_body_points_where_a_long_straight_leads():
    """After several lengths along a straight the body has come into line."""
    along = np.arange(0.0, 80.0, 0.5)
    path = np.column_stack([np.zeros_like(along), along])

    assert abs(follow(path)[-1] - math.pi / 2) < 0.001


def test_on_a_circle_the_body_takes_the_angle_of_the_tractrix():
    """The rear axle ends on a circle of its own, inside that of the front."""
    radius, base = 20.0, 0.8 * LENGTH
    turn = np.arange(0.0, 8 * math.pi, 0.01)
    path = radius * np.column_stack([np.cos(turn), np.sin(turn)])
    motion = turn[-1] + math.pi / 2

    lag = (motion - follow(path, angle=math.pi / 2)[-1]) % (2 * math.pi)

    assert abs(lag - math.asin(base / radius)) < 0.01


def test_a_vehicle_that_was_put_elsewhere_begins_anew():
    """A jump of the front takes the simulator's angle again."""
    path = np.array([[0.0, 0.0], [0.5, 0.0], [200.0, 50.0]])

    assert follow(path, angle=1.0)[-1] == 1.0


STEPS = st.lists(st.tuples(st.floats(-0.6, 0.6), st.floats(0.0, 1.0)), min_size=1, max_size=60)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(STEPS, st.floats(2.0, 15.0))
def test_the_middle_never_moves_further_than_the_front(steps, length):
    """However the front wriggles, the body's middle does not jump."""
    heading = np.cumsum([turn for turn, _ in steps])
    size = np.array([distance for _, distance in steps])
    path = np.cumsum(np.column_stack([size * np.cos(heading), size * np.sin(heading)]), axis=0)

    turned = np.array(follow(path, angle=float(heading[0]), length=length))
    middle = path - length / 2 * np.column_stack([np.cos(turned), np.sin(turned)])

    moved = np.linalg.norm(np.diff(middle, axis=0), axis=1)
    assert (moved <= 2 * np.linalg.norm(np.diff(path, axis=0), axis=1) + 1e-9).all()


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.lists(STEPS, min_size=2, max_size=4))
def test_vehicles_do_not_disturb_each_other(drives):
    """Many bodies at once turn as each does alone."""
    n_frames = min(len(drive) for drive in drives)
    paths = [
        np.cumsum(
            [[d * math.cos(a), d * math.sin(a)] for a, d in drive[:n_frames]], axis=0
        ).reshape(-1, 2)
        for drive in drives
    ]
    bodies = Bodies()
    numbers = np.arange(len(paths)) * 100
    together = [
        bodies.headings(
            numbers,
            np.array([path[i] for path in paths]),
            np.zeros(len(paths)),
            np.full(len(paths), LENGTH),
        )
        for i in range(n_frames)
    ]

    alone = np.array([follow(path) for path in paths]).T
    assert np.allclose(np.array(together), alone)
