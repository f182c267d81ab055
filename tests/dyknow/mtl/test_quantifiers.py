"""Quantifiers over fixed domains."""

import pytest

from dyknow.errors import UnknownNameError
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.quantifiers import expand

CARS = {"Car": ("car1", "car2"), "UAV": ("uav1",), "Ship": ()}


@pytest.mark.parametrize(
    ("text", "expanded"),
    [
        ("forall x in Car (speed(x) < 3)", "speed(car1) < 3 and speed(car2) < 3"),
        ("exists x in Car always p(x)", "always p(car1) or always p(car2)"),
        ("forall x in UAV (p(x, y))", "p(uav1, y)"),
        ("forall x in Ship (p(x))", "true"),
        ("exists x in Ship (p(x))", "false"),
        (
            "always forall x in Car exists y in Car (not x = y and near(x, y))",
            (
                'always ((not "car1" = "car1" and near(car1, car1) or '
                'not "car1" = "car2" and near(car1, car2)) and '
                '(not "car2" = "car1" and near(car2, car1) or '
                'not "car2" = "car2" and near(car2, car2)))'
            ),
        ),
        (
            "forall x in UAV (p(x) until (-f(x) + x < 2 -> (p(x) <-> true)))",
            'p(uav1) until (-f(uav1) + "uav1" < 2 -> (p(uav1) <-> true))',
        ),
        ("p or exists x in Car q(x, 1)", "p or (q(car1, 1) or q(car2, 1))"),
        ("eventually exists x in UAV (p(x) and q)", "eventually (p(uav1) and q)"),
    ],
)
def test_a_quantifier_stands_for_each_of_its_objects(text, expanded):
    """The body is repeated for each object; an inner variable hides an outer one."""
    formula = expand(parse_formula(text), CARS)
    assert formula == parse_formula(expanded)


def test_a_domain_must_be_given():
    """A quantifier over an unknown domain is refused, with the nearest one."""
    with pytest.raises(UnknownNameError, match="no domain called 'Cra'; did you mean 'Car'"):
        expand(parse_formula("forall x in Cra (p(x))"), CARS)
