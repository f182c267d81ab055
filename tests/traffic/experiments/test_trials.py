"""What is tried of a design before anything runs."""

from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.experiments.designs import Design
from traffic.experiments.trials import MOST_NUMBERS, trials_of

LEVEL = st.one_of(
    st.integers(-500, 500), st.integers(-500, 500).map(lambda n: n / 8), st.booleans(), st.text()
)


def design(**values: object) -> Design:
    """Return a design with these values."""
    return Design.model_validate(
        {"name": "d", "folder": Path(), "scenario": "rural", "measures": ["turn.recall"], **values}
    )


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(LEVEL, min_size=1, max_size=30, unique_by=repr), st.integers(0, 400))
def test_every_level_occurs_and_the_outermost_numbers_are_tried_whole(
    levels: list[object], more: int
) -> None:
    """What is no number is tried whole as well, and of few numbers all are."""
    levels += [number for number in map(float, range(1000, 1000 + more)) if number not in levels]

    trials = list(trials_of(design(factors={"a": levels, "b": [1, 2]})))

    assert [trial.cell["a"] for trial in trials] == [*levels, levels[0]]
    assert [trial.cell["b"] for trial in trials] == [1] * len(levels) + [2]
    whole = [trial.cell["a"] for trial in trials if trial.is_whole]
    for kind in (bool, int, float, str):
        given_ = [each for each in levels if type(each) is kind]
        tried = [each for each in dict.fromkeys(whole) if type(each) is kind]
        if kind in (bool, str) or len(given_) <= MOST_NUMBERS:
            assert tried == given_
        else:
            assert MOST_NUMBERS <= len(tried) <= MOST_NUMBERS + 1
            assert {min(given_), max(given_)} <= set(tried)
            places = sorted(sorted(given_).index(each) for each in tried)
            assert max(b - a for a, b in pairwise(places)) <= len(given_) / (MOST_NUMBERS - 1) + 1


@pytest.mark.parametrize("more", [(), ("soon", "")])
def test_times_are_tried_as_numbers_are(more: tuple[str, ...]) -> None:
    """They are put in order by how long they are; other texts are all tried."""
    times = ["2 min", *(f"{number} ms" for number in range(1000, 1400)), "30 s", "9 us"]

    trials = list(trials_of(design(factors={"a": [*times, *more]})))

    assert [trial.cell["a"] for trial in trials] == [*times, *more]
    whole = {str(trial.cell["a"]) for trial in trials if trial.is_whole}
    assert {"2 min", "9 us", *more} <= whole
    assert len(whole) == MOST_NUMBERS + len(more)


def test_cells_that_are_listed_are_all_tried() -> None:
    """Whatever they say."""
    cells = [{"a": number} for number in range(300)]

    trials = list(trials_of(design(cells=cells)))

    assert [trial.cell for trial in trials] == cells
    assert all(trial.is_whole for trial in trials)
    assert trials[7].place == ("cells", 7)


def test_of_a_range_both_ends_are_tried() -> None:
    """The largest is the last step that is still within."""
    drawn = {"from": 0, "to": 10, "step": 3}

    trials = list(trials_of(design(factors={"a": drawn}, sampling={"cells": 5})))

    assert [trial.cell["a"] for trial in trials] == [0, 9]
