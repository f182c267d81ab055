"""The kernel: the only loop, which gives every process its turn in virtual time.

The order of events is a matter of definition, not of chance. Everything that happens at one
instant is ordered by depth in the network: a process is called once per instant, with all the
new samples of its inputs (the join of Heintz 2009, definition 4.3.16), after everything that
feeds it. At one instant arrivals come before alarms: a sample that arrives at the deadline is
in time. Sources are read lazily: a source is asked for its next sample when all that follows
from the last one has been done.
"""

import time
from collections.abc import Callable, Mapping, Sequence

from dyknow.runtime.accounts import Account
from dyknow.runtime.agenda import Agenda
from dyknow.runtime.generators import Label, Receive, StreamGenerator
from dyknow.runtime.processes import RunningSource, RunningUnit
from dyknow.runtime.subscriptions import (
    FilteredSubscription,
    StreamViolation,
    Subscription,
)
from dyknow.streams.adapter import Adapter, adapter_for
from dyknow.streams.ordering import Filter
from dyknow.streams.policy import Policy, Violation
from dyknow.streams.process import ComputationalUnit, Source
from dyknow.time import TimePoint

__all__ = ["Kernel"]

Input = tuple[Label, Policy]
"""A stream as a process asks for it: the generator's label and a policy."""

ANYTHING = Policy()
"""The policy that restricts nothing."""


class Kernel:
    """Runs a network of sources and computational units.

    Processes are added first, inputs before those that use them, and may be added between two
    runs as well. The kernel's clock is virtual: it stands at the instant being worked on and
    moves as fast as the work allows.

    Attributes:
        now: The instant being worked on, or up to which everything has been done.
        accounts: Calls, samples, processor seconds and violations of each process, by label.
    """

    def __init__(self, meter: Callable[[], float] = time.thread_time) -> None:
        """Make an empty network; *meter* tells processor seconds, for the accounts alone."""
        self.now = TimePoint(0)
        self._meter = meter
        self._agenda = Agenda()
        self._generators: dict[Label, StreamGenerator] = {}
        self._sources: list[RunningSource] = []
        self._units: list[RunningUnit] = []
        self._subscriptions: list[Subscription] = []
        self._violation_receivers: list[Callable[[StreamViolation], None]] = []
        self._is_stopped = False

    @property
    def accounts(self) -> Mapping[Label, Account]:
        """The accounts of all processes, in the order in which they were added."""
        return {label: generator.account for label, generator in self._generators.items()}

    @property
    def labels(self) -> Sequence[Label]:
        """The labels of all stream generators, in the order in which they were added."""
        return tuple(self._generators)

    def add_source(self, label: Label, source: Source) -> None:
        """Add a source whose samples come out of a new stream generator called *label*.

        Raises:
            ValueError: There is a generator of this name already.
        """
        generator = self._new_generator(label, 0)
        self._sources.append(RunningSource(source, generator, self._agenda, self._meter))

    def add_unit(self, label: Label, unit: ComputationalUnit, inputs: Sequence[Input]) -> None:
        """Add a computational unit that is fed by streams of generators added before.

        Raises:
            ValueError: There is a generator of this name already, or none of an input's name.
        """
        providers = [self._generator(provider) for provider, _ in inputs]
        depth = 1 + max((provider.depth for provider in providers), default=0)
        generator = self._new_generator(label, depth)

        def publish(violation: Violation) -> None:
            self._publish(StreamViolation(label, label, violation))

        running = RunningUnit(unit, len(inputs), generator, self._agenda, self._meter, publish)
        self._units.append(running)
        for at, (provider, policy) in enumerate(inputs):
            self._connect(provider, label, running.receiver(at), policy)

    def subscribe(
        self, label: Label, receive: Receive, policy: Policy = ANYTHING
    ) -> Callable[[], None]:
        """Hand the samples of a stream to *receive*, and return what ends the subscription.

        Raises:
            ValueError: There is no generator called *label*.
        """
        return self._connect(label, Label("output"), receive, policy)

    def subscribe_violations(self, receive: Callable[[StreamViolation], None]) -> None:
        """Hand every violation of a policy, in any stream of the network, to *receive*."""
        self._violation_receivers.append(receive)

    def run(
        self,
        until: TimePoint | None = None,
        on_time: Callable[[TimePoint], None] | None = None,
    ) -> None:
        """Work until the time *until*, inclusive, or to the end of all sources.

        With *until*, alarms that fall due after the last sample of the sources ring as well.
        Without it the run ends when no source has another sample and all samples have been
        delivered; alarms that would ring later than that do not. *on_time* is told each new
        instant before its work begins. A run can be continued by another one.

        Raises:
            ProcessError: A process failed; the cause is attached.
        """
        self._is_stopped = False
        for source in self._sources:
            source.start(self.now)
        for unit in self._units:
            unit.start(self.now)
        while (instant := self._next_instant(until)) is not None:
            self.now = instant
            if on_time is not None:
                on_time(instant)
            self._agenda.hold_instant(instant)
        if until is not None and not self._is_stopped:
            self.now = max(self.now, until)

    def stop(self) -> None:
        """End the current run when the work of the current instant is done."""
        self._is_stopped = True

    def _next_instant(self, until: TimePoint | None) -> TimePoint | None:
        instant = self._agenda.next_time()
        if self._is_stopped or instant is None:
            return None
        if until is None:
            return instant if self._is_fed() else None
        return instant if instant <= until else None

    def _is_fed(self) -> bool:
        if not all(source.has_ended for source in self._sources):
            return True
        if any(generator.next_release is not None for generator in self._generators.values()):
            return True
        return any(subscription.is_waiting for subscription in self._subscriptions)

    def _generator(self, label: Label) -> StreamGenerator:
        if label not in self._generators:
            raise ValueError(f"no stream generator called '{label}'")
        return self._generators[label]

    def _new_generator(self, label: Label, depth: int) -> StreamGenerator:
        if label in self._generators:
            raise ValueError(f"there is a stream generator called '{label}' already")
        generator = self._generators[label] = StreamGenerator(label, depth)
        return generator

    def _connect(
        self, provider: Label, receiver: Label, receive: Receive, policy: Policy
    ) -> Callable[[], None]:
        generator = self._generator(provider)
        adapter = adapter_for(policy, self.now)
        if isinstance(adapter, Filter):
            receive = FilteredSubscription(
                provider, receiver, receive, adapter, self._publish
            ).receive
        elif adapter is not None:
            return self._connect_sampled(generator, receiver, receive, adapter)
        generator.connect(receive)
        return lambda: generator.disconnect(receive)

    def _connect_sampled(
        self, generator: StreamGenerator, receiver: Label, receive: Receive, adapter: Adapter
    ) -> Callable[[], None]:
        subscription = Subscription(
            generator, receiver, receive, adapter, self._agenda, self._publish
        )
        self._subscriptions.append(subscription)
        generator.connect(subscription.receive)

        def end() -> None:
            generator.disconnect(subscription.receive)
            self._subscriptions.remove(subscription)
            subscription.end()

        return end

    def _publish(self, violation: StreamViolation) -> None:
        receiver = self._generators.get(violation.receiver)
        if receiver is not None:
            receiver.account.violations += 1
        for receive in self._violation_receivers:
            receive(violation)
