"""Explanations as a tree for people to read, and the list of what can be explained."""

import sys
from collections.abc import Iterator, Sequence
from io import StringIO
from pathlib import Path

from pydantic_core import to_json
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.tree import Tree

from traffic.explaining.explanation import (
    Change,
    EventExplanation,
    Explanation,
    Frame,
    LinkStep,
    ListedRecognition,
    ObjectExplanation,
    RecognitionExplanation,
    State,
)
from traffic.explaining.wording import (
    constraint_text,
    counted_text,
    end_text,
    event_text,
    length_text,
    time_text,
)

__all__ = ["show_explanation", "show_recognitions", "text_of_explanation"]

_VERDICTS = {True: "[green]the truth agrees[/]", False: "[red]the truth does not agree[/]"}
_MADE = {"establish": "established", "reestablish": "re-established"}
_UNTOLD = {"x", "y", "length", "width", "temperature"}
_MOST_NUMBERS = 5
_PAGE = 160


def show_recognitions(found: Sequence[ListedRecognition], run: Path, *, json: bool) -> None:
    """Print what can be explained of a run, with the numbers to ask for."""
    if json:
        document = {"recognitions": [each.model_dump() for each in found]}
        sys.stdout.write(to_json(document, indent=1).decode() + "\n")
        return
    title = f"What 'traffic explain {run} N' explains"
    table = Table("N", "from s", "to s", "recognised", "arguments", box=SIMPLE_HEAD, title=title)
    for each in found:
        arguments = ", ".join(f"{name} {value}" for name, value in each.arguments.items())
        table.add_row(
            str(each.number),
            f"{each.begin / 1000:.1f}",
            f"{each.end / 1000:.1f}",
            escape(each.chronicle.replace("_", " ")),
            escape(arguments),
        )
    Console().print(table)


def show_explanation(explanation: Explanation) -> None:
    """Print an explanation as a tree."""
    Console().print(_tree(explanation), highlight=False)


def text_of_explanation(explanation: Explanation) -> str:
    """Return the tree of an explanation as plain text."""
    console = Console(file=StringIO(), width=_PAGE, no_color=True, force_terminal=False)
    with console.capture() as captured:
        console.print(_tree(explanation), highlight=False)
    return captured.get()


def _tree(explanation: Explanation) -> Tree:
    """Return an explanation as a tree."""
    told = explanation.recognition
    tree = Tree(_headline(told), guide_style="dim")
    tree.add(f"[dim]run {escape(explanation.run)}: {escape(explanation.scenario)}[/]")
    _add_recognition(tree, told)
    return tree


def _headline(told: RecognitionExplanation) -> str:
    number = "" if told.number is None else f"{told.number}: "
    name = escape(told.chronicle.replace("_", " "))
    values = ", ".join(f"{variable} = {value}" for variable, value in told.values.items())
    verdict = _VERDICTS.get(told.agrees) if told.agrees is not None else None
    parts = [
        f"[bold]{number}{name}[/]",
        escape(values),
        f"{time_text(told.begin)} to {time_text(told.end)}",
        *([verdict] if verdict else []),
    ]
    return "  ·  ".join(parts)


def _add_recognition(tree: Tree, told: RecognitionExplanation) -> None:
    sample = told.sample
    where = "" if sample is None else f", told in '{escape(sample.stream)}'"
    late = "" if sample is None else f" at {time_text(sample.available_time)}"
    tree.add(
        f"certain at {time_text(told.recognised_at)}{where}{late}; "
        f"chronicle in {escape(told.file)}"
    )
    events = tree.add("[bold]events[/]")
    for event in told.events:
        _add_event(events, event)
    _add_constraints(tree, told)
    _add_counted(tree, told)
    _add_objects(tree, told)


def _add_constraints(tree: Tree, told: RecognitionExplanation) -> None:
    constraints = tree.add("[bold]constraints[/]")
    for each in told.constraints:
        written = f"  [dim]{escape(each.text)}[/]" if each.terms else ""
        constraints.add(f"{_mark(each.holds)} {escape(constraint_text(each))}{written}")


def _add_counted(tree: Tree, told: RecognitionExplanation) -> None:
    if not told.counted:
        return
    counted = tree.add("[bold]counted[/]")
    for each in told.counted:
        branch = counted.add(f"{_mark(each.holds)} {escape(counted_text(each))}")
        for event in each.events:
            branch.add(f"{time_text(event.time)}  {escape(event_text(event))}")


def _add_objects(tree: Tree, told: RecognitionExplanation) -> None:
    if told.objects:
        objects = tree.add("[bold]objects[/]")
        for each in told.objects:
            _add_object(objects, each, told)
    if told.frames:
        frames = tree.add("[bold]frames[/]")
        for frame in told.frames:
            _add_frame(frames, frame)


