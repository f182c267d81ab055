"""`traffic replay`: the same again from a recording, or with a changed specification."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["replay"]


def replay(
    recording: Annotated[Path, typer.Argument(help="What 'traffic run --record' wrote (.mcap).")],
    *,
    specification: Annotated[
        Path | None, typer.Option(help="Network of processes (.kpl); default: the recorded one.")
    ] = None,
    taken: Annotated[
        str | None,
        typer.Option(
            "--from", help="Take these labels from the recording instead of computing them."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the result; default: it is only shown.")
    ] = None,
    record: Annotated[
        Path | None, typer.Option(help="Write every stream of the replay to this file (.mcap).")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
    real_time: Annotated[
        bool, typer.Option("--real-time", help="Keep to the clock on the wall; same results.")
    ] = False,
) -> None:
    """Run the system again on what was recorded, and compare every stream with what it was.

    If nothing has changed since then, a stream that differs is a fault of the
    program, and the exit status is 1.
    """
    from traffic.commands.showing import progress, show_result
    from traffic.replaying import ReplayRequest
    from traffic.replaying import replay as replay_run

    request = ReplayRequest.from_texts(
        path=recording,
        specification=specification,
        taken=taken,
        out=out,
        record=record,
        real_time=real_time,
    )
    with progress("replaying") as on_progress:
        result = replay_run(request, on_progress)
    if json:
        sys.stdout.write(result.model_dump_json(indent=1) + "\n")
    else:
        show_result(result)
    if out is not None:
        sys.stderr.write(f"replay written to {out}\n")
    if result.replay is not None and result.replay.is_fault:
        sys.stderr.write("traffic: the same specification on the same input gave other streams\n")
        sys.exit(1)
