"""Places in texts."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.source_text import SourceText, Span, did_you_mean, nearest_are, nearest_name


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.text(alphabet="ab\n", max_size=30), st.data())
def test_a_place_counts_lines_and_columns_from_1(text, data):
    """Line and column agree with counting the line ends before the offset."""
    offset = data.draw(st.integers(min_value=0, max_value=len(text)))

    line, column = SourceText("t", text).place(offset)

    before = text[:offset]
    assert line == before.count("\n") + 1
    assert column == len(before.rpartition("\n")[2]) + 1


def test_an_excerpt_shows_the_line_and_carets_under_the_stretch():
    """Tabs are kept, so that the carets stand under what they mean."""
    source = SourceText("speed.kpl", "source a b\n\tstream = 3")
    span = Span(source, 12, 18)

    assert span.place == "speed.kpl:2:2"
    assert span.excerpt() == "\tstream = 3\n\t^^^^^^"


def test_a_stretch_over_several_lines_is_underlined_on_its_first():
    """Carets end with the line, and there is at least one."""
    source = SourceText("t", "ab\ncd")

    assert Span(source, 1, 5).excerpt() == "ab\n ^"
    assert Span(source, 2, 2).excerpt() == "ab\n  ^"


def test_the_nearest_name_is_the_one_probably_meant():
    """A close name is offered, and none if none is close."""
    assert nearest_name("spede", ["speed", "position"]) == "speed"
    assert nearest_name("colour", ["speed", "position"]) is None


def test_what_is_near_is_told_behind_a_message():
    """Nothing is if nothing is near."""
    assert did_you_mean(None) == ""
    assert did_you_mean("cars") == "; did you mean 'cars'?"
    assert nearest_are([]) == ""
    assert nearest_are(["cars"]) == "; nearest is 'cars'"
    assert nearest_are(["cars", "car's"]) == "; nearest are 'cars', 'car's'"
