"""What was found when a run was judged, in words."""

from collections.abc import Iterator, Sequence

from rich.console import Console
from rich.markup import escape

from dyknow.judging.judgement import Basis, Breach, Definition, Finding, Judgement
from dyknow.time import text_from_duration
from traffic.judging import JudgedRun

__all__ = ["show_judgement"]

_PROCESSES = (Definition.SOURCE, Definition.UNIT)
_NAMED = 6
"""How many streams a line names."""


def show_judgement(judged: JudgedRun) -> None:
    """Print whether the run satisfies the specification, each breach, and what is left open."""
    console = Console(highlight=False, soft_wrap=True)
    judgement = judged.judgement
    what = "its specification"
    if judged.specification is not None:
        what = f"'{judged.specification}'"
    verdict = "[green]satisfies[/]" if judgement.is_satisfied else "[red]does not satisfy[/]"
    console.print(f"[bold]{escape(str(judged.recording))}[/] {verdict} {escape(what)}")
    console.print(f"  {escape(_counts(judgement))}")
    for finding in judgement.findings:
        for line in _broken(finding):
            console.print(line)
    for line in _left_open(judgement):
        console.print(f"[dim]{escape(line)}[/]")


def _counts(judgement: Judgement) -> str:
    findings = judgement.findings
    samples = sum(finding.samples for finding in findings)
    processes = [each for each in findings if each.definition in _PROCESSES]
    computed = sum(each.basis is not Basis.NOTHING for each in processes)
    breaches = judgement.breach_count
    broken = f"; {breaches} breach{'es' if breaches > 1 else ''}" if breaches else ""
    return (
        f"{len(findings)} streams, {samples} samples, "
        f"{computed} of {len(processes)} processes computed again{broken}"
    )


def _broken(finding: Finding) -> Iterator[str]:
    if finding.holds:
        return
    yield f"[red]{escape(finding.stream)}[/]"
    for breach in finding.breaches:
        place = f"{escape(_place(breach))}: " if breach.valid_time is not None else ""
        definition = f"[dim]({escape(_about(breach.definition))})[/]"
        expected, found = escape(breach.expected), escape(breach.found)
        yield f"  {place}expected {expected}, found {found} {definition}"
    if finding.breach_count > len(finding.breaches):
        yield f"  and {finding.breach_count - len(finding.breaches)} more"


def _names(findings: Sequence[Finding]) -> str:
    """Name streams, generators first; of many, the first few."""
    generators = [each.stream for each in findings if each.definition in _PROCESSES]
    adapted = [each.stream for each in findings if each.definition not in _PROCESSES]
    named = (generators or adapted)[:_NAMED]
    rest = len(findings) - len(named)
    return ", ".join(named) + (f" and {rest} more" if rest else "")


def _about(definition: Definition) -> str:
    number = definition.value
    return number if not number[0].isdigit() else f"definition {number}"


def _place(breach: Breach) -> str:
    assert breach.valid_time is not None  # whoever asks has looked
    assert breach.available_time is not None
    valid, available = map(text_from_duration, (breach.valid_time, breach.available_time))
    return f"valid at {valid}, available at {available}"


def _left_open(judgement: Judgement) -> Iterator[str]:
    """Yield what could not be judged, one line for each reason; of each stream the first one."""
    findings: dict[str, list[Finding]] = {}
    for finding in judgement.findings:
        for reason in finding.unjudged[:1]:
            findings.setdefault(reason, []).append(finding)
    for reason, unjudged in findings.items():
        yield f"not judged: {_names(unjudged)}: {reason}"
    for reason in judgement.unjudged:
        yield f"not judged: {reason}"
