"""The library of chronicles."""

import json
import sys
from pathlib import Path

import pytest

from traffic.__main__ import main
from traffic.bundled import data_folder
from traffic.errors import RequestError
from traffic.recognising.library import (
    Needed,
    bundled_families,
    document_of,
    find_entries,
    path_of,
)
from traffic.recognising.questions import read_question

TEXT = """# A family.
# Of two.

domain D = {a}
attribute p[?x]
message q

// What one means. It has more to say,
// in two lines.
chronicle one[?x] { event(p[?x]:(?, ?), t) }
chronicle two { chronicle one[?] event(one[?y]:(?, ?), u) event(q, u) }
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Return a file with two chronicles."""
    found = tmp_path / "family.chronicle"
    found.write_text(TEXT)
    return found


def test_all_bundled_files_are_families() -> None:
    """Each file is a family with chronicles, and a comment on what they mean."""
    families = bundled_families()

    assert [family.path for family in families] == sorted(
        (data_folder() / "chronicles").glob("*.chronicle")
    )
    for family in families:
        assert family.entries
        for entry in family.entries:
            assert entry.summary
            assert entry.needs


def test_an_entry_tells_what_there_is_to_know(path: Path) -> None:
    """Meaning is the comment before the chronicle, or else that at the top of the file."""
    family, (one, two) = find_entries(str(path))

    assert (family.name, family.meaning) == ("family", "A family.\nOf two.")
    assert one.signature == "one[x]"
    assert one.meaning == "What one means. It has more to say,\nin two lines."
    assert one.summary == "What one means."
    assert one.text == "chronicle one[?x] { event(p[?x]:(?, ?), t) }"
    assert one.needs == (Needed("p", "attribute", 1),)
    assert (two.signature, two.meaning) == ("two", family.meaning)
    assert two.needs == (
        Needed("p", "attribute", 1), Needed("one", "chronicle", 1), Needed("q", "message", 0),
    )  # fmt: skip
    assert document_of(one)["needs"] == [{"name": "p", "kind": "attribute", "arguments": 1}]


def test_chronicles_are_found_by_their_names() -> None:
    """A family gives all of its chronicles, a chronicle only itself."""
    family, entries = find_entries("turns")
    _, (only,) = find_entries("turn_left")

    assert only in entries
    assert family.name == only.family == "turns"
    assert path_of("turns") == family.path


@pytest.mark.parametrize("name", ["turm_left", "nothing"])
def test_unknown_names_are_told(name: str) -> None:
    """With the nearest name, if there is one."""
    with pytest.raises(RequestError, match=f"expected a family, a chronicle or .*'{name}'"):
        find_entries(name)
    with pytest.raises(RequestError, match=f"a file or the name of a family.*'{name}'"):
        path_of(name)


@pytest.mark.parametrize("arguments", [[], ["turn_left"], ["overtakes"]])
def test_the_library_is_one_document(arguments, monkeypatch, capsys) -> None:
    """With --json there is a list of entries on standard output, and without it a text."""
    monkeypatch.setattr(sys, "argv", ["traffic", "chronicles", *arguments])
    with pytest.raises(SystemExit, match="0"):
        main()
    shown = capsys.readouterr().out
    monkeypatch.setattr(sys, "argv", ["traffic", "chronicles", *arguments, "--json"])
    with pytest.raises(SystemExit, match="0"):
        main()
    entries = json.loads(capsys.readouterr().out)

    for entry in entries:
        assert entry["chronicle"] in shown
        assert set(entry) == {
            "family", "chronicle", "parameters", "meaning", "needs", "settings", "text"
        }  # fmt: skip


def test_several_files_are_one_question(path: Path) -> None:
    """All chronicles of all files; none may be there twice."""
    question = read_question([str(path), "overtakes"])

    assert [model.name for model in question.models][:2] == ["one", "two"]
    with pytest.raises(RequestError, match="'one' is recognised already"):
        read_question([str(path), str(path)])


def test_a_file_without_chronicles_is_no_question(tmp_path: Path) -> None:
    """There must be something to recognise."""
    path = tmp_path / "empty.chronicle"
    path.write_text("domain D = {}\n")

    with pytest.raises(RequestError, match="expected at least one chronicle"):
        read_question([str(path)])
