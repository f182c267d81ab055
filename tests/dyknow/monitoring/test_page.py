"""The page about formulas over streams, docs/stream-reasoning.md: its examples run."""

from pathlib import Path

from dyknow.kpl.check import faults_of_text
from dyknow.kpl.parser import parse_specification
from tests.support.pages import blocks_in

PAGE = Path("docs/stream-reasoning.md").read_text(encoding="utf-8")


def test_the_examples_of_the_page_say_what_the_page_says(capsys):
    """The first one prints what stands below it, and declares what stands below that."""
    scope = {}
    first, second = blocks_in(PAGE, "python")
    exec(first, scope)

    assert capsys.readouterr().out == blocks_in(PAGE, "text")[0]
    declared = scope["network"].specification.declarations[-4:]
    assert parse_specification(blocks_in(PAGE, "kpl")[0]).declarations == declared
    exec(second, scope)
    assert scope["monitor"].executing == ("lower_winch(uav1)",)
    assert "verdicts[lower_winch_1]" in scope["network"].outputs


def test_verdicts_are_selected_from_as_the_page_has_it():
    """The other declaration follows the language, too."""
    text = """
        source speed s
        strmgen speed[uav1] = s
        compunit verdict Evaluate(any)
        strmgen verdicts[winch_up] = Evaluate(speed[uav1])
    """
    assert faults_of_text(text + blocks_in(PAGE, "kpl")[1]) == []
