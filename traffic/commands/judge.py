"""`traffic judge`: does a recorded run satisfy its specification?"""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["judge"]


def judge(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="[SPECIFICATION] RECORDING",
            help="Network of processes (.kpl), if it is not to be the recorded one; and what "
            "'traffic run --record' wrote (.mcap).",
        ),
    ],
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
) -> None:
    """Judge whether every recorded stream is what the specification says.

    Exit status: 0 if the run satisfies the specification, 1 if it does not,
    2 if a file cannot be used.
    """
    from pydantic_core import to_json

    from traffic.commands.showing import progress
    from traffic.commands.showing_judgements import show_judgement
    from traffic.errors import RequestError
    from traffic.judging import document_from, judge_recording

    match files:
        case [recording]:
            specification = None
        case [specification, recording]:
            pass
        case _:
            found = " ".join(map(str, files))
            raise RequestError("FILES", "a specification and a recording", found)
    with progress("judging", "streams") as on_progress:
        judged = judge_recording(recording, specification, on_progress)
    if json:
        sys.stdout.write(to_json(document_from(judged), indent=1).decode() + "\n")
    else:
        show_judgement(judged)
    if not judged.judgement.is_satisfied:
        sys.exit(1)
