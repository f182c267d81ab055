"""Tables and progress bars that the commands share."""

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from traffic.maps import MapSummary
from traffic.results import (
    RecklessDriverResult,
    RecognitionResult,
    Replay,
    RunResult,
    Score,
    car_names,
)

__all__ = ["progress", "show_network", "show_result", "show_scores"]

_VERDICTS = {True: "[green]yes[/]", False: "[red]no[/]", None: "[dim]not in view[/]"}
_UNKNOWN = "[dim]unknown[/]"


@contextmanager
def progress(
    doing: str = "simulating", unit: str = "s"
) -> Iterator[Callable[[float, float], None]]:
    """Give a function to call with how much is done and how much in all, shown on a terminal."""
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[at]}"))
    console = Console(stderr=True)
    with Progress(
        *columns, TimeRemainingColumn(), console=console, disable=not sys.stderr.isatty()
    ) as bar:
        task = bar.add_task(doing, at="")

        def on_progress(done: float, total: float) -> None:
            bar.update(task, completed=done, total=total, at=f"{done:.0f} of {total:.0f} {unit}")

        yield on_progress


def show_result(result: RunResult) -> None:
    """Print the recognitions, what was missed, the score and the timing as tables.

    Of a replay it is said before what has changed since the recording, and last how the streams
    compare.
    """
    console = Console()
    settings = ", ".join(f"{k} {v}" for k, v in result.settings.items() if v is not None)
    console.print(f"[bold]{escape(result.scenario)}[/]: {escape(settings)}", highlight=False)
    if result.replay is not None:
        for line in _about(result.replay):
            console.print(line, highlight=False)
    console.print(_recognitions(result))
    if result.missed:
        console.print(_missed(result))
    if result.reckless_drivers:
        console.print(_reckless_drivers(result.reckless_drivers))
    if result.score:
        console.print(_scores({"": result.score}))
    console.print(_timing(result))
    for line in _remarks(result):
        console.print(line, highlight=False)


def show_scores(score_by_run: Mapping[str, Mapping[str, Score]]) -> None:
    """Print the scores of several runs as one table."""
    Console().print(_scores(score_by_run))


def show_network(summary: MapSummary) -> None:
    """Print the crossings of a map as a table."""
    side = "left" if summary.left_hand else "right"
    title = (
        f"{summary.network}: {len(summary.crossings)} crossings, {summary.links} links, "
        f"{summary.lanes} lanes, driving on the {side}"
    )
    table = Table(
        "crossing", "centre, m", "links", "ways through", box=SIMPLE_HEAD, title=escape(title)
    )
    for crossing in summary.crossings:
        turns = ", ".join(f"{count} {turn}" for turn, count in crossing.turns.items())
        x, y = crossing.centre
        table.add_row(
            escape(crossing.name), f"{x:.0f}, {y:.0f}", escape("\n".join(crossing.links)), turns
        )
    Console().print(table)


def _recognitions(result: RunResult) -> Table:
    table = Table(
        "N",
        "from s",
        "to s",
        "recognised",
        "who",
        "where",
        "truth agrees",
        box=SIMPLE_HEAD,
        title="Recognised",
    )
    for number, recognition in enumerate(result.recognitions, start=1):
        table.add_row(
            str(number),
            f"{recognition.begin / 1000:.1f}",
            f"{recognition.end / 1000:.1f}",
            escape(recognition.chronicle.replace("_", " ")),
            _who(recognition),
            _where(recognition),
            _verdict(recognition, result.score),
        )
    return table


def _verdict(recognition: RecognitionResult, score: Mapping[str, Score]) -> str:
    is_judged = recognition.agrees is not None or recognition.kind in score
    return _VERDICTS[recognition.agrees] if is_judged else _UNKNOWN


def _who(recognition: RecognitionResult) -> str:
    truth = recognition.truth or {}
    cars = [(name, recognition.arguments[name]) for name in car_names(recognition.arguments)]
    return ", ".join(f"{escape(v)} [dim]({escape(truth.get(k, '?'))})[/]" for k, v in cars)


def _where(recognition: RecognitionResult) -> str:
    cars = car_names(recognition.arguments)
    places = [v for k, v in recognition.arguments.items() if k not in cars]
    return escape(" → ".join(places))


