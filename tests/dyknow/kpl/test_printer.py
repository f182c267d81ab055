"""Text and tree of a specification are inverses."""

from hypothesis import given, settings

from dyknow.kpl.parser import parse_specification
from dyknow.kpl.printer import text_from
from tests.support.specifications import specifications


@settings(derandomize=True, deadline=None, max_examples=150)
@given(specifications)
def test_printing_then_parsing_is_the_identity(specification):
    """A printed tree reads as the same tree, and prints as the same text again."""
    text = text_from(specification)

    parsed = parse_specification(text)

    assert parsed == specification
    assert text_from(parsed) == text


def test_a_text_is_printed_in_one_form():
    """Spaces, comments and the positional form of links leave no trace."""
    text = """
    strmgen b=link( a with sample every 1s , # every second
        U, true, false, eventually [0,oo) p(from),remove_after=1 min )
    """

    printed = text_from(parse_specification(text))

    assert printed == (
        "strmgen b = link(\n"
        "    a with sample every 1000,\n"
        "    U,\n"
        "    establish = true,\n"
        "    reestablish = false,\n"
        "    maintain = eventually p(from),\n"
        "    remove_after = 60000 ms)\n"
    )
