"""The truth of atoms by a function, against the general way."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import FeatureError
from dyknow.mtl.columns import AtomColumns
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.progression import ProgressionTable

ATOMS = [
    "p",
    "x < 3",
    "x + y * 2 >= x / y",
    "-x != y",
    'colour(a) = "red"',
    "colour(a) != colour(b)",
    "p = true",
    "p = q",
    "x = y",
    "1 < 2",
    '"a" = "b"',
    "x - x = 0",
]
VALUES = st.one_of(
    st.booleans(),
    st.integers(-3, 3),
    st.sampled_from([0.5, -2.0, math.nan, math.inf, "red", "blue"]),
    st.sampled_from([np.float64(1.5), np.int64(2), np.True_, np.str_("red")]),
)
NAMES = ["p", "q", "x", "y", "colour(a)", "colour(b)"]


def outcome(compute):
    """What is computed, or the feature that is unfit for it."""
    try:
        return compute()
    except FeatureError as fault:
        return fault.feature


@settings(derandomize=True, deadline=None, max_examples=400)
@given(
    st.lists(st.sampled_from(ATOMS), min_size=1, max_size=4),
    st.lists(st.fixed_dictionaries({}, optional=dict.fromkeys(NAMES, VALUES)), max_size=4),
)
def test_the_usual_way_agrees_with_the_general_one(texts, states):
    """Each state has the truth, or the fault, that its columns of one value have."""
    atoms = ProgressionTable(parse_formula(" and ".join(f"({t})" for t in texts))).atoms
    columns = AtomColumns(atoms)
    for state in states:
        arrays = {name: np.array([value]) for name, value in state.items()}
        whole = outcome(lambda arrays=arrays: columns.of_features(arrays, 1)[:, 0].tolist())
        alone = outcome(lambda state=state: columns.of_state(state))
        if isinstance(whole, list):
            whole = sum(b << i for i, b in enumerate(whole))
        assert alone == whole


@pytest.mark.parametrize(
    ("text", "state", "message"),
    [
        ("x < 3", {"x": "fast"}, r"'x': expected a number, found 'fast' \(str\)"),
        ("x < 3", {"x": math.nan}, "'x': expected a number, found NaN"),
        ("x < 3", {"x": True}, "'x': expected a number, found True"),
        ("x - y < 3", {"x": math.inf, "y": math.inf}, "'x - y': expected a number, found NaN"),
        ("x / y < 3", {"x": 1, "y": 0}, "'y': expected a divisor other than 0, found 0"),
        ("x * 0.5 < 3", {"x": 10**400}, r"'x \* 0.5': expected a number of a size"),
        ("p", {"pq": True}, "'p': expected a value in the state, found none; did you mean 'pq'"),
        ("x = y", {"x": 1, "y": "one"}, "'y': expected a number, found 'one'"),
    ],
)
def test_what_is_unfit_is_named(text, state, message):
    """The function leaves faults to the general way, which names the feature."""
    table = ProgressionTable(parse_formula(text))
    with pytest.raises(FeatureError, match=message):
        table.columns.of_state(state)


def test_either_way_to_write_a_feature_is_found():
    """States may change from one notation to the other."""
    columns = ProgressionTable(parse_formula("speed(car1) < 3 and near(car1, car2)")).columns
    for _ in range(2):
        assert columns.of_state({"speed[car1]": 2, "near[car1, car2]": True}) == 3
        assert columns.of_state({"speed(car1)": 4, "near[car1, car2]": True}) == 2
        assert columns.of_state({"speed(car1)": 2, "near(car1, car2)": False}) == 1
