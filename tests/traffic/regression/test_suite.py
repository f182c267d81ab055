"""Recordings in a folder, and files that are there as a whole or not at all."""

from pathlib import Path

import pytest

from traffic.errors import RequestError
from traffic.regression.suite import Entry, entries, replace_text, written_whole


def test_the_recordings_of_a_folder_are_found_by_name(tmp_path: Path) -> None:
    """In order of name; other files are none, and names may have any characters."""
    for name in ("b.mcap", "a b.ü.mcap", "c.mcap.partial", "b.expected.txt", "suite.toml"):
        (tmp_path / name).touch()

    assert entries(tmp_path) == (Entry(tmp_path, "a b.ü"), Entry(tmp_path, "b"))
    assert entries(tmp_path, ["b"]) == (Entry(tmp_path, "b"),)
    with pytest.raises(RequestError, match=r"names of recordings in .*; did you mean 'b'"):
        entries(tmp_path, ["bb"])
    with pytest.raises(RequestError, match="a folder with recordings"):
        entries(tmp_path / "nowhere")


@pytest.mark.parametrize("content", [None, b"\xff\xfe\x00"])
def test_an_expectation_that_is_no_text_is_told(tmp_path: Path, content: bytes | None) -> None:
    """Together with the command that writes it."""
    entry = Entry(tmp_path, "x")
    if content is not None:
        entry.expected.write_bytes(content)

    with pytest.raises(RequestError, match="'traffic regress --update x' writes it"):
        entry.read_expected()


def test_an_entry_that_fails_leaves_nothing(tmp_path: Path) -> None:
    """Neither of its files, nor where they were written; one that succeeds has both."""
    entry = Entry(tmp_path, "x")

    def write_half() -> None:
        with written_whole(entry) as unfinished:
            unfinished.recording.write_text("half of")
            raise OSError(28, "full")

    with pytest.raises(OSError, match="full"):
        write_half()
    assert not list(tmp_path.iterdir())

    with written_whole(entry) as unfinished:
        unfinished.recording.write_text("all")
        unfinished.expected.write_text("nothing")

    assert sorted(tmp_path.iterdir()) == [entry.expected, entry.recording]


def test_a_text_that_cannot_be_written_stays_as_it_was(tmp_path: Path) -> None:
    """A text with half a character, which no file can have."""
    path = tmp_path / "suite.toml"
    replace_text(path, "first")

    with pytest.raises(UnicodeEncodeError):
        replace_text(path, "second \ud800")

    assert path.read_text() == "first"
    assert list(tmp_path.iterdir()) == [path]
