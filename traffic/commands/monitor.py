"""`traffic monitor`: a formula over recorded states."""

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

if TYPE_CHECKING:
    from traffic.reading.lines import ByteStream

__all__ = ["monitor"]


class _TimeModel(StrEnum):
    """The time models of `dyknow.mtl`, which is not imported before it is needed."""

    HOLD = "hold"
    POINTS = "points"


def monitor(
    formula: Annotated[
        str, typer.Argument(metavar="FORMULA", help="A formula, or a file with one (.mtl).")
    ],
    *,
    states: Annotated[
        Path,
        typer.Option(
            metavar="FILE",
            help="Recorded states: lines of JSON (.jsonl) or CSV (.csv); '-' for standard input.",
        ),
    ],
    time_model: Annotated[
        _TimeModel,
        typer.Option(
            help="hold: a state holds until the next one; points: only the states' times count."
        ),
    ] = _TimeModel.HOLD,
    domain: Annotated[
        list[str] | None,
        typer.Option(metavar="SORT=A,B", help="The objects that a quantifier ranges over."),
    ] = None,
    explain: Annotated[
        bool,
        typer.Option(
            "--explain", help="Tell what is left after each state, and what decided the formula."
        ),
    ] = False,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of text.")
    ] = False,
) -> None:
    """Find the verdict on a formula at the earliest state that decides it.

    Exit status: 0 whatever the verdict, 2 if the formula or a state is at fault.
    """
    from dyknow.mtl.syntax import TimeModel
    from traffic.commands.showing_monitors import answer_shown
    from traffic.monitoring.opening import open_states, read_states
    from traffic.monitoring.questions import domains_from, read_question

    question = read_question(formula, domains_from(domain or []))
    model = TimeModel(time_model.value)
    if str(states) == "-":
        stream = cast("ByteStream", sys.stdin.buffer)  # it has read1, though its type hides it
        reader = read_states(stream, "<stdin>", question.sorts)
        answer_shown(question, reader, model, explain=explain, json=json)
        return
    with open_states(states, question.sorts) as reader:
        answer_shown(question, reader, model, explain=explain, json=json)
