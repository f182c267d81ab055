"""The reference of the language, docs/kpl.md: every example on it is right."""

import re
from pathlib import Path

import pytest

from dyknow.kpl.check import faults_of_text
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.printer import text_from

PAGE = Path("docs/kpl.md").read_text(encoding="utf-8")
PREAMBLE, *EXAMPLES = re.findall(r"^```kpl\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
RESERVED = "approximation|change|compunit|delay"


@pytest.mark.parametrize("example", EXAMPLES)
def test_an_example_has_no_faults(example):
    """Together with what the page takes for granted, it parses and passes all checks."""
    text = PREAMBLE + _without_what_is_declared_again(example)

    assert [fault.report() for fault in faults_of_text(text, "docs/kpl.md")] == []
    assert parse_specification(text_from(parse_specification(text))) == parse_specification(text)


def test_the_page_names_every_reserved_word():
    """The list of words that are never names is that of the grammar."""
    grammar = Path("dyknow/kpl/grammar.lark").read_text(encoding="utf-8")
    reserved = re.search(r"NAME: /\(\?!\(\?:([a-z|]+)\)", grammar)[1].split("|")
    listed = PAGE.partition("never names:")[2].partition("All others")[0]

    assert re.findall(r"`(\w+)`", listed) == sorted(reserved)


def test_the_page_shows_every_constraint():
    """Each rule of the grammar for a constraint has its keywords on the page."""
    grammar = Path("dyknow/kpl/grammar.lark").read_text(encoding="utf-8")
    rules = grammar.partition("_constraint: ")[2].partition("\n\n")[0]
    for rule in re.findall(r"\w+", rules):
        body = re.search(rf"^{rule}: (.*)$", grammar, re.MULTILINE)[1]
        first_words = " ".join(re.findall(r'^(?:"\w+" ?)+', body)[0].replace('"', "").split())
        assert re.search(rf"`{first_words}\b", PAGE), rule


def _without_what_is_declared_again(example):
    return example
