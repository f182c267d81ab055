"""Designs: which runs they consist of."""

from pathlib import Path
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.experiments.cases import cases_of
from traffic.experiments.designs import Design

_SOME: dict[str, Any] = {
    "name": "d",
    "folder": Path(),
    "scenario": "rural",
    "measures": ["overtake.recall"],
}

levels = st.lists(st.integers(0, 9), min_size=1, max_size=3, unique=True)
factors = st.dictionaries(st.sampled_from("abcd"), levels, max_size=3)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(factors, st.integers(1, 3), st.integers(0, 5))
def test_all_combinations_are_run_with_all_seeds(
    given_factors: dict[str, list[int]], runs: int, first: int
) -> None:
    """Nested loops over factors and seeds give the same cases, each with a key of its own."""
    design = Design(**_SOME, factors=given_factors, runs_per_cell=runs, first_seed=first)
    naive: list[dict[str, int]] = [{}]
    for name, given_levels in given_factors.items():
        naive = [{**cell, name: level} for cell in naive for level in given_levels]

    cases = list(cases_of(design))

    assert [dict(case.settings) for case in cases] == [c for c in naive for _ in range(runs)]
    assert [case.seed for case in cases] == list(range(first, first + runs)) * len(naive)
    assert len({case.key for case in cases}) == design.n_runs == len(cases)


def test_cells_can_be_drawn_at_random() -> None:
    """Levels of a list, numbers of a range, and steps of a range; the same for the same seed."""
    sampled = {
        **_SOME,
        "sampling": {"cells": 50, "seed": 3},
        "factors": {
            "a": [1, 2],
            "b": {"from": 0, "to": 1},
            "c": {"from": 0, "to": 1, "step": 0.5},
        },
    }
    cells = list(Design(**sampled).combinations())

    assert cells == list(Design(**sampled).combinations())
    assert {cell["a"] for cell in cells} == {1, 2}
    assert all(0 <= float(cell["b"]) <= 1 for cell in cells)
    assert {cell["c"] for cell in cells} == {0, 0.5, 1}


def test_the_key_of_a_case_depends_on_its_settings_alone() -> None:
    """Neither where the design lies nor the order of its settings changes a key."""
    one = Design(**_SOME, fixed={"view": "truth", "duration": "1 s"})
    moved = Design(**{**_SOME, "folder": Path("/")}, fixed={"duration": "1 s", "view": "truth"})
    other = Design(**_SOME, fixed={"view": "truth", "duration": "2 s"})

    (key,), (same,), (changed,) = ([c.key for c in cases_of(d)] for d in (one, moved, other))

    assert key == same != changed
