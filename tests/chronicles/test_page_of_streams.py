"""The page about chronicles in streams, docs/chronicles-in-streams.md: its examples run."""

from pathlib import Path

from dyknow.kpl.check import faults_of_text
from dyknow.kpl.parser import parse_specification
from tests.support.pages import blocks_in

PAGE = Path("docs/chronicles-in-streams.md").read_text(encoding="utf-8")
BUNDLED = Path("data/specifications/monitoring.kpl").read_text(encoding="utf-8")
PRELUDE = """
source cars cars
source events link_turns
strmgen cars = cars
strmgen car_attributes = cars
strmgen link_turns = link_turns
"""


def test_the_examples_of_the_page_say_what_the_page_says(capsys):
    """The first one prints what stands below it, and declares what stands below that."""
    scope = {}
    first, second = blocks_in(PAGE, "python")
    exec(first, scope)

    assert capsys.readouterr().out == blocks_in(PAGE, "text")[0]
    declared = scope["network"].specification.declarations[-6:]
    assert parse_specification(blocks_in(PAGE, "kpl")[0]).declarations == declared
    exec(second, scope)
    assert list(scope["reasoner"].chronicles) == ["race", "hurry"]


def test_the_declarations_of_the_page_follow_the_language():
    """Put together they make a specification without faults."""
    _, *declared, _ = blocks_in(PAGE, "kpl")
    assert faults_of_text(PRELUDE + "".join(declared)) == []


def test_the_link_of_the_page_is_the_one_of_the_application():
    """Reckless drivers are declared as the page has it."""
    (link,) = parse_specification(blocks_in(PAGE, "kpl")[-1]).declarations
    assert link in parse_specification(BUNDLED).declarations
