"""Chronicle files and their exact messages, in tests/languages/chronicles."""

from pathlib import Path

import pytest

from chronicles.check import check
from chronicles.parser import parse_chronicles
from chronicles.printer import print_chronicles
from dyknow.errors import SpecificationErrors

FOLDER = Path(__file__).parents[1] / "languages" / "chronicles"
LIBRARY = Path(__file__).parents[2] / "data" / "chronicles"


def messages(path: Path) -> str:
    """Return what a person is told about a file."""
    try:
        check(parse_chronicles(path.read_text(encoding="utf-8"), path.name))
    except SpecificationErrors as errors:
        return "".join(f"{error.report()}\n" for error in errors.exceptions)
    return ""


@pytest.mark.parametrize(
    "path",
    sorted([*FOLDER.glob("*.ok"), *LIBRARY.glob("*.chronicle")]),
    ids=lambda path: path.name,
)
def test_good_files_have_no_faults_and_survive_printing(path: Path) -> None:
    """A good file is accepted, and printing and parsing it changes nothing."""
    file = parse_chronicles(path.read_text(encoding="utf-8"), path.name)

    assert messages(path) == ""
    assert parse_chronicles(print_chronicles(file)) == file


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.bad")), ids=lambda path: path.stem)
def test_bad_files_are_told_why(path: Path) -> None:
    """Each bad file gets exactly the messages of the `.err` file beside it."""
    assert messages(path) == path.with_suffix(".err").read_text(encoding="utf-8")