def _add_event(tree: Tree, event: EventExplanation) -> None:
    instants = " = ".join(event.instants)
    branch = tree.add(
        f"[bold]{escape(instants)}[/]  {time_text(event.event.time)}  "
        f"[cyan]{escape(event_text(event.event))}[/]"
    )
    branch.add(f"[dim]meets[/] {escape('; '.join(event.predicates))}")
    if event.sample is not None:
        branch.add(
            f"[dim]told in[/] '{escape(event.sample.stream)}' at "
            f"{time_text(event.sample.available_time)}  [dim]{escape(event.sample.process)}[/]"
        )
    if event.change is not None:
        for line in _change(event.change):
            branch.add(line)
    if event.near:
        branch.add(f"[dim]near it[/] {escape('; '.join(_near(event)))}")
    if event.recognition is not None:
        _add_recognition(branch.add(_headline(event.recognition)), event.recognition)


def _near(event: EventExplanation) -> Iterator[str]:
    for each in event.near:
        yield f"{time_text(each.time)} {each.before or 'unknown'} → {each.after or 'unknown'}"


def _change(change: Change) -> Iterator[str]:
    filtered, raw = change.filtered, change.raw
    if raw is None:
        yield (
            f"[dim]column[/] {escape(filtered.column)} of '{escape(filtered.stream)}' at "
            f"{time_text(filtered.valid_time)}  [dim]{escape(filtered.process)}[/]"
        )
        return
    yield (
        f"[dim]let through by[/] '{escape(filtered.stream)}' at "
        f"{time_text(filtered.available_time)}, when it had held for "
        f"{length_text(change.held_ms)}  [dim]{escape(filtered.process)}[/]"
    )
    numbers = [
        f"{name} {value:.2f}" for name, value in raw.quantities.items() if name not in _UNTOLD
    ]
    told = f"; {', '.join(numbers[:_MOST_NUMBERS])}" if numbers else ""
    yield (
        f"[dim]before the filter[/] '{escape(raw.stream)}' at {time_text(raw.valid_time)}: "
        f"{escape(raw.column)} {escape(raw.before or 'unknown')} → "
        f"{escape(raw.after or 'unknown')}{escape(told)}"
    )


def _add_object(tree: Tree, told: ObjectExplanation, recognition: RecognitionExplanation) -> None:
    names = ", ".join(told.variables)
    truth = [
        value
        for name, value in (recognition.truth or {}).items()
        if recognition.values.get(name) == told.symbol
    ]
    of = f" [dim](the vehicle {escape(truth[0])})[/]" if truth else ""
    branch = tree.add(f"[bold]{escape(told.symbol)}[/] {escape(names)}{of}")
    links = branch.add(f"links since {time_text(told.first_seen)}")
    for line in _links(told.links):
        links.add(line)
    if told.states:
        branch.add(_states(told.states))
    for gap in told.gaps:
        branch.add(
            f"[yellow]predicted, not observed, from {time_text(gap.begin)} to "
            f"{time_text(gap.end)}[/]"
        )


def _links(links: Sequence[LinkStep]) -> Iterator[str]:
    for link in links:
        made = (
            f"{time_text(link.begin)}  {escape(link.upper)} ← {escape(link.lower)} "
            f"{_MADE[link.made_by]}  [dim]{escape(link.condition)}[/]"
        )
        if link.end is None:
            yield made
        else:
            yield f"{made}\n[dim]{time_text(link.end)}[/]  removed: {escape(end_text(link))}"


def _states(states: Sequence[State]) -> Table:
    table = Table("at", "s", "x, y m", "m/s", "heading", "where", "rests on", box=SIMPLE_HEAD)
    for state in states:
        speed = "–" if state.speed is None else f"{state.speed:.1f}"
        heading = "–" if state.heading is None else f"{state.heading:.0f}°"
        seen = "" if state.observed else " [yellow](predicted)[/]"
        table.add_row(
            escape(" = ".join(state.instants)),
            f"{state.time / 1000:.2f}",
            f"{state.position[0]:.1f}, {state.position[1]:.1f}",
            speed,
            heading,
            escape(_place(state)),
            escape(" ← ".join(state.structure[1:]) or "nothing") + seen,
        )
    return table


def _place(state: State) -> str:
    names = [str(state.place[key]) for key in ("crossing", "link", "lane") if key in state.place]
    beside = state.place.get("d")
    aside = f"{beside:+.1f} m" if isinstance(beside, float) else ""
    return ", ".join([*names, *([aside] if aside else [])]) or "off the road"


def _add_frame(tree: Tree, frame: Frame) -> None:
    images = ", ".join(f"{label} {number}" for label, number in frame.images.items())
    where = images or f"no image, only '{frame.percepts}'"
    branch = tree.add(
        f"[bold]{escape(' = '.join(frame.instants))}[/]  {time_text(frame.time)}  {escape(where)}"
    )
    for seen in frame.seen:
        rests = f"seen as {seen.percept}" if seen.percept else "not seen, predicted"
        place = f"{seen.position[0]:.1f}, {seen.position[1]:.1f} m"
        if seen.pixel is not None:
            place = f"pixel {seen.pixel[0]:.0f}, {seen.pixel[1]:.0f}"
            place += "" if seen.in_view else " (outside of the image)"
        branch.add(f"{escape(seen.symbol)} {escape(rests)} at {place}")


def _mark(holds: bool) -> str:
    return "[green]✓[/]" if holds else "[red]✗[/]"
