"""Declarations of sorts, objects and features before a formula."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import FormulaSyntaxError, SpecificationErrors
from dyknow.mtl import syntax
from dyknow.mtl.check import FeatureSignature, Vocabulary
from dyknow.mtl.declarations import document_faults, domains_of, read_document, vocabulary_of
from dyknow.mtl.parser import parse_document, parse_formula
from dyknow.mtl.printer import text_from_document
from tests.dyknow.mtl.formulas import any_formulas

TEXT = """
sort Car = car1, car2   # those that are in view
sort Lane
object from, to: Car
feature speed(Car): number
feature on(Car, Lane): boolean
feature weather: text

always forall c in Car (speed(c) < 30 or weather = "dry")
"""


def test_declarations_give_a_vocabulary_and_domains():
    """A sort is a domain; its objects and others have a sort; features have signatures."""
    document = read_document(TEXT)

    assert document.formula == parse_formula(TEXT.splitlines()[-1])
    assert vocabulary_of(document) == Vocabulary(
        {
            "speed": FeatureSignature(("Car",), "number"),
            "on": FeatureSignature(("Car", "Lane"), "boolean"),
            "weather": FeatureSignature((), "text"),
        },
        {"car1": "Car", "car2": "Car", "from": "Car", "to": "Car"},
        {"Car": "Car", "Lane": "Lane"},
    )
    assert domains_of(document) == {"Car": ("car1", "car2")}


def test_without_declarations_names_are_free():
    """A formula alone is a document too."""
    document = read_document("always (unknown(thing) < 3)")

    assert document.formula == parse_formula("always (unknown(thing) < 3)")
    assert vocabulary_of(document) is None
    assert domains_of(document) == {}


def test_words_of_declarations_are_names_in_formulas():
    """Where a formula is expected, `sort` and `feature` are features like any other."""
    assert parse_formula("sort and feature(object)") == syntax.Conjunction(
        (syntax.Feature("sort"), syntax.Feature("feature", (syntax.Name("object"),)))
    )


def test_all_faults_are_reported_in_reading_order():
    """Those of the declarations and those of the formula, each with its place."""
    text = (
        "sort Car = car1\nsort Car\nfeature speed(Cra): nubmer\nfeature speed(Car): number\n"
        'object car1: Car\nalways forall c in Crs (sped(c, d) < "x" and always [5, 1] ready)'
    )
    with pytest.raises(SpecificationErrors) as caught:
        read_document(text, "f.mtl")

    assert [(f.span.place, f.message) for f in caught.value.exceptions] == [
        ("f.mtl:2:6", "sort 'Car' is already declared at f.mtl:1:6"),
        ("f.mtl:3:15", "no sort called 'Cra'; did you mean 'Car'?"),
        ("f.mtl:3:21", "no sort called 'nubmer'; did you mean 'number'?"),
        ("f.mtl:4:9", "feature 'speed' is already declared at f.mtl:3:9"),
        ("f.mtl:5:8", "object 'car1' is already declared at f.mtl:1:12"),
        ("f.mtl:6:20", "no domain called 'Crs'; did you mean 'Car'?"),
        ("f.mtl:6:25", "no feature called 'sped'; did you mean 'speed'?"),
        ("f.mtl:6:33", "no variable or object called 'd'"),
        ("f.mtl:6:38", "a side of '<' must be of sort 'number', found 'text'"),
        ("f.mtl:6:53", "expected an interval that ends after it begins, found [5, 1]"),
        ("f.mtl:6:60", "no feature called 'ready'"),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sort", "expected a name, found the end"),
        ("feature speed p", "expected ':', found 'p'"),
        ("object a b: Car p", "expected ',' or ':', found 'b'"),
        ("sort Car = car1", "expected a formula or ',', found the end"),
        ("feature p: boolean", "expected a formula, found the end"),
    ],
)
def test_what_does_not_follow_the_grammar_is_refused(text, message):
    """The message says what was expected."""
    with pytest.raises(FormulaSyntaxError) as caught:
        parse_document(text)
    assert caught.value.message == message


NAMES = st.builds(syntax.Name, st.sampled_from(["car", "Car", "sort", "speed", "number", "x1"]))
MANY = st.lists(NAMES, max_size=3).map(tuple)
DECLARATIONS = (
    st.builds(syntax.SortDeclaration, NAMES, MANY)
    | st.builds(syntax.ObjectDeclaration, st.lists(NAMES, min_size=1).map(tuple), NAMES)
    | st.builds(syntax.FeatureDeclaration, NAMES, MANY, NAMES)
)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.builds(syntax.Document, st.lists(DECLARATIONS, max_size=4).map(tuple), any_formulas()))
def test_printing_and_parsing_are_inverse(document):
    """Every document is read back from its text as it was, and can be checked."""
    text = text_from_document(document)
    assert parse_document(text) == document
    document_faults(document)
