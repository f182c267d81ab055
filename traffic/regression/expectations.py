"""What was recognised in a recording, as text that people read and compare line by line."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from traffic.results import Manoeuvre, RecklessDriverResult, RecognitionResult, RunResult

__all__ = ["Tally", "tally_of", "text_from_result"]

_VERDICTS = {True: "true", False: "false", None: "not in view"}
_LINE = re.compile(r" *[\d.]+ +[\d.]+  (missed: )?(\w+).*?(?:: (true|false|not in view))?")
_MISSED = "missed"


@dataclass(frozen=True, slots=True)
class Tally:
    """What is expected of a recording, counted.

    Attributes:
        counts: How often each chronicle is recognised, by what the truth says about it, and how
            often each kind of manoeuvre is `missed`.
    """

    counts: Mapping[str, Mapping[str, int]]

    def names(self, verdict: str) -> tuple[str, ...]:
        """Return the chronicles of which the truth says this at least once, in order of name."""
        return tuple(sorted(self.counts.get(verdict, {})))

    def __str__(self) -> str:
        parts = []
        for verdict in (*_VERDICTS.values(), _MISSED):
            if counted := self.counts.get(verdict):
                listed = ", ".join(f"{name} {n}" for name, n in sorted(counted.items()))
                parts.append(f"{verdict}: {listed}")
        return "; ".join(parts) or "nothing"


def text_from_result(result: RunResult) -> str:
    """Return what was recognised and what was missed, a line each, in order of time.

    A line has the beginning and the end in seconds, what was recognised, of whom and where, when
    that was certain, and what the truth says about it. Reckless drivers and processes that failed
    come last.
    """
    known = {k: v for k, v in result.settings.items() if v is not None}
    settings = ", ".join(
        f"{k} {v:g}" if isinstance(v, float) else f"{k} {v}" for k, v in known.items()
    )
    lines = [f"{result.scenario}: {settings}", *sorted(_lines(result))]
    lines += [_reckless(each) for each in result.reckless_drivers or ()]
    return "\n".join([*lines, *result.failures]) + "\n"


def tally_of(text: str) -> Tally:
    """Return what a text of `text_from_result` says, counted."""
    counts: dict[str, Counter[str]] = {}
    for line in text.splitlines()[1:]:
        if (match := _LINE.fullmatch(line)) is not None:
            verdict = _MISSED if match[1] else match[3]
            if verdict is not None:
                counts.setdefault(verdict, Counter())[match[2]] += 1
    return Tally(counts)


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


def _reckless(each: RecklessDriverResult) -> str:
    until = f"{each.until / 1000:8.1f}" if each.until is not None else "       –"
    acts = f"{each.acts} reckless act{'' if each.acts == 1 else 's'}"
    return f"{each.since / 1000:8.1f} {until}  {each.symbol} is {each.car}: {acts}"
