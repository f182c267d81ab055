"""`traffic recognise`: chronicles in recorded events."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

if TYPE_CHECKING:
    from traffic.reading.lines import ByteStream

__all__ = ["recognise"]


def recognise(
    chronicles: Annotated[
        list[str],
        typer.Argument(
            metavar="CHRONICLES",
            help="Files (.chronicle), or families of the library (see 'traffic chronicles').",
        ),
    ],
    *,
    events: Annotated[
        Path,
        typer.Option(
            metavar="FILE",
            help="Recorded events: lines of JSON (.jsonl) or CSV (.csv); '-' for standard input.",
        ),
    ],
    partial: Annotated[
        bool,
        typer.Option("--partial", help="List what is still possible at the end, and until when."),
    ] = False,
    max_delay: Annotated[
        str,
        typer.Option(help="How late an event may come and still be put in order, such as '2 s'."),
    ] = "0",
    close: Annotated[
        bool,
        typer.Option("--close", help="Nothing follows the last event: decide what is pending."),
    ] = False,
    limit: Annotated[
        int | None,
        typer.Option(min=1, help="Keep at most so many partial instances of a chronicle."),
    ] = None,
    changes: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="Give a parameter of the files another value, such as 'longest=30 s'.",
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of text.")
    ] = False,
) -> None:
    """Recognise chronicles in events, each as soon as nothing later can take it back.

    Exit status: 0 whatever is recognised, 2 if a chronicle is at fault or an event cannot be read.
    """
    from traffic.commands.showing_recognitions import recognitions_shown
    from traffic.recognising.following import Settings, delay_from
    from traffic.recognising.opening import open_events, read_events
    from traffic.recognising.questions import read_question, value_from_text

    settings = Settings(delay_from(max_delay), close, limit)
    question = read_question(chronicles, dict(map(value_from_text, changes or ())))
    if str(events) == "-":
        stream = cast("ByteStream", sys.stdin.buffer)  # it has read1, though its type hides it
        reader = read_events(stream, "<stdin>")
        recognitions_shown(question, reader, settings, partial=partial, live=True, json=json)
        return
    with open_events(events) as reader:
        live = not events.is_file()
        recognitions_shown(question, reader, settings, partial=partial, live=live, json=json)
