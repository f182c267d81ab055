"""Faults of the files that people write."""

import pytest

from traffic.bundled import data_folder
from traffic.checking import faults_of_file, warnings_of_file
from traffic.errors import RequestError

WRITTEN = sorted(
    path
    for path in data_folder().rglob("*")
    if path.suffix in {".kpl", ".chronicle", ".toml", ".mtl"}
)


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: str(path.relative_to(data_folder())))
def test_what_comes_with_the_program_has_no_faults(path):
    """Specification, chronicles and scenarios are as they should be."""
    assert faults_of_file(path) == []


@pytest.mark.parametrize(
    ("name", "text", "places"),
    [
        ("f.mtl", "always p and", ["1:13"]),
        ("f.mtl", "always [2, 1] p and\neventually [4, 3] q", ["1:8", "2:12"]),
        ("s.kpl", "stream a = b\nstream c = d", ["1:12", "2:12"]),
        ("s.kpl", "strmgen", ["1:8"]),
        ("c.chronicle", "chronicle a {\n event(p:(?, true), t1)\n t2 < t1 }", ["3:2"]),
        ("c.chronicle", "chronicle {", ["1:11"]),
        ("s.toml", 'duration = -1\nnetwork = "crosing"', ["1:1"]),
        ("s.toml", 'duration = 1\nnetwork = "crosing"', ["2:1"]),
        ("s.toml", "duration =\n", ["1:11"]),
        ("s.toml", 'duration = "1 s"\nnetwork = 3\nflows = 4\ncamera = 5', ["2:1", "3:1", "4:1"]),
    ],
)
def test_every_fault_has_its_place_and_its_line(name, text, places, tmp_path):
    """A fault begins with file, line and column, and ends with the line and a caret."""
    path = tmp_path / name
    path.write_text(text)

    faults = faults_of_file(path)

    assert [fault.split(": ")[0] for fault in faults] == [f"{path}:{place}" for place in places]
    for fault, place in zip(faults, places, strict=True):
        line, column = map(int, place.split(":"))
        *_, excerpt, carets = fault.split("\n")
        assert excerpt == text.split("\n")[line - 1]
        assert carets.index("^") == column - 1


@pytest.mark.parametrize("ending", [".kpl", ".chronicle", ".mtl", ".toml"])
def test_that_a_file_cannot_be_read_is_a_fault(ending, tmp_path):
    """Missing, a folder, or no text."""
    folder, binary = tmp_path / f"folder{ending}", tmp_path / f"binary{ending}"
    folder.mkdir()
    binary.write_bytes(b"\xff\xfe")

    (missing,) = faults_of_file(tmp_path / f"missing{ending}")
    (is_folder,) = faults_of_file(folder)
    (is_binary,) = faults_of_file(binary)

    assert missing.endswith("No such file or directory")
    assert is_folder.endswith("Is a directory")
    assert is_binary.endswith("is not a text in UTF-8")


def test_the_ending_says_what_a_file_is(tmp_path):
    """A file of an unknown kind cannot be checked."""
    with pytest.raises(RequestError, match=r"ends in one of \.kpl, \.chronicle, \.mtl, \.toml"):
        faults_of_file(tmp_path / "a.txt")


def test_what_no_output_needs_is_a_warning(tmp_path):
    """It has its place and its line as a fault has, and is none."""
    path = tmp_path / "s.kpl"
    path.write_text("source n s\nstrmgen a = s\n  strmgen b = s\nstream a = a\n")

    assert faults_of_file(path) == []
    assert warnings_of_file(path) == [
        f"{path}:3:3: warning: 'b' is not used\n  strmgen b = s\n  ^^^^^^^^^^^^^"
    ]
    assert warnings_of_file(tmp_path / "s.toml") == []


def test_all_faults_of_a_specification_are_told_at_once(tmp_path):
    """Those of syntax as well as those of meaning, in reading order."""
    path = tmp_path / "s.kpl"
    path.write_text("strmgen a = = s\nstrmgen b = s\nstrmgen c = s)\nstream d = e\n")

    places = [fault.split(": ")[0].removeprefix(f"{path}:") for fault in faults_of_file(path)]

    assert places == ["1:13", "2:13", "3:14", "4:12"]


def test_chronicles_are_warned_of(tmp_path):
    """What may be awaited without end, and declarations that nothing uses, have their place."""
    path = tmp_path / "c.chronicle"
    path.write_text(
        "attribute p[?x]\ndomain D = {a}\nmessage m[?x]\n"
        "chronicle c[?x] {\n    event(p[?x]:(?, true), t1)\n    event(p[?x]:(true, ?), t2)\n"
        "    t1 < t2\n}\n"
    )

    assert faults_of_file(path) == []
    assert [text.split("\n")[0] for text in warnings_of_file(path)] == [
        f"{path}:2:1: warning: 'D' is not used",
        f"{path}:3:1: warning: 'm' is not used",
        (
            f"{path}:6:5: warning: chronicle 'c' may await this event without end: nothing"
            " limits how long after 't1' 't2' can be"
        ),
    ]


def test_a_suite_is_told_by_its_recordings(tmp_path):
    """What the text beside recordings says of them is checked, whatever the file is called."""
    path = tmp_path / "mine.toml"
    path.write_text('[[recordings]]\nname = "x"\nfrom = "1 s"\nto = "2 s"\nsed = 3\n')

    (fault,) = faults_of_file(path)

    assert fault.startswith(f"{path}:5:1: no key called 'sed' here; did you mean 'seed'?")
