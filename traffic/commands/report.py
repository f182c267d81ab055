"""`traffic report`: show finished runs and experiments again."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["report"]


def report(
    folders: Annotated[
        list[Path],
        typer.Argument(
            metavar="RUN|EXPERIMENT...",
            help="Folders that were written; tables of cells (.csv) stand for experiments.",
        ),
    ],
    *,
    html: Annotated[
        Path | None,
        typer.Option(
            help="Write a web page of one file, which opens offline: of a run with map, time "
            "line and the reasons behind all of it, of several runs with their scores, of "
            "experiments with their measures."
        ),
    ] = None,
    film: Annotated[
        Path | None,
        typer.Option(
            help="With --html of one run: the film that '--overlay' wrote, played in step with "
            "the map. Default: RUN.mp4 beside the folder RUN, if it is there."
        ),
    ] = None,
    csv: Annotated[
        Path | None, typer.Option(help="Write scores, or the measures of all cells, as CSV.")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
) -> None:
    """Show what runs recognised, against the truth, or what experiments measured.

    Several experiments are put side by side. Nothing is run again.
    """
    from traffic.commands.showing import progress
    from traffic.commands.showing_reports import show_report
    from traffic.errors import RequestError
    from traffic.reporting.reports import read_report

    if film is not None and html is None:
        raise RequestError("--film", "--html as well, to be part of that page", film)
    found = read_report(folders)
    if html is not None:
        with progress("explaining", "recognitions") as on_progress:
            found.write_page(html, film, on_progress)
        sys.stderr.write(f"page written to {html}\n")
    if csv is not None:
        found.write_csv(csv)
        sys.stderr.write(f"table written to {csv}\n")
    if json:
        sys.stdout.write(found.as_json() + "\n")
    elif html is None and csv is None:
        show_report(found)
