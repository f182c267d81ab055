"""Atoms over columns and over single states."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import FeatureError
from dyknow.mtl.columns import AtomColumns, evaluate_atoms
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.progression import ProgressionTable

FEATURES = {
    "on_road(from)": np.array([True, False, True]),
    "xydist(from, to)": np.array([1.0, 2.5, np.inf]),
    "speed[from]": np.array([3, 0, 7]),
    "colour(from)": np.array(["red", "blue", "red"]),
    "mode(from)": np.array(["a", "b", "a"], dtype=object),
    "from": np.array([1, 2, 3]),
    "to": np.array([1, 3, 3]),
}


def truth(text, features=FEATURES, **options):
    """The rows of the truth of a formula's atoms."""
    table = ProgressionTable(parse_formula(text))
    return evaluate_atoms(table, features, **options).tolist()


@pytest.mark.parametrize(
    ("atom", "expected"),
    [
        ("on_road(from)", [True, False, True]),
        ("xydist(from, to) < 2.5", [True, False, False]),
        ("xydist(from, to) <= 5 / 2", [True, True, False]),
        ("speed(from) * 2 + 1 > 7 - -1", [False, False, True]),
        ("speed[from] - 3 = 0", [True, False, False]),
        ('colour(from) != "red"', [False, True, False]),
        ('mode(from) = "a"', [True, False, True]),
        ("from = to", [True, False, True]),
        ("on_road(from) = false", [False, True, False]),
        ("1 < 2", [True, True, True]),
    ],
)
def test_an_atom_is_evaluated_for_all_rows(atom, expected):
    """Comparisons and arithmetic work on whole columns."""
    assert truth(atom) == [expected]


def test_atoms_stand_in_order_of_first_occurrence_and_once():
    """There is one row for each different atom."""
    rows = truth("always (on_road(from) -> speed(from) > 2 and on_road(from))")
    assert rows == [[True, False, True], [True, False, True]]


def test_a_formula_without_features_needs_the_number_of_rows():
    """`true` has no atoms, for any number of objects."""
    table = ProgressionTable(parse_formula("true"))
    assert evaluate_atoms(table, {}, n=4).shape == (0, 4)
    with pytest.raises(ValueError, match="expected the number of objects"):
        evaluate_atoms(table, {})


def test_masked_rows_are_false_and_not_looked_at():
    """A caller masks the rows whose features are NaN."""
    distance = {"xydist(from, to)": np.array([1.0, np.nan])}
    assert truth("xydist(from, to) < 3", distance, mask=np.array([True, False])) == [[True, False]]


@pytest.mark.parametrize(
    ("text", "features", "message"),
    [
        (
            "on_raod(from)",
            FEATURES,
            (
                r"feature 'on_raod\(from\)': expected a value in the state, "
                r"found none; did you mean 'on_road\(from\)'\?"
            ),
        ),
        ("speed(from)", FEATURES, "expected a boolean, found a column of int64"),
        ('speed(from) = "red"', FEATURES, "feature '\"red\"': expected a number, found 'red'"),
        ("colour(from) < 2", FEATURES, r"'colour\(from\)': expected a number, found a column of"),
        ("-on_road(from) < 2", FEATURES, r"'on_road\(from\)': expected a number"),
        ("1 / speed(from) < 2", FEATURES, r"'speed\(from\)': expected a divisor other than 0"),
        ("p", {"p": np.array([True]), "q": np.zeros(1)}, None),
        ("x < 2", {"x": np.array([1.0, np.nan])}, "feature 'x': expected a number, found NaN"),
        ("2 < x", {"x": np.array([1.0, np.nan])}, "feature 'x': expected a number, found NaN"),
        ("p", {"p": np.array([[True]])}, r"expected a column of 1 values, found shape \(1, 1\)"),
        ("x = x", {"x": np.array([1j])}, "expected a boolean, a number or a text"),
    ],
)
def test_what_is_unfit_is_named(text, features, message):
    """A missing feature, a wrong kind, NaN or a division by zero is an error with the name."""
    if message is None:
        assert truth(text, features) == [[True]]
        return
    with pytest.raises(FeatureError, match=message):
        truth(text, features)


@pytest.mark.parametrize(
    ("state", "message"),
    [
        ({"p": 1}, r"'p': expected a boolean, found 1 \(int\)"),
        ({"p": None}, r"'p': expected a boolean, a number or a text, found None"),
        ({}, "'p': expected a value in the state, found none"),
    ],
)
def test_a_single_state_is_held_to_the_same_rules(state, message):
    """Nothing is converted and nothing defaults."""
    with pytest.raises(FeatureError, match=message):
        AtomColumns(ProgressionTable(parse_formula("p")).atoms).of_state(state)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.tuples(st.booleans(), st.integers(-3, 3), st.floats(-3, 3)), min_size=1))
def test_columns_and_single_states_agree(rows):
    """A column is evaluated as each of its values alone."""
    text = "p and x < y and x + 1 >= 2 * y and x != 0 and p = true and speed(a) * y <= x"
    table = ProgressionTable(parse_formula(text))
    columns = {
        "p": np.array([p for p, _, _ in rows]),
        "x": np.array([x for _, x, _ in rows]),
        "y": np.array([y for _, _, y in rows]),
        "speed(a)": np.array([y - x for _, x, y in rows]),
    }

    whole = evaluate_atoms(table, columns)

    for at, (p, x, y) in enumerate(rows):
        state = {"p": p, "x": x, "y": y, "speed[a]": y - x}
        expected = sum(int(b) << i for i, b in enumerate(whole[:, at]))
        assert table.columns.of_state(state) == expected
