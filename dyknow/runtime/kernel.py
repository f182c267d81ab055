"""The kernel: the only loop, which gives every process its turn.

The order of events is a matter of definition, not of chance. Everything that happens at one
instant is ordered by depth in the network: a process is called once per instant, with all the
new samples of its inputs (the join of Heintz 2009, definition 4.3.16), after everything that
feeds it. At one instant arrivals come before alarms: a sample that arrives at the deadline is
in time. Sources are read lazily: a source is asked for its next sample when all that follows
from the last one has been done.

The network can be changed at any time, also by what it calls. An instant is worked on by one
network: what is asked for during its work happens when that work is done.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

from dyknow.errors import (
    LabelAlreadyExistsError,
    LabelInUseError,
    NoSuchLabelError,
    PolicyNotSupportedError,
)
from dyknow.runtime.accounts import Account
from dyknow.runtime.agenda import Agenda
from dyknow.runtime.changes import Changes
from dyknow.runtime.clock import Clock, VirtualClock
from dyknow.runtime.failures import Failure, OnFailure
from dyknow.runtime.generators import ANYTHING, Beat, Receive, StreamGenerator
from dyknow.runtime.names import OUTPUT, Label
from dyknow.runtime.processes import (
    RunningProcess,
    RunningSource,
    RunningUnit,
    Surroundings,
)
from dyknow.runtime.subscriptions import (
    Receiver,
    StreamProxy,
    StreamViolation,
    Subscriptions,
    ViolationReceiver,
)
from dyknow.source_text import nearest_name
from dyknow.streams.policy import Policy, Violation
from dyknow.streams.process import ComputationalUnit, Source
from dyknow.time import TimePoint

__all__ = ["Kernel"]

Input = tuple[Label, Policy]
"""A stream as a process asks for it: the generator's label and a policy."""


