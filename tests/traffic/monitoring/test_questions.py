"""A question is a formula without faults, over domains that it uses."""

import pytest

from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.mtl.printer import text_from_formula
from traffic.errors import RequestError
from traffic.monitoring.questions import domains_from, forbid_missing, read_question


def test_a_formula_may_be_text_or_a_file(tmp_path):
    """What is the name of a file is read from there."""
    path = tmp_path / "f.mtl"
    path.write_text("always p # as ever")

    assert text_from_formula(read_question(str(path), {}).formula) == "always p"
    assert text_from_formula(read_question("always p", {}).formula) == "always p"


@pytest.mark.parametrize("text", ["p\0", "p or " * 2_000 + "p", "p\n and q", "x" * 300 + " > 1"])
def test_formulas_that_are_no_names_of_files(text):
    """Nothing that a formula may be is taken for a file by mistake, or fails as one."""
    if "\0" in text:
        with pytest.raises(SpecificationError):
            read_question(text, {})
    else:
        assert read_question(text, {})


def test_files_that_cannot_be_read(tmp_path):
    """A missing file, and one that is no text, are told."""
    (tmp_path / "f.mtl").write_bytes(b"\xff")

    with pytest.raises(FileNotFoundError):
        read_question(str(tmp_path / "missing.mtl"), {})
    with pytest.raises(RequestError, match="FORMULA: expected a text in UTF-8"):
        read_question(str(tmp_path / "f.mtl"), {})


def test_quantifiers_are_written_out():
    """Features are those of the objects of the domains."""
    question = read_question("always forall x in car speed[x] < 30", {"car": ("car1", "car2")})

    assert text_from_formula(question.formula) == (
        "always (speed(car1) < 30 and speed(car2) < 30)"
    )
    assert list(question.sorts) == ["speed(car1)", "speed(car2)"]


@pytest.mark.parametrize(
    ("text", "sorts"),
    [
        ("p -> not q", {"p": "boolean", "q": "boolean"}),
        ("x < 1 or -y = z + 1", {"x": "number", "y": "number", "z": "number"}),
        ('name != "a" and p = true', {"name": "text", "p": "boolean"}),
        ("x = y", {"x": None, "y": None}),
        ("x = y and x > 3", {"x": "number", "y": None}),
        ("true until p", {"p": "boolean"}),
    ],
)
def test_the_use_of_a_feature_tells_its_sort(text, sorts):
    """As far as the formula says."""
    assert read_question(text, {}).sorts == sorts


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        ("always [2, 1] p and forall x in cars q(x) and exists y in buses r(y)",
         ["1:8: expected an interval", "1:33: no domain called 'cars'; did you mean 'car'?",
          "1:59: no domain called 'buses'"]),
        ("x and x > 3 and x = \"a\"", ["1:7: 'x' must be of sort 'boolean', found 'number'",
                                       "1:17: 'x' must be of sort 'boolean', found 'text'"]),
    ],
)  # fmt: skip
def test_all_faults_of_a_formula_are_told_at_once(text, messages):
    """Each with its place."""
    with pytest.raises(SpecificationErrors) as raised:
        read_question(text, {"car": ("a",)} if "forall" in text else {})

    reports = [fault.report() for fault in raised.value.exceptions]
    assert len(reports) == len(messages)
    for report, message in zip(reports, messages, strict=True):
        assert report.startswith(f"<formula>:{message}")
        assert "^" in report


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["car"], "--domain: expected a domain such as 'car=car1,car2', found 'car'"),
        (["=a"], "--domain: expected a domain such as"),
        (["car="], "--domain: expected names of objects after 'car=', found 'car='"),
        (["car=a,,b"], "--domain: expected names of objects after 'car='"),
        (["car=a,b,a"], "--domain: expected each object once"),
        (["car=a", "car=b"], "--domain: expected the domain 'car' once"),
    ],
)
def test_domains_are_whole(texts, message):
    """A domain has a name and objects, each once; none is empty."""
    with pytest.raises(RequestError, match=message):
        domains_from(texts)


def test_domains_are_read():
    """Spaces make no difference."""
    assert domains_from(["car=a, b", "bus = c"]) == {"car": ("a", "b"), "bus": ("c",)}


@pytest.mark.parametrize("text", ["p", "forall x in bus q(x)"])
def test_a_domain_without_effect_is_refused(text):
    """Whoever gives a domain means the formula to use it."""
    with pytest.raises(RequestError, match="expected a domain of the formula"):
        read_question(text, {"car": ("a",), "bus": ("b",)})


DECLARED = """
sort car = car1, car2
sort bus
feature lane(car): text
feature at(car): car
always forall x in car forall y in car (lane(x) = lane(y) and at(x) = at(y))
"""


def test_declarations_are_obeyed():
    """Declared objects need not be given, and declared sorts need not be guessed."""
    question = read_question(DECLARED, {})

    assert question.sorts == {
        "lane(car1)": "text", "at(car1)": "text", "lane(car2)": "text", "at(car2)": "text",
    }  # fmt: skip
    with pytest.raises(RequestError, match="expected a domain without declared objects"):
        read_question(DECLARED, {"car": ("car3",)})


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("exists x in bus true", "no domain called 'bus'"),
        ("exists x in tram true", "no domain called 'tram'"),
        ('forall x in car lanes(x) = "a"', "no feature called 'lanes'; did you mean 'lane'?"),
        ("lane(car1)", "must be of sort 'boolean', found 'text'"),
    ],
)
def test_declarations_are_held_against_the_formula(formula, message):
    """What is not declared is a fault, told once."""
    declarations = DECLARED[: DECLARED.index("always")]

    with pytest.raises(SpecificationErrors) as raised:
        read_question(declarations + formula, {})

    (fault,) = raised.value.exceptions
    assert message in str(fault)


def test_missing_features_are_told_once_for_each_place():
    """Every place of the formula that needs a feature which is not there, and the nearest name."""
    domain = {"car": tuple(f"car{n}" for n in range(50))}
    question = read_question("p and forall x in car speed(x) < brake", domain)

    with pytest.raises(SpecificationErrors) as raised:
        forbid_missing(question, ["p", "speed(car0)", "brakes"], "f:1")

    one, other = raised.value.exceptions
    assert "the state at f:1 has no feature 'speed(car" in str(one)
    assert str(other) == "the state at f:1 has no feature 'brake'; did you mean 'brakes'?"
