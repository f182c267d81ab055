"""`traffic explain`: why a run recognised what it did, from the recognition down to the frames."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["explain"]


def explain(
    run: Annotated[Path, typer.Argument(help="Folder that 'traffic run' wrote.")],
    number: Annotated[
        str | None,
        typer.Argument(
            metavar="[N]",
            help="Number of the recognition, as 'traffic report' lists it, or the name of a "
            "chronicle that was recognised once; without it the list.",
        ),
    ] = None,
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of text.")
    ] = False,
    picture: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Draw frames and time line into this new file (.png)."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER", help="Write text, JSON and picture into this new folder as well."
        ),
    ] = None,
) -> None:
    """Walk from a recognition to its events, samples, objects, percepts and frames.

    Images are not stored: for a picture the simulation is run again up to the last frame shown.
    """
    from traffic.commands.showing import progress
    from traffic.commands.showing_explanations import (
        show_explanation,
        show_recognitions,
        text_of_explanation,
    )
    from traffic.explaining.asking import ExplanationRequest, explain_run, recognitions_of

    request = ExplanationRequest.from_texts(run=run, recognition=number, picture=picture, out=out)
    if request.recognition is None:
        show_recognitions(recognitions_of(run), run, json=json)
        return
    with progress("rendering again") as on_progress:
        explanation = explain_run(request, text_of_explanation, on_progress)
    if json:
        sys.stdout.write(explanation.model_dump_json(indent=1) + "\n")
    else:
        show_explanation(explanation)
    if out is not None:
        sys.stderr.write(f"explanation written to {out}\n")
