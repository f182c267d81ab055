"""`traffic chronicles`: the library of chronicles."""

from typing import Annotated

import typer

__all__ = ["chronicles"]


def chronicles(
    name: Annotated[
        str | None, typer.Argument(help="A chronicle, a family of them, or a file; default: all.")
    ] = None,
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of text.")
    ] = False,
) -> None:
    """List the chronicles that come with the program, or show one."""
    from traffic.commands.showing_chronicles import entries_shown, library_shown
    from traffic.recognising.library import bundled_families, find_entries

    if name is None:
        library_shown(bundled_families(), json=json)
    else:
        family, entries = find_entries(name)
        entries_shown(family, entries, json=json)
