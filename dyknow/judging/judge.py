"""Does an execution satisfy a specification?

An interpretation is a model of a specification if every declaration holds (Heintz 2009, definition
4.5.3). Each is looked at by itself, inputs before what they feed, with nothing but the
recorded streams it speaks of. Valid times and available times are independent of each other
(section 4.3.2 there): a sample that is available before it is valid, such as a prediction, is as
good as any.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from dyknow.errors import ProcessError
from dyknow.judging.comings import changing_findings
from dyknow.judging.comparing import Comparison
from dyknow.judging.declared import DeclaredNetwork, DeclaredProcess, DeclaredStream
from dyknow.judging.execution import Execution
from dyknow.judging.judgement import (
    NOT_RECORDED,
    PROVIDER_NOT_RECORDED,
    Basis,
    Breach,
    Definition,
    Draft,
    Finding,
    Judgement,
    Tally,
)
from dyknow.judging.published import PublishedViolations, ViolatedStream
from dyknow.judging.recomputing import Recomputation, unknown_behind
from dyknow.judging.streams import KnownStreams
from dyknow.judging.terms import TermBreaches, may_vary, policy_breaches
from dyknow.judging.wellformed import heartbeat_breaches, order_breaches, sort_breaches
from dyknow.runtime.generators import Label
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.sample import Sample

__all__ = ["KEPT", "judge"]

KEPT = 10
"""How many breaches of each stream are kept unless the caller says otherwise."""


OnProgress = Callable[[float, float], None]
"""Told how many declarations have been judged, and how many there are."""


def judge(
    network: DeclaredNetwork,
    execution: Execution,
    keep: int = KEPT,
    on_progress: OnProgress | None = None,
) -> Judgement:
    """Return whether an execution satisfies what is declared, and where it does not.

    Args:
        network: What is declared.
        execution: What there was.
        keep: How many breaches of each stream are kept; the others are counted.
        on_progress: Told how far the work has come.
    """
    judge_at_work = _Judge(network, execution, keep)
    n_all = len(network.static_topics) + 1
    findings: list[Finding] = []
    for finding in judge_at_work.findings():
        findings.append(finding)
        if on_progress is not None:
            on_progress(len(findings), max(n_all, len(findings)))
    undeclared = [f"nothing declares '{topic}'" for topic in judge_at_work.undeclared()]
    return Judgement(tuple(findings), tuple(undeclared))


class _Judge:
    """Looks at one declaration after the other.

    A stream that is found to be at fault is suspected from then on: what does not follow from it
    may still follow from what it should have been, and then it alone is to blame.
    """

    def __init__(self, network: DeclaredNetwork, execution: Execution, keep: int) -> None:
        self._network = network
        self._streams = KnownStreams(execution)
        self._until = self._streams.until
        self._keep = keep
        self._violations = execution.violations()
        self._published = PublishedViolations(self._violations or ())
        self._suspects: set[str] = set()

    def findings(self) -> Iterator[Finding]:
        """Yield a finding for each declaration, inputs before what they feed."""
        for process in self._network.processes.values():
            yield from map(self._term, process.inputs)
            if not process.is_mediation:
                yield self._generator(process)
        yield from map(self._term, self._network.outputs)
        if self._network.changing is not None:
            yield from changing_findings(self._network, self._streams, self._published, self._keep)
        yield self._violation_streams()

    def undeclared(self) -> list[str]:
        """Return the topics that were recorded and that nothing declares."""
        if self._network.changing is not None:
            return []
        return sorted(self._streams.topics - self._network.static_topics)

    def _generator(self, process: DeclaredProcess) -> Finding:
        """Judge the declaration of a stream generator (definitions 4.5.4, 4.5.7 and 4.5.8)."""
        label = process.label
        definition = Definition.SOURCE if process.is_source else Definition.UNIT
        draft = Draft(label, definition, self._keep)
        self._read(label, draft)
        if label in self._streams:
            draft.tally.add(self._wellformed(process))
            draft.unjudged.extend(self._reasons_against_computing(process))
            if not draft.unjudged:
                self._compute(process, draft)
        if draft.basis is Basis.NOTHING:
            self._published.leave_open((label, label, 0))
        return self._finished(draft)

    def _read(self, topic: str, draft: Draft) -> None:
        """Read a stream, if it was recorded and can be read."""
        if not self._streams.may_have_been(topic):
            draft.tally.add([Breach(topic, Definition.MODEL, "such a stream", "none")])
        elif topic not in self._streams:
            draft.unjudged.append(NOT_RECORDED)
        elif fault := self._streams.fault(topic):
            whole = "a stream that can be read"
            draft.tally.add([Breach(topic, Definition.MODEL, whole, fault)])
        else:
            draft.samples = len(self._streams.as_recorded(topic))

    def _wellformed(self, process: DeclaredProcess) -> Iterable[Breach]:
        label = process.label
        samples = self._streams.as_recorded(label)
        yield from order_breaches(label, samples)
        yield from heartbeat_breaches(label, samples, self._streams.heartbeats(label))
        if process.sort_test is not None:
            yield from sort_breaches(label, samples, process.sort_test, process.sort)
        promise = DeclaredStream(label, label, process.promise, label, 0)
        yield from policy_breaches(promise, self._streams[label], ())

    def _reasons_against_computing(self, process: DeclaredProcess) -> list[str]:
        if process.is_source and not process.can_be_made:
            return ["its source cannot be asked again"]
        unknown = unknown_behind(self._network, process.label, self._streams.topics)
        names = ", ".join(f"'{label}'" for label in sorted(set(unknown)))
        return [f"it cannot be computed again without {names}"] if names else []

    def _compute(self, process: DeclaredProcess, draft: Draft) -> None:
        """Compare what was recorded with what follows from the recorded inputs.

        If they differ and something before them is at fault, it may also be what follows from
        what that should have been.
        """
        answer = self._answer(process, frozenset())
        if answer.tally.count and self._suspects:
            other = self._answer(process, self._suspects)
            if other.tally.count < answer.tally.count:
                answer = other
        draft.tally.merge(answer.tally)
        draft.basis = answer.basis
        violations = [each.violation for each in answer.violations]
        self._published.expect((process.label, process.label, 0), violations)

    def _answer(self, process: DeclaredProcess, distrusted: Iterable[str]) -> "_Answer":
        label = process.label
        answer = _Answer(self._keep)
        recomputation = Recomputation(
            self._network, self._streams, frozenset(distrusted) - {label}
        )
        definition = Definition.SOURCE if process.is_source else Definition.UNIT
        comparison = Comparison(label, definition, self._streams[label], answer.tally)
        try:
            recomputation.run(label, comparison.expect, self._until)
        except ProcessError as error:
            answer.tally.add([_failure(label, definition, error)])
        comparison.finish()
        answer.basis, answer.violations = recomputation.basis, recomputation.violations
        return answer

    def _term(self, stream: DeclaredStream) -> Finding:
        """Judge a stream term (definitions 4.5.9 to 4.5.12)."""
        definition = Definition.STREAM if stream.is_output else Definition.TERM
        draft = Draft(stream.topic, definition, self._keep)
        self._read(stream.topic, draft)
        if stream.topic in self._streams:
            draft.tally.add(order_breaches(stream.topic, self._streams.as_recorded(stream.topic)))
        if stream.provider in self._streams:
            self._adapt(stream, draft)
        else:
            self._published.leave_open(_violated(stream))
            draft.unjudged.append(PROVIDER_NOT_RECORDED)
        return self._finished(draft)

    def _adapt(self, stream: DeclaredStream, draft: Draft) -> None:
        """Compare a stream with what its policy allows to make of the provider's samples."""
        adapted: list[Sample[Any]] = []
        recomputation = Recomputation(self._network, self._streams)
        recomputation.run_input(stream, adapted.append, self._until)
        violations = [each.violation for each in recomputation.violations]
        self._published.expect(_violated(stream), violations)
        if stream.topic not in self._streams:
            return
        draft.basis = Basis.RECORDED
        recorded, provider = self._streams[stream.topic], self._streams[stream.provider]
        if may_vary(stream.policy) and not _are_alike(recorded, adapted):
            self._published.leave_open(_violated(stream))
        published = self._published.of(_violated(stream))
        term = TermBreaches(stream, recorded, provider, adapted, self._until)
        draft.tally.add(term.all())
        draft.tally.add(policy_breaches(stream, recorded, published))

    def _violation_streams(self) -> Finding:
        draft = Draft("violations", Definition.POLICY, self._keep)
        if self._violations is None:
            draft.unjudged.append("violations were not recorded")
            return draft.finished()
        draft.samples = len(self._violations)
        draft.basis = Basis.RECORDED
        draft.tally.add(self._published.breaches())
        return draft.finished()

    def _finished(self, draft: Draft) -> Finding:
        if draft.tally.count:
            self._suspects.add(draft.stream)
        return draft.finished()


class _Answer:
    """What came out when a process was run again."""

    def __init__(self, keep: int) -> None:
        self.tally = Tally(keep)
        self.basis = Basis.NOTHING
        self.violations: Sequence[StreamViolation] = ()


def _are_alike(one: Sequence[Sample[Any]], other: Sequence[Sample[Any]]) -> bool:
    return [each.valid_time for each in one] == [each.valid_time for each in other]


def _violated(stream: DeclaredStream) -> ViolatedStream:
    return stream.provider, stream.receiver, stream.number


def _failure(label: Label, definition: Definition, error: ProcessError) -> Breach:
    cause = error.__cause__
    found = f"a failure: {type(cause).__name__}: {cause}"
    return Breach(
        label, definition, "an answer to the recorded inputs", found, error.time, error.time
    )
