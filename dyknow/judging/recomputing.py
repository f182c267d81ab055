"""What a process makes of the streams that an execution has recorded for it.

One process at a time is run by the kernel, fed with its recorded input streams (the join of
Heintz 2009, definition 4.3.16, as in the run itself), so that one wrong stream does not spoil the
judging of others. An input that was not recorded is made from its provider's stream, and if that
was not recorded either, the provider is run as well.
"""

from collections.abc import Callable, Collection, Iterator
from typing import Any

from dyknow.judging.declared import DeclaredNetwork, DeclaredProcess, DeclaredStream
from dyknow.judging.judgement import Basis
from dyknow.judging.streams import KnownStreams
from dyknow.runtime.generators import ANYTHING, Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import Policy
from dyknow.streams.process import Element
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["Recomputation", "Recorded", "unknown_behind"]


def unknown_behind(
    network: DeclaredNetwork, label: Label, known: Collection[str]
) -> Iterator[Label]:
    """Yield each source without which the process at *label* cannot be run again.

    *known* has the topics of the recorded streams.
    """
    process = network.processes[label]
    if not process.can_be_made:
        yield label
    for stream in process.inputs:
        if stream.topic not in known and stream.provider not in known:
            yield from unknown_behind(network, stream.provider, known)


class Recomputation:
    """A kernel with one process of a network, fed with recorded streams.

    Args:
        network: What is declared.
        streams: What was recorded.
        distrusted: Topics of recorded streams that are at fault, in place of which they are made
            again from what feeds them, if that is possible.

    Attributes:
        violations: What the process published itself.
    """

    def __init__(
        self,
        network: DeclaredNetwork,
        streams: KnownStreams,
        distrusted: frozenset[str] = frozenset(),
    ) -> None:
        self.violations: list[StreamViolation] = []
        self._network = network
        self._streams = streams
        self._distrusted = distrusted
        self._kernel = Kernel()
        self._bases = {Basis.RECORDED}

    @property
    def basis(self) -> Basis:
        """What the process was fed with."""
        for basis in (Basis.CORRECTED, Basis.COMPUTED):
            if basis in self._bases:
                return basis
        return Basis.RECORDED

    def run(self, label: Label, receive: Callable[[Sample[Any]], None], until: TimePoint) -> None:
        """Hand to *receive* what the process at *label* makes up to the time *until*.

        Raises:
            ProcessError: The process fails on what was recorded.
        """
        self._add(self._network.processes[label])
        self._kernel.subscribe(label, receive)
        self._kernel.subscribe_violations(self._note(label))
        self._kernel.run(until)

    def run_input(
        self, stream: DeclaredStream, receive: Callable[[Sample[Any]], None], until: TimePoint
    ) -> None:
        """Hand to *receive* what the policy of a stream makes of its provider's samples.

        The violations of the policy are kept in `violations`.
        """
        self._add_provider(stream.provider)
        self._kernel.subscribe_violations(self.violations.append)
        self._kernel.subscribe(stream.provider, receive, stream.policy)
        self._kernel.run(until)

    def _note(self, label: Label) -> Callable[[StreamViolation], None]:
        def note(violation: StreamViolation) -> None:
            if violation.provider == violation.receiver == label:
                self.violations.append(violation)

        return note

    def _add(self, process: DeclaredProcess) -> None:
        if process.label in self._kernel.labels:
            return
        if process.make_unit is not None:
            inputs = [self._input(stream) for stream in process.inputs]
            unit, on_failure = process.make_unit(), process.on_failure
            self._kernel.add_unit(process.label, unit, inputs, on_failure=on_failure)
        else:
            assert process.make_source is not None  # whoever recomputes has looked
            self._kernel.add_source(process.label, process.make_source())

    def _input(self, stream: DeclaredStream) -> tuple[Label, Policy]:
        topic = Label(stream.topic)
        if topic in self._streams and not {topic, stream.provider} & self._distrusted:
            self._kernel.add_source(topic, Recorded(self._streams, topic))
            return topic, ANYTHING
        if topic in self._distrusted:
            self._bases.add(Basis.CORRECTED)
        self._add_provider(stream.provider)
        return stream.provider, stream.policy

    def _add_provider(self, label: Label) -> None:
        if label in self._kernel.labels:
            return
        known = self._streams.topics - self._distrusted
        is_lost = label not in known and any(unknown_behind(self._network, label, known))
        if label in known or (is_lost and label in self._streams):
            self._kernel.add_source(label, Recorded(self._streams, label))
            return
        self._bases.add(Basis.CORRECTED if label in self._distrusted else Basis.COMPUTED)
        self._add(self._network.processes[label])


class Recorded:
    """A source of what was recorded of a stream."""

    def __init__(self, streams: KnownStreams, topic: str) -> None:
        self._streams = streams
        self._topic = topic

    def samples(self) -> Iterator[Element]:
        """Yield samples and heartbeats."""
        yield from self._streams.elements(self._topic)
