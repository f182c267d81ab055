"""What scenario files may say of those who follow."""

import pytest
from pydantic import ValidationError

from dyknow.time import MILLISECOND, SECOND
from traffic.scenarios.acts.following import CloseUp, Column, Tail, Tailgate

FILE = {"folder": None}
COMMON = {"types": {"car": 1}, "route": ("a",), "rate_per_hour": 60}


def test_time_gaps_are_durations() -> None:
    """They are read as people write durations, one or a range."""
    act = Tailgate.model_validate(
        {"kind": "tailgate", "speed": 10, "time_gap": ["0.3 s", "0.5 s"], **COMMON}, context=FILE
    )

    assert act.time_gap == (300 * MILLISECOND, 500 * MILLISECOND)


def test_nobody_drives_without_a_time_gap() -> None:
    """A gap of nothing is a fault."""
    with pytest.raises(ValidationError, match="above 0"):
        Tailgate(kind="tailgate", speed=(10, 10), time_gap=(0, SECOND), **COMMON)


@pytest.mark.parametrize("number", [(1, 3), (4, 3), (3, 51)])
def test_a_column_has_two_vehicles_or_more(number: tuple[int, int]) -> None:
    """The fewest stand first, and there is a limit."""
    with pytest.raises(ValidationError):
        Column(kind="column", speed=(9, 9), number=number, time_gap=(SECOND, SECOND), **COMMON)


def test_the_route_of_a_tail_is_known() -> None:
    """Roads that do not exist are found on either route."""
    lag = (SECOND, SECOND)
    same, other = (Tail(kind="tail", lag=lag, tail_route=r, **COMMON) for r in (None, ("b",)))

    assert same.routes == {"route": ("a",)}
    assert other.routes == {"route": ("a",), "tail_route": ("b",)}


def test_a_moment_and_a_pause_may_be_ranges() -> None:
    """Whoever comes close for a moment has a distance to fall back to."""
    act = CloseUp(
        kind="close_up", speed=(10, 10), distance=(2 * SECOND, 2 * SECOND),
        time_gap=(SECOND, SECOND), moment=(0, SECOND), pause=(SECOND, SECOND), **COMMON,
    )  # fmt: skip

    assert act.casts == {"types": {"car": 1}}
