"""What docs/monitoring.md shows is what happens."""

import re
import shlex
import sys
from pathlib import Path

import pytest

from traffic.__main__ import main

_PROMPT = re.compile(r"^\$ ", re.MULTILINE)
DOCUMENT = (Path(__file__).parents[3] / "docs" / "monitoring.md").read_text(encoding="utf-8")
FILES = re.findall(r"^```\w+ (\S+)\n(.*?)^```$", DOCUMENT, re.MULTILINE | re.DOTALL)
CONSOLES = re.findall(r"^```console\n(.*?)^```$", DOCUMENT, re.MULTILINE | re.DOTALL)
COMMANDS = [entry.split("\n", 1) for text in CONSOLES for entry in _PROMPT.split(text) if entry]


@pytest.fixture(autouse=True)
def _files(tmp_path, monkeypatch):
    """Work in a folder with the files that the document shows."""
    for name, content in FILES:
        (tmp_path / name).write_text(content, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(("command", "expected"), COMMANDS, ids=[each[0] for each in COMMANDS])
def test_commands_print_what_is_shown(command, expected, monkeypatch, capfd):
    """Standard output, or the message of a fault."""
    monkeypatch.setattr(sys, "argv", shlex.split(command))
    status = 0
    try:
        main()
    except SystemExit as stop:
        status = stop.code or 0

    printed = capfd.readouterr()
    assert (printed.err if status else printed.out) == expected


def test_the_script_runs():
    """The lines of Python at the end of the document."""
    (script,) = re.findall(r"^```python\n(.*?)^```$", DOCUMENT, re.MULTILINE | re.DOTALL)

    exec(compile(script, "monitoring.md", "exec"), {})
