"""What was recognised in a recording, as text that people read and compare line by line."""

from collections.abc import Iterator

from traffic.results import Manoeuvre, RecognitionResult, RunResult

__all__ = ["text_from_result"]

_VERDICTS = {True: "true", False: "false", None: "not in view"}


def text_from_result(result: RunResult) -> str:
    """Return what was recognised and what was missed, a line each, in order of time.

    A line has the beginning and the end in seconds, what was recognised, of whom and where, when
    that was certain, and what the truth says about it.
    """
    settings = ", ".join(f"{k} {v}" for k, v in result.settings.items() if v is not None)
    lines = [f"{result.scenario}: {settings}", *sorted(_lines(result))]
    return "\n".join(lines) + "\n"


def _lines(result: RunResult) -> Iterator[str]:
    for each in result.recognitions:
        yield f"{_span(each)}  {_recognised(each)}"
    for missed in result.missed:
        what = " ".join([missed.kind, *missed.vehicles, *missed.place])
        yield f"{_span(missed)}  missed: {what}"


def _span(each: RecognitionResult | Manoeuvre) -> str:
    return f"{each.begin / 1000:8.1f} {each.end / 1000:8.1f}"


def _recognised(each: RecognitionResult) -> str:
    arguments = ", ".join(f"{name} = {value}" for name, value in each.arguments.items())
    vehicles = " ".join((each.truth or {}).values()) or "nobody"
    certain = f"certain at {each.recognised_at / 1000:.1f}"
    return f"{each.chronicle}[{arguments}]  {certain}  {vehicles}: {_VERDICTS[each.agrees]}"
