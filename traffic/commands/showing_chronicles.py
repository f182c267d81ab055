"""The library of chronicles as a table, single chronicles in full, and both as JSON."""

import json as json_module
import sys
from collections.abc import Iterable, Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from traffic.recognising.library import Entry, Family, FileParameter, Needed, document_of

__all__ = ["entries_shown", "library_shown"]


def library_shown(families: Iterable[Family], *, json: bool) -> None:
    """Print all chronicles, a line for each."""
    if json:
        _write([document_of(entry) for family in families for entry in family.entries])
        return
    table = Table("family", "chronicle", "what it means", box=None)
    for column in table.columns[:2]:
        column.no_wrap = True
    for family in families:
        said = ""
        for i, entry in enumerate(family.entries):
            meaning = "" if entry.summary == said else entry.summary
            shown = ("" if i else family.name, entry.signature, meaning)
            table.add_row(*map(escape, shown))
            said = entry.summary
    Console().print(table)


def entries_shown(family: Family, entries: Sequence[Entry], *, json: bool) -> None:
    """Print some chronicles of a family in full."""
    if json:
        _write([document_of(entry) for entry in entries])
        return
    headings = [] if len(entries) == 1 else [family.meaning]
    shared = {family.meaning} if headings else set()
    parts = [*headings, *(_shown(entry, shared) for entry in entries)]
    sys.stdout.write("\n\n".join(filter(None, parts)) + "\n")


def _shown(entry: Entry, said: set[str]) -> str:
    meaning = "" if entry.meaning in said else f"{entry.meaning}\n\n"
    needs = "".join(f"\n  {_needed(each)}" for each in entry.needs)
    settings = "".join(f"\n  {_set(each)}" for each in entry.settings)
    told = f"\n{entry.name} can be set by{settings}" if settings else ""
    return f"{meaning}{entry.text}\n\n{entry.name} looks at{needs}{told}"


def _needed(each: Needed) -> str:
    n = each.n_arguments
    return f"the {each.kind} {each.name} of {n} argument{'' if n == 1 else 's'}"


def _set(each: FileParameter) -> str:
    return f"{each.name} = {each.value}" + (f" ({each.meaning})" if each.meaning else "")


def _write(document: object) -> None:
    sys.stdout.write(json_module.dumps(document, indent=1, ensure_ascii=False) + "\n")