def _missed(result: RunResult) -> Table:
    table = Table(
        "from s", "to s", "manoeuvre", "vehicles", "where", box=SIMPLE_HEAD, title="Missed"
    )
    for manoeuvre in result.missed:
        table.add_row(
            f"{manoeuvre.begin / 1000:.1f}",
            f"{manoeuvre.end / 1000:.1f}",
            escape(manoeuvre.kind.replace("_", " ")),
            escape(", ".join(manoeuvre.vehicles)),
            escape(" → ".join(manoeuvre.place)),
        )
    return table


def _reckless_drivers(drivers: Sequence[RecklessDriverResult]) -> Table:
    columns = ("since s", "until s", "who", "reckless acts", "last at s")
    table = Table(*columns, box=SIMPLE_HEAD, title="Reckless drivers")
    for driver in drivers:
        table.add_row(
            f"{driver.since / 1000:.1f}",
            "–" if driver.until is None else f"{driver.until / 1000:.1f}",
            escape(driver.car),
            str(driver.acts),
            f"{driver.last_act_at / 1000:.1f}",
        )
    return table


def _scores(score_by_run: Mapping[str, Mapping[str, Score]]) -> Table:
    counts = ("true", "recognised", "correct", "precision", "recall", "left out")
    caption = "left out: true, but not wholly in view"
    table = Table("", "", *counts, box=SIMPLE_HEAD, title="Score", caption=caption)
    for run, score_by_kind in score_by_run.items():
        for kind, score in score_by_kind.items():
            table.add_row(escape(run), escape(kind.replace("_", " ")), *_row(score))
    return table


def _row(score: Score) -> list[str]:
    shares = ["–" if s is None else f"{s:.3f}" for s in (score.precision, score.recall)]
    counts = [str(count) for count in (score.truth, score.recognised, score.correct)]
    return [*counts, *shares, str(score.left_out)]


def _timing(result: RunResult) -> Table:
    timing = result.timing
    title = (
        f"{timing.simulated_s:.0f} s simulated in {timing.wall_s:.1f} s: "
        f"{timing.real_time_factor:.1f} times real time"
    )
    table = Table("stage", "CPU s", "share", box=SIMPLE_HEAD, title=title)
    if timing.lateness is not None:
        late = timing.lateness
        table.caption = (
            f"done {late.mean_ms:.1f} ms after each instant on average, {late.max_ms:.1f} ms "
            f"at most; {late.late_share:.1%} of the instants missed the deadline"
        )
        if late.period_changes:
            table.caption += f"; sample periods were changed {late.period_changes} times"
    total = sum(timing.stages.values()) or 1.0
    for stage, spent in sorted(timing.stages.items(), key=lambda item: -item[1]):
        table.add_row(escape(stage), f"{spent:.2f}", f"{spent / total:.0%}")
    return table


def _remarks(result: RunResult) -> Iterator[str]:
    """Yield what else is to be said after the tables."""
    for failure in result.failures:
        yield f"[red]{escape(failure)}[/]; it has ended"
    if result.violations:
        yield _violations(result)
    if result.replay is not None:
        yield from _comparison(result.replay)


def _violations(result: RunResult) -> str:
    total = sum(result.violations.values())
    streams = ", ".join(f"{escape(name)} {count}" for name, count in result.violations.items())
    return f"{total} {'violation' if total == 1 else 'violations'} of policies: {streams}"


def _about(replay: Replay) -> Iterator[str]:
    yield from map(escape, replay.notes)
    if replay.changes:
        yield escape(f"what may make a difference: {'; '.join(replay.changes)}")
    if replay.taken:
        yield escape(f"taken from the recording: {', '.join(replay.taken)}")


def _comparison(replay: Replay) -> Iterator[str]:
    for difference in replay.differences:
        at = f"{difference.at:g} ms"
        yield (
            f"[red]differs[/] {escape(difference.stream)} at {at}, recorded and replayed: "
            f"{escape(difference.what)}"
        )
    streams = "stream" if replay.compared == 1 else "streams"
    if replay.differences:
        yield f"{replay.identical} of {replay.compared} {streams} identical"
    else:
        yield f"{replay.compared} {streams} identical"
