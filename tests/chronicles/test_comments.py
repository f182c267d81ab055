"""What people write about chronicles in comments."""

import pytest

from chronicles.comments import comment_of, heading_of
from chronicles.parser import parse_chronicles


@pytest.mark.parametrize(
    ("text", "heading", "comment"),
    [
        ("chronicle c { event(e, t) }", "", ""),
        ("# a\n#\n#  b\n\nchronicle c { event(e, t) }", "a\n\n b", ""),
        ("# a\nchronicle c { event(e, t) }", "a", "a"),
        ("\n// a\n\n## b\n  // c\n  chronicle c { event(e, t) }", "a", "b\nc"),
        ("message e # a\nchronicle c { event(e, t) }", "", ""),
        ("message e\n# a\nchronicle c { event(e, t) } # b", "", "a"),
        ("# a\n#\nmessage e chronicle c { event(e, t) }", "a", ""),
    ],
)
def test_comments_belong_to_what_follows(text: str, heading: str, comment: str) -> None:
    """The lines right before a chronicle are about it, those at the top about the file."""
    file = parse_chronicles(text)

    assert heading_of(file) == heading
    assert comment_of(file.chronicles[0]) == comment


def test_a_file_of_comments_has_a_heading() -> None:
    """Even if nothing else is there."""
    assert heading_of(parse_chronicles("# a")) == "a"
