"""Judging what comes and goes: configuration blocks and mediations, with all that they build."""

from collections.abc import Iterator

from dyknow.errors import ProcessError
from dyknow.judging.comparing import Comparison
from dyknow.judging.declared import ChangingPart, DeclaredNetwork
from dyknow.judging.judgement import NOT_RECORDED, Basis, Breach, Definition, Draft, Finding
from dyknow.judging.published import PublishedViolations
from dyknow.judging.streams import KnownStreams
from dyknow.judging.wellformed import heartbeat_breaches, order_breaches
from dyknow.runtime.names import output_name
from dyknow.streams.process import Element
from dyknow.streams.sample import Sample

__all__ = ["changing_findings"]


def changing_findings(
    network: DeclaredNetwork, streams: KnownStreams, published: PublishedViolations, keep: int
) -> Iterator[Finding]:
    """Yield a finding for each stream of the part of a network that changes by itself."""
    assert network.changing is not None  # whoever asks has looked
    rerun = _Rerun(streams, sorted(streams.topics - network.static_topics), keep)
    rerun.run(network.changing, published)
    yield from rerun.findings()


class _Rerun:
    """What was recorded, compared with what comes when the part is run again."""

    def __init__(self, streams: KnownStreams, topics: list[str], keep: int) -> None:
        self._streams = streams
        self._drafts: dict[str, Draft] = {}
        self._comparisons: dict[str, Comparison] = {}
        for topic in topics:
            draft = self._drafts[topic] = Draft(topic, _definition(topic, streams), keep)
            if fault := streams.fault(topic):
                whole = "a stream that can be read"
                draft.tally.add([Breach(topic, Definition.MODEL, whole, fault)])
                continue
            samples = streams.as_recorded(topic)
            draft.samples = len(samples)
            draft.tally.add(order_breaches(topic, samples))
            draft.tally.add(heartbeat_breaches(topic, samples, streams.heartbeats(topic)))
            self._comparisons[topic] = Comparison(
                topic, draft.definition, streams[topic], draft.tally
            )
        self._keep = keep

    def run(self, part: ChangingPart, published: PublishedViolations) -> None:
        """Run the part again and compare."""
        if inside := part.sources_within:
            names = ", ".join(f"'{label}'" for label in inside)
            self._leave_open(f"it cannot be computed again without {names}")
            published.leave_rest_open()
            return
        try:
            violations = part.run(self._streams, self._receive)
        except ProcessError as error:
            self._leave_open(f"computing it again failed: {error}")
            published.leave_rest_open()
            return
        for each in violations:
            published.expect((each.provider, each.receiver, each.number), [each.violation])
        for topic, comparison in self._comparisons.items():
            comparison.finish()
            self._drafts[topic].basis = Basis.RECORDED

    def findings(self) -> Iterator[Finding]:
        """Yield what was found, stream by stream."""
        for draft in self._drafts.values():
            yield draft.finished()

    def _receive(self, topic: str, element: Element) -> None:
        if topic in self._comparisons and isinstance(element, Sample):
            self._comparisons[topic].expect(element)
        elif topic not in self._drafts:
            draft = self._drafts[topic] = Draft(topic, Definition.UNIT, self._keep)
            draft.unjudged.append(NOT_RECORDED)

    def _leave_open(self, reason: str) -> None:
        for draft in self._drafts.values():
            draft.unjudged.append(reason)


def _definition(topic: str, streams: KnownStreams) -> Definition:
    """Return by which definition a stream is as it should be; its name shows what it is."""
    if topic.startswith(output_name("")):
        return Definition.STREAM
    label, slash, number = topic.rpartition("/")
    is_input = bool(slash) and number.isdecimal() and label in streams
    return Definition.TERM if is_input else Definition.UNIT
