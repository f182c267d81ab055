"""`traffic regress`: replay the recordings of a regression suite."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["regress"]


def regress(
    names: Annotated[
        list[str] | None, typer.Argument(help="Names of recordings; default: all.")
    ] = None,
    *,
    suite: Annotated[
        Path | None, typer.Option(help="Folder of the suite; default: the bundled one.")
    ] = None,
    list_: Annotated[
        bool, typer.Option("--list", help="List the recordings and what is expected of each.")
    ] = False,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="Replay with another setting: NAME=VALUE, such as "
            "'turns.file=my/turns.chronicle'; may be repeated.",
        ),
    ] = None,
    update: Annotated[
        bool, typer.Option("--update", help="Expect from now on what is recognised now.")
    ] = False,
    remake: Annotated[
        bool,
        typer.Option("--remake", help="Do the runs again and cut new recordings out of them."),
    ] = False,
    add: Annotated[
        Path | None,
        typer.Option(help="Add a piece of this recording (.mcap), or of this recorded run."),
    ] = None,
    begin: Annotated[
        str | None,
        typer.Option("--from", help="With --add: where the piece begins; default: at 0."),
    ] = None,
    end: Annotated[
        str | None, typer.Option("--to", help="With --add: where it ends; default: the end.")
    ] = None,
    name: Annotated[str | None, typer.Option(help="With --add: what it is to be called.")] = None,
    shows: Annotated[
        str | None, typer.Option(help="With --add: what it is in the suite for, a sentence.")
    ] = None,
    recognise: Annotated[
        str | None,
        typer.Option(help="With --add: what in it, such as 'turns'; default: as in the run."),
    ] = None,
) -> None:
    """Replay recorded scenarios; show what is recognised otherwise than expected, as a diff.

    Exit status: 0 all as expected, 1 something differs, 2 a recording cannot be replayed.
    """
    from traffic.commands import showing_regressions as showing
    from traffic.regression import making, regressing
    from traffic.regression.listing import listed
    from traffic.regression.request import RegressionRequest, Task
    from traffic.settings import change_from_text

    asked = {Task.LIST: list_, Task.UPDATE: update, Task.REMAKE: remake, Task.ADD: add is not None}
    request = RegressionRequest.from_texts(
        names=names or (),
        suite=suite,
        tasks=[task for task, is_asked in asked.items() if is_asked],
        changes=dict(map(change_from_text, settings or ())),
        addition={
            "--add": add,
            "--from": begin,
            "--to": end,
            "--name": name,
            "--shows": shows,
            "--recognise": recognise,
        },
    )
    folder = request.manifest.folder
    match request.task:
        case Task.LIST:
            showing.show_listed(map(listed, request.entries, request.described))
        case Task.UPDATE:
            updated = regressing.update(request.entries, request.hints)
            sys.exit(showing.show_updated(updated))
        case Task.REMAKE:
            showing.show_remade(making.remake(request.makings, folder))
        case Task.ADD if request.addition is not None:
            made = making.add(request.addition, request.manifest)
            showing.show_added(request.addition.entry, made)
        case _:
            system = regressing.System.changed(request.changes)
            found = regressing.regress(request.entries, system, request.hints)
            sys.exit(showing.show_regressions(found))
