"""Who receives which stream under which policy, and how that is changed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from dyknow.errors import PolicyNotSupportedError
from dyknow.runtime.accounts import Account
from dyknow.runtime.adaptation import AdaptedStream, PlainStream, Stream
from dyknow.runtime.agenda import Agenda
from dyknow.runtime.beginnings import Beginning, beginning, check_past, continuation
from dyknow.runtime.cache import CachedStream
from dyknow.runtime.changes import Changes
from dyknow.runtime.generators import ANYTHING, Beat, Label, Receive, StreamGenerator
from dyknow.runtime.statistics import Statistics
from dyknow.streams.policy import Policy, SampleEvery, Violation
from dyknow.streams.refusal import refusal
from dyknow.streams.sample import Sample
from dyknow.time import Duration, text_from_duration

__all__ = ["Receiver", "StreamProxy", "StreamViolation", "Subscriptions", "ViolationReceiver"]

K = TypeVar("K")
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class StreamViolation:
    """A violation and the stream in which it happened.

    Attributes:
        provider: The label of the generator.
        receiver: The label of the process that asked for the policy, or the name of a
            subscription, which is `output` where nobody says otherwise. A unit that reports a
            violation itself is provider and receiver.
        violation: What was violated, where, and why.
        number: Which input of the receiver, counted from 1; 0 for a subscription and for what a
            unit reports itself.
    """

    provider: Label
    receiver: Label
    violation: Violation
    number: int = 0


Tap = tuple[Receive, Beat]
"""Takes what a stream says on its way to a receiver."""

ViolationReceiver = Callable[[StreamViolation], None]
"""Takes the violations of a stream, or of a whole network."""


@dataclass(frozen=True, slots=True)
class Receiver:
    """Who is to receive a stream.

    Attributes:
        label: The label of the process, or the name of a subscription.
        number: Which input of the process, counted from 1; 0 for a subscription.
        receive: Takes the samples.
        beat: Takes the heartbeats, if they are wanted.
        account: The account of the process.
    """

    label: Label
    number: int
    receive: Receive
    beat: Beat | None = None
    account: Account | None = None


class StreamProxy:
    """The client's end of one stream, adapted to its policy.

    Attributes:
        provider: The label of the generator.
        receiver: The label of the process that receives, or the name of the subscription.
        number: Which input of the receiver, counted from 1; 0 for a subscription.
        receive: Takes the samples.
        beat: Takes the heartbeats, if they are wanted.
        generator: Where the samples come from.
        policy: What the stream keeps.
        stream: What is received at present; None before the beginning and after the end.
        has_ended: Whether nothing more will be received, because the stream was ended.
    """

    __slots__ = (
        "_account",
        "_own",
        "_statistics",
        "_subscriptions",
        "_taps",
        "_violation_receivers",
        "beat",
        "generator",
        "has_ended",
        "number",
        "policy",
        "receive",
        "receiver",
        "stream",
    )

    def __init__(
        self,
        subscriptions: "Subscriptions",
        generator: StreamGenerator,
        receiver: Receiver,
        policy: Policy,
    ) -> None:
        self.generator = generator
        self.receiver = receiver.label
        self.number = receiver.number
        self.receive = receiver.receive
        self.beat = receiver.beat
        self.policy = policy
        self.stream: Stream | None = None
        self.has_ended = False
        self._own = receiver
        self._taps: list[Tap] = []
        self._account = receiver.account
        self._subscriptions = subscriptions
        self._statistics = Statistics()
        self._violation_receivers: list[ViolationReceiver] = []

    def __repr__(self) -> str:
        place = f"{self.receiver}/{self.number}" if self.number else self.receiver
        return f"StreamProxy({self.provider} -> {place})"

    @property
    def provider(self) -> Label:
        """The label of the generator."""
        return self.generator.label

    @property
    def statistics(self) -> Statistics:
        """The figures of the stream; a replaced policy goes on with them."""
        return self._statistics if self.stream is None else Statistics.of(self.stream)

    @property
    def period(self) -> Duration | None:
        """The sample period in force, if the stream is sampled and has begun."""
        return None if self.stream is None else self.stream.period

    def set_period(self, period: Duration) -> None:
        """Go on with another of the sample periods that the policy allows under load.

        During an instant, the change is made when the work of that instant is done. Other
        receivers of the same generator go on as they are.

        Raises:
            ValueError: The policy does not allow the period, or the stream has ended.
        """
        self._subscriptions.set_period(self, period)

    def replace_policy(self, policy: Policy) -> None:
        """Receive the same stream under another policy, from the next time-point on.

        During an instant, the change is made when the work of that instant is done. Nothing is
        received twice, the order of valid times goes on across the change, and nothing that the
        old policy has held back is lost.

        Raises:
            PolicyNotSupportedError: The process does not promise as much as *policy* needs.
            ValueError: The stream has ended.
        """
        self._subscriptions.replace(self, policy)

    def end(self) -> None:
        """Receive nothing more, from the next time-point on; to end twice changes nothing.

        Raises:
            ValueError: The stream is an input of a process, which needs it.
        """
        if self.number:
            raise ValueError(f"{self} is an input and ends with its process")
        self._subscriptions.end(self)

    def tap(self, receive: Receive, beat: Beat) -> Callable[[], None]:
        """Show each sample and each heartbeat to others too, before the receiver has it.

        That goes on under a policy that replaces the present one. Return what ends it.
        """
        tap = (receive, beat)
        self._taps.append(tap)
        self._rejoin()

        def end() -> None:
            self._taps.remove(tap)
            self._rejoin()

        return end

    def subscribe_violations(self, receive: ViolationReceiver) -> Callable[[], None]:
        """Hand every violation of the policy to *receive*; return what ends that."""
        self._violation_receivers.append(receive)
        return lambda: self._violation_receivers.remove(receive)

    def publish(self, violation: Violation) -> None:
        """Take a violation of the policy and hand it to all who want it."""
        if self._account is not None:
            self._account.violations += 1
        told = StreamViolation(self.provider, self.receiver, violation, self.number)
        for receive in self._violation_receivers:
            receive(told)
        self._subscriptions.publish(told)

    def attach(self, stream: Stream | None) -> None:
        """Receive *stream* from now on, or nothing, in place of what was received before."""
        if self.stream is not None:
            self.stream.leave(self)
            self._statistics = Statistics.of(self.stream)
        self.stream = stream
        if stream is not None:
            stream.join(self)

    def _rejoin(self) -> None:
        """Receive with the taps that there are now."""
        own = self._own
        receivers = [*(receive for receive, _ in self._taps), own.receive]
        beats = [*(beat for _, beat in self._taps), *([own.beat] if own.beat else [])]
        self.receive = _to_all(receivers)
        self.beat = _to_all(beats)
        if self.stream is not None:
            self.stream.join(self)


def _to_all(receivers: Sequence[Callable[[T], None]]) -> Callable[[T], None]:
    """Return what calls each of *receivers*, in their order."""
    if len(receivers) == 1:
        return receivers[0]

    def call(said: T) -> None:
        for receive in receivers:
            receive(said)

    return call


StreamKey = tuple[StreamGenerator, Policy, *tuple[object, ...]]
"""What two streams must have in common to be made once, beside the moment of their beginning."""


class Subscriptions:
    """All streams of a network."""

    def __init__(self, agenda: Agenda, changes: Changes, publish: ViolationReceiver) -> None:
        self.publish = publish
        self._agenda = agenda
        self._changes = changes
        self._proxies: dict[StreamProxy, None] = {}
        self._of: dict[StreamGenerator, dict[StreamProxy, None]] = {}
        self._inputs_of: dict[Label, dict[StreamProxy, None]] = {}
        self._epoch = changes.epoch
        self._shared: dict[StreamKey, AdaptedStream] = {}

    @property
    def proxies(self) -> tuple[StreamProxy, ...]:
        """The streams, in the order in which they were asked for."""
        return tuple(self._proxies)

    def of(self, generator: StreamGenerator) -> tuple[StreamProxy, ...]:
        """Return the streams of a generator."""
        return tuple(self._of.get(generator, ()))

    def inputs_of(self, label: Label) -> tuple[StreamProxy, ...]:
        """Return the streams that are inputs of a process."""
        return tuple(self._inputs_of.get(label, ()))

    def check(self, generator: StreamGenerator, policy: Policy) -> None:
        """Raise a PolicyNotSupportedError if the process does not promise enough for *policy*."""
        reason = refusal(generator.output_policy, policy)
        if reason is not None:
            raise PolicyNotSupportedError(generator.label, reason)

    def open(self, generator: StreamGenerator, receiver: Receiver, policy: Policy) -> StreamProxy:
        """Hand the samples of a generator to a receiver under a policy.

        Raises:
            PolicyNotSupportedError: The process does not promise as much as *policy* needs, or
                the stream would begin with samples that are no longer held.
        """
        self.check(generator, policy)
        proxy = StreamProxy(self, generator, receiver, policy)
        past, last = None, generator.last
        if policy.start is not None:
            past = generator.snapshot()
            check_past(past, policy, self._changes.begin)
        self._enter(proxy)
        self._changes.make(lambda: self._begin(proxy, past, last))
        return proxy

    def replace(self, proxy: StreamProxy, policy: Policy) -> None:
        """Let a receiver go on under another policy."""
        if proxy.has_ended:
            raise ValueError(f"{proxy} has ended")
        self.check(proxy.generator, policy)
        self._changes.make(lambda: self._replace(proxy, policy))

    def set_period(self, proxy: StreamProxy, period: Duration) -> None:
        """Let a sampled stream go on with another period."""
        if proxy.has_ended:
            raise ValueError(f"{proxy} has ended")
        change = proxy.policy.change
        if not isinstance(change, SampleEvery) or period not in change.periods():
            raise ValueError(f"{proxy} may not be sampled every {text_from_duration(period)}")
        self._changes.make(lambda: self._set_period(proxy, period))

    def end(self, proxy: StreamProxy) -> None:
        """Hand a receiver nothing more."""
        if not proxy.has_ended:
            proxy.has_ended = True
            self._strike_out(proxy)
            self._changes.make(lambda: self._attach(proxy, None))

    def settle(self) -> None:
        """Let streams that are asked for from now on be made anew."""
        self._shared.clear()

    def _enter(self, proxy: StreamProxy) -> None:
        self._proxies[proxy] = None
        self._of.setdefault(proxy.generator, {})[proxy] = None
        if proxy.number:
            self._inputs_of.setdefault(proxy.receiver, {})[proxy] = None

    def _strike_out(self, proxy: StreamProxy) -> None:
        del self._proxies[proxy]
        _remove(self._of, proxy.generator, proxy)
        if proxy.number:
            _remove(self._inputs_of, proxy.receiver, proxy)

    def _begin(
        self, proxy: StreamProxy, past: CachedStream | None, last: Sample[Any] | None
    ) -> None:
        """Let a stream begin, with what was held when it was asked for and what came since."""
        generator = proxy.generator
        if past is not None and generator.last is not None and generator.last is not last:
            # Only one: there is one sample at an instant.
            past.hold(generator.last)
        if proxy.policy == ANYTHING and generator.is_fresh:
            self._attach(proxy, PlainStream(generator))
            return
        key = (generator, proxy.policy)
        begin = self._changes.begin
        stream = self._found(key)
        if stream is None:
            stream = self._made(key, beginning(generator, proxy.policy, begin, past))
        self._attach(proxy, stream)

    def _replace(self, proxy: StreamProxy, policy: Policy) -> None:
        old = proxy.stream
        if policy == proxy.policy or old is None:
            return
        key = (proxy.generator, policy, old)
        stream = self._found(key)
        if stream is None:
            begin = self._changes.begin
            stream = self._made(key, continuation(proxy.generator, policy, begin, old))
        proxy.policy = policy
        self._attach(proxy, stream)

    def _set_period(self, proxy: StreamProxy, period: Duration) -> None:
        stream = proxy.stream
        if not isinstance(stream, AdaptedStream) or stream.period == period:
            return
        key = (proxy.generator, proxy.policy, stream, period)
        split = self._found(key)
        if split is None and stream.n_members == 1:
            stream.set_period(period, self._changes.begin)
            return
        if split is None:
            split = self._made(key, stream.copied(self._changes.begin))
            split.set_period(period, self._changes.begin)
        self._attach(proxy, split)

    def _attach(self, proxy: StreamProxy, stream: Stream | None) -> None:
        old = proxy.stream
        proxy.attach(stream)
        if old is not None and not old.n_members:
            self._shared.clear()

    def _found(self, key: StreamKey) -> AdaptedStream | None:
        """Return a stream that was made alike while nothing has happened since."""
        if self._epoch != self._changes.epoch:
            self._epoch = self._changes.epoch
            self._shared.clear()
        return self._shared.get(key)

    def _made(self, key: StreamKey, beginning: Beginning) -> AdaptedStream:
        generator, policy = key[:2]
        stream = AdaptedStream(generator, policy, self._agenda, beginning)
        self._shared[key] = stream
        return stream


def _remove(index: dict[K, dict[StreamProxy, None]], key: K, proxy: StreamProxy) -> None:
    del index[key][proxy]
    if not index[key]:
        del index[key]
