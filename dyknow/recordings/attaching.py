"""From a network to a recorder: a tap on each stream generator and on each adapted stream."""

import json
from collections.abc import Callable, Mapping
from typing import Protocol

from dyknow.kpl.description import NetworkDescription
from dyknow.kpl.network import Network
from dyknow.recordings.taps import GeneratorTap, StreamTap
from dyknow.runtime.generators import Label, StreamGenerator
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.names import input_name, output_name
from dyknow.runtime.subscriptions import StreamProxy, StreamViolation

__all__ = ["Attachment", "Taps", "Wanted"]


class Taps(Protocol):
    """What makes taps: a recorder."""

    def generator(self, label: str, about: Mapping[str, str] | None = None) -> GeneratorTap:
        """Return what takes the samples of a stream generator."""

    def stream(
        self, topic: str, provider: str, about: Mapping[str, str] | None = None
    ) -> StreamTap:
        """Return what takes the samples of an adapted stream."""

    def violation(self, violation: StreamViolation) -> None:
        """Take a violation."""

    def annotate(self, metadata: Mapping[str, str]) -> None:
        """Take texts about the whole recording."""


Wanted = Callable[[str], bool]
"""Returns whether the generator of a label is to be recorded."""


class Attachment:
    """Taps the streams of a network, and those that come while it runs.

    A stream whose provider is not recorded is not recorded either. Of the violations those of
    recorded streams are.
    """

    def __init__(self, taps: Taps, network: Network | Kernel, wanted: Wanted) -> None:
        self._taps = taps
        self._network = None if isinstance(network, Kernel) else network
        self._kernel = network if isinstance(network, Kernel) else network.kernel
        self._wanted = wanted
        self._generators: dict[Label, tuple[GeneratorTap, StreamGenerator]] = {}
        self._streams: dict[str, tuple[StreamTap, StreamProxy]] = {}
        self._told: StreamViolation | None = None
        self._ends = [self._kernel.subscribe_violations(self._take_violation)]
        if self._network is not None:
            taps.annotate({"network": json.dumps(self._network.description)})
            self._ends.append(self._network.subscribe_changes(self._take_change))
        self.refresh()

    def refresh(self) -> None:
        """Tap what has come since this was last done.

        After changes of a network with declarations this is done by itself; a kernel's user
        calls it after changes, between two instants.
        """
        about = _About(None if self._network is None else self._network.description)
        for label in self._kernel.labels:
            if self._wanted(label):
                self._tap_generator(label, about.generator(label))
        for proxy in self._kernel.streams:
            if proxy.number and proxy.provider in self._generators:
                topic = input_name(proxy.receiver, proxy.number)
                self._tap_stream(topic, proxy, about.input(proxy.receiver, proxy.number))
        for name in self._network.outputs if self._network is not None else ():
            self._tap_output(name, about.output(name))

    def end(self) -> None:
        """Take nothing more."""
        for end in self._ends:
            end()
        for _, generator in self._generators.values():
            generator.disconnect(self)
        self._ends.clear()
        self._generators.clear()
        self._streams.clear()

    def _tap_generator(self, label: Label, about: Mapping[str, str]) -> None:
        generator = self._kernel.generator(label)
        tap, known = self._generators.get(label, (None, None))
        if generator is not known:
            tap = tap or self._taps.generator(label, about)
            generator.connect(self, tap, tap)
            self._generators[label] = (tap, generator)

    def _tap_stream(self, topic: str, proxy: StreamProxy, about: Mapping[str, str]) -> None:
        tap, known = self._streams.get(topic, (None, None))
        if proxy is not known:
            tap = tap or self._taps.stream(topic, proxy.provider, about)
            self._ends.append(proxy.tap(tap, tap))
            self._streams[topic] = (tap, proxy)

    def _tap_output(self, name: str, about: Mapping[str, str]) -> None:
        topic = output_name(name)
        _, known = self._streams.get(topic, (None, None))
        is_recorded = about.get("provider") in self._generators
        if self._network is not None and is_recorded and (known is None or known.has_ended):
            self._tap_stream(topic, self._network.subscribe(name, _ignore), about)

    def _take_change(self, _: object) -> None:
        self.refresh()

    def _take_violation(self, violation: StreamViolation) -> None:
        """Hand on a violation; once if several receivers share a stream and are called alike."""
        told, self._told = self._told, violation
        is_repeated = (
            told is not None
            and told.violation is violation.violation
            and (told.receiver, told.number) == (violation.receiver, violation.number)
        )
        if violation.provider in self._generators and not is_repeated:
            self._taps.violation(violation)


class _About:
    """What the description of a network says about its streams, as texts."""

    def __init__(self, description: NetworkDescription | None) -> None:
        known = description or NetworkDescription(generators=[], outputs=[])
        self._generators = {each["label"]: each for each in known["generators"]}
        self._outputs = {each["name"]: each for each in known["outputs"]}

    def generator(self, label: str) -> Mapping[str, str]:
        """Return what is said about a stream generator and its process."""
        described = self._generators.get(label)
        return {} if described is None else _texts(described)

    def input(self, label: str, number: int) -> Mapping[str, str]:
        """Return what is said about an input of a process."""
        described = self._generators.get(label)
        inputs = [] if described is None else described["inputs"]
        return next((_texts(each) for each in inputs if each["number"] == number), {})

    def output(self, name: str) -> Mapping[str, str]:
        """Return what is said about an output."""
        described = self._outputs.get(name)
        return {} if described is None else _texts(described)


def _texts(described: Mapping[str, object]) -> dict[str, str]:
    return {name: value for name, value in described.items() if isinstance(value, str)}


def _ignore(_: object) -> None:
    """Do nothing with a sample that is recorded on its way."""