class Kernel:
    """Runs a network of sources and computational units.

    Processes are added first, inputs before those that use them; they can be added, removed and
    subscribed to while the network runs as well.

    Attributes:
        now: The instant being worked on, or up to which everything has been done.
    """

    def __init__(self, meter: Callable[[], float] = time.thread_time) -> None:
        """Make an empty network; *meter* tells processor seconds, for the accounts alone."""
        self.now = TimePoint(0)
        self._agenda = Agenda()
        self._changes = Changes()
        self._processes: dict[Label, RunningProcess] = {}
        self._unstarted: list[RunningProcess] = []
        self._subscriptions = Subscriptions(self._agenda, self._changes, self._publish)
        self._surroundings = Surroundings(self._agenda, meter, self._publish_own, self._report)
        self._violation_receivers: list[ViolationReceiver] = []
        self._failure_receivers: list[Callable[[Failure], None]] = []
        self._is_running = False
        self._is_stopped = False

    @property
    def processes(self) -> Mapping[Label, RunningProcess]:
        """All processes by label, in the order in which they were added."""
        return MappingProxyType(self._processes)

    @property
    def accounts(self) -> Mapping[Label, Account]:
        """Calls, samples, processor seconds, violations and failures of each process."""
        return {label: process.account for label, process in self._processes.items()}

    @property
    def labels(self) -> Sequence[Label]:
        """The labels of all stream generators, in the order in which they were added."""
        return tuple(self._processes)

    @property
    def streams(self) -> Sequence[StreamProxy]:
        """All streams, inputs of units and subscriptions, in the order they were asked for."""
        return self._subscriptions.proxies

    def generator(self, label: Label) -> StreamGenerator:
        """Return the stream generator called *label*, which answers queries.

        Raises:
            NoSuchLabelError: There is none.
        """
        if label not in self._processes:
            raise NoSuchLabelError(label, nearest_name(label, self._processes))
        return self._processes[label].generator

    def add_source(
        self,
        label: Label,
        source: Source,
        output_policy: Policy = ANYTHING,
        on_failure: OnFailure = OnFailure.STOP,
    ) -> None:
        """Add a source whose samples come out of a new stream generator called *label*.

        What a source has to say about the time before it was added becomes available at once.

        Raises:
            LabelAlreadyExistsError: There is a generator of this name already.
        """
        generator = self._new_generator(label, 0, output_policy)
        self._add(RunningSource(source, generator, on_failure, self._surroundings))

    def add_unit(
        self,
        label: Label,
        unit: ComputationalUnit,
        inputs: Sequence[Input],
        output_policy: Policy = ANYTHING,
        on_failure: OnFailure = OnFailure.STOP,
    ) -> None:
        """Add a computational unit that is fed by streams of generators added before.

        Raises:
            LabelAlreadyExistsError: There is a generator of this name already.
            NoSuchLabelError: There is no generator of an input's name.
            PolicyNotSupportedError: An input's policy cannot be kept.
        """
        providers = [self.generator(provider) for provider, _ in inputs]
        for provider, (_, policy) in zip(providers, inputs, strict=True):
            self._subscriptions.check(provider, policy)
        depth = 1 + max((provider.depth for provider in providers), default=0)
        generator = self._new_generator(label, depth, output_policy)
        names = [provider for provider, _ in inputs]
        running = RunningUnit(unit, names, generator, on_failure, self._surroundings)
        self._add(running)
        try:
            for at, (provider, (_, policy)) in enumerate(zip(providers, inputs, strict=True)):
                self._subscriptions.open(provider, self._input(running, at), policy)
        except PolicyNotSupportedError:
            self.remove(label)
            raise

    def add_input(self, label: Label, provider: Label, policy: Policy = ANYTHING) -> StreamProxy:
        """Let the unit of *label* take one more stream, which may end before the unit does.

        The stream has the first place that is free behind the inputs that the unit has.

        Raises:
            NoSuchLabelError: There is no generator of one of the names.
            PolicyNotSupportedError: The policy cannot be kept.
            TypeError: The process is a source.
            ValueError: The process feeds the provider itself.
        """
        generator = self.generator(provider)
        self._subscriptions.check(generator, policy)
        running = self._processes[self.generator(label).label]
        if not isinstance(running, RunningUnit):
            raise TypeError(f"'{label}' is a source and takes no streams")
        if self._feeds(label, provider):
            raise ValueError(f"'{provider}' depends on '{label}', which cannot take its stream")
        self._deepen(running, generator.depth + 1)
        at = running.add_input(provider)
        return self._subscriptions.open(generator, self._input(running, at), policy)

    def remove_input(self, stream: StreamProxy) -> None:
        """Let a unit no longer take a stream that was added as an input."""
        running = self._processes[stream.receiver]
        assert isinstance(running, RunningUnit)  # nothing else has inputs
        self._subscriptions.end(stream)
        self._changes.make(lambda: running.remove_input(stream.number - 1))

    def remove(self, label: Label) -> None:
        """Remove a process with its stream generator and its input streams.

        Raises:
            NoSuchLabelError: There is no generator of this name.
            LabelInUseError: Others receive its samples.
        """
        generator = self.generator(label)
        receivers = [proxy.receiver for proxy in self._subscriptions.of(generator)]
        if receivers:
            raise LabelInUseError(label, receivers)
        process = self._processes.pop(label)
        self._end_inputs(label)
        self._changes.make(lambda: self._withdraw(process))

    def change(self, change: Callable[[], object]) -> None:
        """Call *change* between two instants: at once, or when the current instant is done."""
        self._changes.make(change)

    def subscribe(
        self,
        label: Label,
        receive: Receive,
        policy: Policy = ANYTHING,
        name: Label = OUTPUT,
        beat: Beat | None = None,
    ) -> StreamProxy:
        """Hand the samples of a stream to *receive*, and its heartbeats to *beat* if given.

        A stream whose policy says from when on it is wanted begins with those samples that the
        generator still holds. Every other one begins with the next sample.

        Args:
            label: The stream generator.
            receive: Takes the samples.
            policy: What the stream has to keep.
            name: What the receiver is called in violations and among the streams.
            beat: Takes the heartbeats.

        Raises:
            NoSuchLabelError: There is no generator called *label*.
            PolicyNotSupportedError: The process does not promise as much as *policy* needs, or
                the stream would begin with samples that are no longer held.
        """
        receiver = Receiver(name, 0, receive, beat)
        return self._subscriptions.open(self.generator(label), receiver, policy)

    def subscribe_violations(self, receive: ViolationReceiver) -> Callable[[], None]:
        """Hand every violation, in any stream of the network, to *receive*.

        Return what ends that.
        """
        self._violation_receivers.append(receive)
        return lambda: self._violation_receivers.remove(receive)

    def subscribe_failures(self, receive: Callable[[Failure], None]) -> Callable[[], None]:
        """Hand every failure of a process to *receive*; return what ends that."""
        self._failure_receivers.append(receive)
        return lambda: self._failure_receivers.remove(receive)

    def run(
        self,
        until: TimePoint | None = None,
        on_time: Callable[[TimePoint], None] | None = None,
        clock: Clock | None = None,
    ) -> None:
        """Work until the time *until*, inclusive, or to the end of all sources.

        With *until*, alarms that fall due after the last sample of the sources ring as well.
        Without it the run ends when no source has another sample and all samples have been
        delivered; alarms that would ring later than that do not. A sample of the last instant
        that is given a later nanosecond, because available times are unique, belongs to it and
        is delivered too; `now` is that nanosecond then. *on_time* is told each new instant
        before its work begins. A run can be continued by another one. The *clock*, a virtual
        one by default, says how fast this goes and changes nothing else.

        Raises:
            ProcessError: A process failed that is to stop the network; the cause is attached.
        """
        clock = clock or VirtualClock()
        self._is_stopped = False
        self._is_running = True
        self._agenda.horizon = until
        try:
            self._start_processes()
            self._subscriptions.settle()
            clock.start(self.now)
            while (instant := self._next_instant()) is not None:
                clock.await_instant(instant)
                self._work_on(instant, on_time)
                clock.finish(instant)
        finally:
            self._is_running = False
            self._agenda.horizon = None
        if until is not None and not self._is_stopped:
            clock.await_instant(until)
            self.now = max(self.now, until)
            self._changes.begin = max(self._changes.begin, TimePoint(until + 1))

    def stop(self) -> None:
        """End the current run when the work of the current instant is done."""
        self._is_stopped = True

    def _next_instant(self) -> TimePoint | None:
        instant = self._agenda.next_time()
        if self._is_stopped or instant is None:
            return None
        if self._agenda.horizon is None:
            return instant if self._agenda.pending else None
        return instant if instant <= self._agenda.horizon else None

    def _work_on(self, instant: TimePoint, on_time: Callable[[TimePoint], None] | None) -> None:
        self.now = instant
        if on_time is not None:
            on_time(instant)
        self._changes.enter(instant)
        try:
            self._agenda.hold_instant(instant)
        finally:
            self._changes.leave()

    def _feeds(self, label: Label, other: Label) -> bool:
        """Return whether samples of *label* can lead to samples of *other*."""
        seen, ahead = {other}, [other]
        while ahead:
            found = ahead.pop()
            if found == label:
                return True
            new = {provider for provider, _ in self._processes[found].inputs} - seen
            seen |= new
            ahead.extend(new)
        return False

    def _input(self, unit: RunningUnit, at: int) -> Receiver:
        return Receiver(unit.label, at + 1, unit.receiver(at), unit.beat(at), unit.account)

    def _deepen(self, process: RunningProcess, depth: int) -> None:
        """Let a process, and all that it feeds, come after a process of less than *depth*."""
        if process.depth < depth:
            process.deepen(depth)
            for proxy in self._subscriptions.of(process.generator):
                if proxy.stream is not None:
                    proxy.stream.deepen()
                if proxy.number:
                    self._deepen(self._processes[proxy.receiver], depth + 1)

    def _new_generator(self, label: Label, depth: int, output_policy: Policy) -> StreamGenerator:
        if label in self._processes:
            raise LabelAlreadyExistsError(label)
        return StreamGenerator(label, depth, self._agenda, output_policy)

    def _add(self, process: RunningProcess) -> None:
        self._processes[process.label] = process
        self._unstarted.append(process)
        self._changes.make(self._start_if_running)

    def _start_if_running(self) -> None:
        if self._is_running:
            self._start_processes()

    def _start_processes(self) -> None:
        unstarted, self._unstarted = self._unstarted, []
        for process in unstarted:
            process.start(self._changes.begin)

    def _withdraw(self, process: RunningProcess) -> None:
        if process in self._unstarted:
            self._unstarted.remove(process)
        process.withdraw()

    def _end_inputs(self, label: Label) -> None:
        for proxy in self._subscriptions.inputs_of(label):
            self._subscriptions.end(proxy)

    def _publish(self, violation: StreamViolation) -> None:
        for receive in self._violation_receivers:
            receive(violation)

    def _publish_own(self, label: Label, violation: Violation) -> None:
        self._processes[label].account.violations += 1
        self._publish(StreamViolation(label, label, violation))

    def _report(self, failure: Failure) -> None:
        for receive in self._failure_receivers:
            receive(failure)
        if self._processes[failure.label].on_failure is OnFailure.END:
            self._end_inputs(failure.label)
