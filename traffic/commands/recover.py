"""`traffic recover`: a valid recording of what is whole in a damaged one."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["recover"]


def recover(
    recording: Annotated[
        Path, typer.Argument(help="A recording that was cut off or damaged (.mcap, .partial).")
    ],
    target: Annotated[Path, typer.Argument(help="The recording to write (.mcap).")],
) -> None:
    """Save what is whole in a damaged recording, and say what was saved and what was lost."""
    from dyknow.recordings.recovery import recover as recover_recording
    from traffic.commands.showing import progress

    with progress("recovering", "%") as on_progress:
        report = recover_recording(recording, target, lambda share: on_progress(100 * share, 100))
    sys.stdout.write(f"{report}\n")
    if report.is_whole:
        sys.stdout.write(f"{recording}: nothing was wrong\n")
