"""What documents show of commands is what happens."""

import re
import shlex
import sys
from pathlib import Path

import pytest

from traffic.__main__ import main

FOLDER = Path(__file__).parents[3] / "docs"
DOCUMENTS = {name: (FOLDER / name).read_text(encoding="utf-8") for name in (
    "monitoring.md",
    "recognising.md",
)}  # fmt: skip
_PROMPT = re.compile(r"^\$ ", re.MULTILINE)
_FILES = re.compile(r"^```\w+ (\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_MEASURED = re.compile(r"^.* in \d+ \w+, .* s(, \d+ a second)?\n", re.MULTILINE)


def entries(fence: str) -> list[tuple[str, str, str]]:
    """Return document, command and what it prints, of each command between such fences."""
    block = re.compile(rf"^```{fence}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
    return [
        (name, *entry.split("\n", 1))
        for name, text in DOCUMENTS.items()
        for shown in block.findall(text)
        for entry in _PROMPT.split(shown)
        if entry
    ]


CONSOLES, MESSAGES = entries("console"), entries("messages")


@pytest.fixture
def files(request, tmp_path, monkeypatch):
    """Work in a folder with the files that a document shows."""
    for name, content in _FILES.findall(DOCUMENTS[request.param]):
        (tmp_path / name).write_text(content, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


def status_of(command: str, monkeypatch: pytest.MonkeyPatch) -> int:
    """Run a command and return its exit status."""
    monkeypatch.setattr(sys, "argv", shlex.split(command))
    try:
        main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


@pytest.mark.parametrize(
    ("files", "command", "expected"),
    CONSOLES,
    ids=[each[1] for each in CONSOLES],
    indirect=["files"],
)
def test_commands_print_what_is_shown(files, command, expected, monkeypatch, capfd):
    """Standard output, or the message of a fault."""
    status = status_of(command, monkeypatch)

    printed = capfd.readouterr()
    assert (printed.err if status else printed.out) == expected


@pytest.mark.parametrize(
    ("files", "command", "expected"),
    MESSAGES,
    ids=[each[1] for each in MESSAGES],
    indirect=["files"],
)
def test_commands_say_what_is_shown(files, command, expected, monkeypatch, capfd):
    """What is told on standard error, without what was measured."""
    status_of(command, monkeypatch)

    assert _MEASURED.sub("", capfd.readouterr().err) == expected


@pytest.mark.parametrize("files", DOCUMENTS, indirect=True)
def test_the_script_runs(files, request):
    """The lines of Python at the end of the document."""
    text = DOCUMENTS[request.node.callspec.params["files"]]
    (script,) = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)

    exec(compile(script, "document", "exec"), {})
