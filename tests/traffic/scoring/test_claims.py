"""What recognitions say, in the words of the truth."""

import pytest

from traffic.results import car_names
from traffic.scoring.claims import claim_of, kinds_claimed


@pytest.mark.parametrize("form", ["", "_predicted"])
def test_turns_claim_a_way_through_a_crossing(form: str) -> None:
    """Observed and predicted turns claim the same: which way, and from where to where."""
    claim = claim_of(f"turn_left{form}")

    assert (claim.kind, claim.place) == ("turn_left", ("l1", "x", "l2"))


def test_other_chronicles_claim_what_they_are_called() -> None:
    """Of their cars, wherever that was."""
    claim = claim_of("overtake")

    assert (claim.kind, claim.place) == ("overtake", ())


def test_cars_are_told_by_the_names_of_arguments() -> None:
    """A `c` or `car`, with a number or without; nothing else that begins with a c."""
    arguments = dict.fromkeys(("c", "x", "c1", "car", "car22", "crossing", "carriageway"), "car1")

    assert car_names(arguments) == ("c", "c1", "car", "car22")


def test_each_kind_is_claimed_once() -> None:
    """However many chronicles claim it."""
    names = ("turn_left", "overtake", "turn_left_predicted")

    assert kinds_claimed(names) == ("turn_left", "overtake")
