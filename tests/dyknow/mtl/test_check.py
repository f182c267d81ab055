"""Every fault of a formula, at once."""

import pytest

from dyknow.errors import SpecificationErrors
from dyknow.mtl import syntax
from dyknow.mtl.check import NUMBER, FeatureSignature, Vocabulary, check, faults
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.syntax import Interval
from dyknow.time import Duration

KNOWN = Vocabulary(
    features={
        "on_road": FeatureSignature(("world_object",)),
        "xydist": FeatureSignature(("world_object", "world_object"), NUMBER),
        "speed": FeatureSignature(("car",), NUMBER),
        "leader": FeatureSignature(("car",), "car"),
        "weather": FeatureSignature((), "text"),
        "stopped": FeatureSignature(()),
    },
    names={"from": "world_object", "to": "world_object", "car1": "car"},
    domains={"Car": "car"},
)


def messages(text, vocabulary=KNOWN):
    """The messages of all faults of a formula."""
    return [fault.message for fault in faults(parse_formula(text), vocabulary)]


@pytest.mark.parametrize(
    "text",
    [
        "eventually [0, 200] xydist(from, to) < 3 + -xydist(to, from)",
        "forall x in Car (speed(x) > 2 -> leader(x) = car1 or x != car1 or leader(x) != x)",
        'always (stopped and weather = "rain" <-> on_road(from) = false)',
        "true until [0, 5] not on_road(to)",
    ],
)
def test_a_right_formula_has_no_faults(text):
    """Names, numbers of arguments and sorts fit."""
    assert messages(text) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("on_raod(from)", "no feature called 'on_raod'; did you mean 'on_road'?"),
        ("zzz", "no feature called 'zzz'"),
        ("on_road(from, to)", "'on_road' takes 1 argument(s), found 2"),
        ("stopped(from)", "'stopped' takes 0 argument(s), found 1"),
        ("on_road(form)", "no variable or object called 'form'; did you mean 'from'?"),
        ("forall x in Cra (stopped)", "no domain called 'Cra'; did you mean 'Car'?"),
        ("on_road(car1)", "an argument of 'on_road' must be of sort 'world_object', found 'car'"),
        ("on_road(3)", "an argument of 'on_road' must be of sort 'world_object', found 'number'"),
        ("speed(car1)", "'speed(car1)' must be of sort 'boolean', found 'number'"),
        ("not from", "'from' must be of sort 'boolean', found 'world_object'"),
        ("speed(car1) = weather", "the right side of '=' must be of sort 'number', found 'text'"),
        ("weather < 3", "a side of '<' must be of sort 'number', found 'text'"),
        ("1 + stopped > 2", "a side of '+' must be of sort 'number', found 'boolean'"),
        ("always [5, 2] stopped", "expected an interval that ends after it begins, found [5, 2]"),
        ("speed(car1) / 0 < 2", "expected a divisor other than 0, found '0'"),
    ],
)
def test_each_fault_has_its_message(text, expected):
    """The fault says what was expected and what was found."""
    assert messages(text) == [expected]


def test_all_faults_are_reported_in_reading_order():
    """One check finds everything."""
    found = messages(
        "always [5, 2] on_raod(form) and forall x in Cars (on_road(y) or sped(x) < 1)"
    )

    assert found == [
        "expected an interval that ends after it begins, found [5, 2]",
        "no feature called 'on_raod'; did you mean 'on_road'?",
        "no variable or object called 'form'; did you mean 'from'?",
        "no domain called 'Cars'; did you mean 'Car'?",
        "no variable or object called 'y'",
        "no feature called 'sped'; did you mean 'speed'?",
    ]


def test_without_a_vocabulary_names_are_free():
    """Only what is wrong in any case is reported."""
    assert messages("unknown(thing) and other = some", None) == []


def test_check_raises_all_faults_together():
    """The group holds each fault with its place."""
    with pytest.raises(SpecificationErrors) as caught:
        check(parse_formula("always [5, 2] p and always [3, 1] p"))
    assert [fault.span.place for fault in caught.value.exceptions] == [
        "<formula>:1:8",
        "<formula>:1:28",
    ]


def test_an_interval_made_in_python_must_not_begin_before_now():
    """A negative bound has no text that is read; it is a fault where it can occur."""
    formula = syntax.Always(Interval(Duration(-1_000_000), None), syntax.Feature("p"))
    assert [f.message for f in faults(formula)] == [
        "expected an interval from 0 on, found [-1, oo]"
    ]


def test_a_formula_at_once_right_passes_silently():
    """Nothing is raised where nothing is wrong."""
    check(parse_formula("always p"))
