"""Settings that are changed without writing a specification anew."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.kpl.parser import parse_specification
from dyknow.kpl.printer import text_from
from traffic.errors import RequestError
from traffic.settings import change_from_text, changed_specification, parameters_in

TEXT = """
parameter period = 100
source number numbers
compunit number Sum(number, number)
strmgen a = numbers
strmgen b[x] = numbers
strmgen c = Sum(a with sample every period, b[x], start = 1, text = "one")
strmgen d[x] = Sum(c, c)
stream out = c
"""


def changed(**changes: object) -> str:
    """Return the declarations that a change makes different, printed."""
    before = parse_specification(TEXT)
    after = changed_specification(before, {k.replace("__", "/"): v for k, v in changes.items()})
    pairs = zip(before.declarations, after.declarations, strict=True)
    return "\n".join(text_from(new) for old, new in pairs if new != old)


def test_a_setting_of_a_process_is_replaced_or_added() -> None:
    """The other settings stay as they are, and nothing else changes."""
    one = changed(**{"c.start": 2})
    two = changed(**{"c.start": 2, "d[x].start": "3 s"})

    assert "start = 2" in one
    assert 'text = "one"' in one
    assert "start = 3" in two
    assert len(two.splitlines()) > len(one.splitlines())


def test_a_policy_is_replaced() -> None:
    """The policy of one input is another one then; that of the other input stays."""
    text = changed(**{"c/2": "sample every 20, use most recent"})

    assert "sample every period" in text
    assert "sample every 20" in text
    assert "most recent" in text


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("e.start", 1, "a label of the specification"),
        ("cc.start", 1, "perhaps 'c'"),
        ("a.start", 1, "made by no unit"),
        ("c/3", "any update", "an input that 'c' has"),
        ("c/1", "sample evry 3", "a policy"),
    ],
)
def test_what_is_not_there_cannot_be_changed(name: str, value: object, said: str) -> None:
    """The message says what was expected, with the nearest name."""
    with pytest.raises(RequestError, match=said):
        changed(**{name: value})


def test_parameters_are_told_apart() -> None:
    """A plain name is a parameter; there must be one of that name."""
    specification = parse_specification(TEXT)

    assert parameters_in({"period": 3, "c.start": 1}, specification) == {"period": 3}
    with pytest.raises(RequestError, match="perhaps 'period'"):
        parameters_in({"perod": 3}, specification)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.text(max_size=6), st.text(max_size=6))
def test_every_text_is_a_change_or_refused(name: str, value: str) -> None:
    """NAME=VALUE is read as written; without a name, a sign or a value it is refused."""
    text = f"{name}={value}"
    first, _, rest = text.partition("=")
    if first.strip() and rest.strip():
        found, _ = change_from_text(text)
        assert found == first.strip()
    else:
        with pytest.raises(RequestError, match="NAME=VALUE"):
            change_from_text(text)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-2.5", -2.5),
        ("1e3", 1000.0),
        ("true", True),
        ("nan", "nan"),
        ("1_0", "1_0"),
        ("3 s", "3 s"),
        ("a=b", "a=b"),
    ],
)
def test_values_are_numbers_truth_values_or_texts(text: str, value: object) -> None:
    """What is no plain number is a text, which the language of the setting reads."""
    assert change_from_text(f"x={text}") == ("x", value)
