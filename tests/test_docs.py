"""The documents agree with the program that they describe."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from dyknow.kpl.syntax import GeneratorDeclaration
from traffic.__main__ import app
from traffic.system import read_specification

ROOT = Path(__file__).parent.parent
PACKAGES = ("anchoring", "chronicles", "dyknow", "networks", "perception", "traffic")
DOCUMENTS = sorted(
    [*ROOT.glob("*.md"), *(ROOT / "data").glob("*.md"), *(ROOT / "docs").rglob("*.md")]
)
INITS = sorted(path for name in PACKAGES for path in (ROOT / name).rglob("__init__.py"))

_COMMAND = re.compile(r"(?:^|`|\$ |bin/)traffic (?P<rest>[a-z][^`\n]*)", re.MULTILINE)
_LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)(?:#[^)]*)?\)")
_IDENTIFIER = re.compile(r"`(\w+)`")


def commands(group: Any = None, path: tuple[str, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Yield every command of the program with its name, `network show` for instance."""
    group = typer.main.get_command(app) if group is None else group
    for name, command in group.commands.items():
        yield " ".join((*path, name)), command
        if hasattr(command, "commands"):
            yield from commands(command, (*path, name))


def named(path: Path) -> str:
    """Return what a test of the file *path* is called."""
    return str(path.relative_to(ROOT))


def test_every_command_has_help() -> None:
    """Each command says in a sentence what it does."""
    without = [name for name, command in commands() if not command.help]

    assert not without


@pytest.mark.parametrize("document", DOCUMENTS, ids=named)
def test_commands_in_documents_exist(document: Path) -> None:
    """What a document writes as `traffic COMMAND --option` can be typed."""
    known = dict(commands())

    for match in _COMMAND.finditer(document.read_text(encoding="utf-8")):
        words = match["rest"].split()
        name = next((n for n in (" ".join(words[:2]), words[0]) if n in known), None)
        assert name is not None, match[0]
        options = {option for param in known[name].params for option in param.opts} | {"--help"}
        used = {word for word in words if word.startswith("--")}
        assert used <= options, match[0]


def test_readme_names_every_command() -> None:
    """Who has read the README knows of all commands."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")

    for name, command in commands():
        if not hasattr(command, "commands"):
            assert f"traffic {name}" in text, name


@pytest.mark.parametrize("document", DOCUMENTS, ids=named)
def test_links_lead_to_files(document: Path) -> None:
    """Each relative link of a document leads to something that is there."""
    links = _LINK.findall(document.read_text(encoding="utf-8"))
    broken = [link for link in links if not (document.parent / link).exists()]

    assert not broken


@pytest.mark.parametrize("init", INITS, ids=named)
def test_packages_list_their_modules(init: Path) -> None:
    """The docstring of a package mentions each of its modules and packages."""
    text = ast.get_docstring(ast.parse(init.read_text(encoding="utf-8"))) or ""
    modules = {path.stem for path in init.parent.glob("[!_]*.py")}
    packages = {path.parent.name for path in init.parent.glob("*/__init__.py")}
    missing = [name for name in sorted(modules | packages) if f"`{name}`" not in text]

    assert not missing


def test_architecture_names_every_stream() -> None:
    """The data flow shows each label of the specification."""
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    labels = {
        declaration.label.feature.text
        for declaration in read_specification().declarations
        if isinstance(declaration, GeneratorDeclaration)
    }

    assert labels
    assert not [label for label in sorted(labels) if label not in text]


def test_glossary_has_only_words_of_the_code() -> None:
    """Each identifier of the glossary occurs in the code."""
    sources = (path for name in PACKAGES for path in (ROOT / name).rglob("*.py"))
    words = {word for path in sources for word in re.findall(r"\w+", path.read_text("utf-8"))}
    rows = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8").splitlines()
    identifiers = {
        identifier
        for row in rows
        if row.startswith("| ")
        for identifier in _IDENTIFIER.findall(row.split("|")[2])
    }

    assert identifiers
    assert not sorted(identifiers - words)


def test_decisions_have_one_form() -> None:
    """Decisions are numbered without gaps, and each has the same four parts."""
    pages = sorted((ROOT / "docs" / "decisions").glob("*.md"))

    for number, page in enumerate(pages, start=1):
        text = page.read_text(encoding="utf-8")
        assert page.name.startswith(f"{number:04d}-")
        assert text.startswith(f"# {number}. ")
        for part in ("Context", "Decision", "Alternatives", "Consequences"):
            assert f"**{part}.**" in text, f"{page.name}: {part}"
