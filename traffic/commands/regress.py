"""`traffic regress`: replay the recordings of the regression suite."""

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
    add: Annotated[
        Path | None, typer.Option(help="Add a piece of this recording (.mcap) to the suite.")
    ] = None,
    begin: Annotated[
        str, typer.Option("--from", help="With --add: where the piece begins, such as '10s'.")
    ] = "0",
    end: Annotated[
        str | None, typer.Option("--to", help="With --add: where it ends; default: the end.")
    ] = None,
    name: Annotated[str | None, typer.Option(help="With --add: what it is to be called.")] = None,
    update: Annotated[
        bool, typer.Option("--update", help="Expect from now on what is recognised now.")
    ] = False,
) -> None:
    """Replay recorded scenarios; show what is recognised otherwise than expected, as a diff."""
    from traffic.commands.showing_regressions import show_added, show_regressions, show_updated
    from traffic.regression import regressing
    from traffic.regression.request import RegressionRequest

    request = RegressionRequest.from_texts(
        names=names or (), suite=suite, add=add, begin=begin, end=end, name=name, update=update
    )
    if request.addition is not None:
        show_added(regressing.add(request.addition))
    elif request.update:
        show_updated(regressing.update(request.entries))
    elif not show_regressions(regressing.regress(request.entries), len(request.entries)):
        sys.exit(1)
