"""Lengths, counts and links are told in words."""

import pytest

from traffic.explaining.explanation import Counted, FactEvent, LinkStep
from traffic.explaining.wording import (
    bounds_text,
    counted_text,
    end_text,
    event_text,
    length_text,
    time_text,
)


@pytest.mark.parametrize(
    ("milliseconds", "text"),
    [(0, "0"), (1, "1 ms"), (500, "500 ms"), (3100, "3.1 s"), (60_000, "1 min"),
     (90_000, "90 s"), (3_600_000, "1 h"), (1001, "1.001 s")],
)  # fmt: skip
def test_lengths_have_the_unit_that_people_would_take(milliseconds, text):
    """Whole minutes and hours are told as such, everything else in seconds or less."""
    assert length_text(milliseconds) == text


def test_times_are_seconds():
    """With as many digits as they need."""
    assert [time_text(each) for each in (0, 4900, 8401)] == ["0 s", "4.9 s", "8.401 s"]


def test_bounds_are_told_as_far_as_there_are_any():
    """One, both, the same, or none."""
    assert bounds_text(0, None) == "at least 0"
    assert bounds_text(None, 500) == "at most 500 ms"
    assert bounds_text(1000, 1000) == "exactly 1 s"
    assert bounds_text(None, None) == ""


@pytest.mark.parametrize(
    ("least", "most", "allowed"),
    [(0, 0, "none is allowed"), (1, None, "at least 1 asked for"), (2, 2, "exactly 2 asked for"),
     (1, 3, "1 to 3 asked for")],
)  # fmt: skip
def test_counts_are_told_with_what_was_allowed(least, most, allowed):
    """What was found, from when to when, and how much would have been right."""
    counted = Counted(
        text="occurs(…)", attribute="a", arguments=[], begin=0, end=1500, least=least, most=most,
        count=0, holds=least == 0, events=[],
    )  # fmt: skip

    assert counted_text(counted) == f"occurs(…): none from 0 s up to 1.5 s, {allowed}"


def test_unknown_values_are_called_so():
    """A message has no values."""
    change = FactEvent(time=0, attribute="p", arguments=["x"], before=None, after="true")
    message = FactEvent(time=0, attribute="m", arguments=[], before=None, after=None)

    assert event_text(change) == "p[x]: unknown → true"
    assert event_text(message) == "m"


def test_a_violated_link_names_its_condition():
    """The others say what happened to their objects."""
    link = LinkStep(
        stream="cars", upper="car1", lower="on_road_object1", begin=0, made_by="establish",
        condition="true", end=5, ended_by="violated", end_condition="on_road(from)",
    )  # fmt: skip

    assert end_text(link) == "its maintain condition became false: on_road(from)"
    assert "vanished" in end_text(link.model_copy(update={"ended_by": "vanished"}))
