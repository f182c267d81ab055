"""What a network looked like at one time, as plain data.

A snapshot says which knowledge processes there are, which streams flow between them under which
policies, and what they have cost, given, and failed to give so far. It is what an agent that
reasons about its own processing looks at (Heintz 2009, *DyKnow: A Stream-Based Knowledge
Processing Middleware Framework*, section 1.3: "introspection" is one of the six requirements).
A snapshot can be written to a file and read again, and two of them have a difference.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Final, TypeVar

from pydantic import TypeAdapter, ValidationError

from dyknow.runtime.names import input_name, output_name
from dyknow.runtime.statistics import Statistics
from dyknow.time import SECOND, Duration, TimePoint

__all__ = ["Kind", "ProcessFigures", "Snapshot", "StreamFigures"]

Amount = TypeVar("Amount", int, float)

FORMAT: Final = "dyknow-network"
VERSION: Final = 1
START: Final = TimePoint(0)


class Kind(StrEnum):
    """What sort of knowledge process stands behind a label; `process` if that is not known."""

    SOURCE = "source"
    UNIT = "unit"
    LINK = "link"
    SYNCHRONISATION = "synchronisation"
    MERGING = "merging"
    SELECTION = "selection"
    VIEW = "view"
    MEDIATION = "mediation"
    PROCESS = "process"


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessFigures:
    """A knowledge process and the stream generator that its samples come out of.

    Attributes:
        label: The label of the generator.
        kind: What sort of process it is.
        text: The process as the specification writes it; empty if there is none.
        depth: How many processes lie between it and the sources; 0 for a source.
        policy: What it promises of its output, as KPL writes it; empty if nothing.
        on_failure: What happens when it fails: `stop` or `end`.
        calls: How often it was asked or told something; None if that is not known.
        seconds: Processor seconds spent in it; None if that is not known.
        samples: How many samples it produced.
        heartbeats: How often it said that nothing more comes up to some time.
        violations: How many violations its input streams have seen.
        failures: How many failures it was allowed to end with.
        cached: How many samples its cache holds.
        cache_limit: How many the cache can hold at most; None if there is no cache.
    """

    label: str
    kind: Kind
    text: str = ""
    depth: int = 0
    policy: str = ""
    on_failure: str = "stop"
    calls: int | None = 0
    seconds: float | None = 0.0
    samples: int = 0
    heartbeats: int = 0
    violations: int = 0
    failures: int = 0
    cached: int = 0
    cache_limit: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamFigures:
    """A stream from a generator to one receiver.

    Attributes:
        provider: The label of the generator.
        receiver: The label of the process that it feeds, or the name of an output.
        number: Which input of the receiver it is, from 1; 0 for an output.
        policy: What the receiver requires, as KPL writes it; empty if nothing.
        is_output: Whether it leaves the network.
        samples: How many samples were handed on.
        rate: Samples per second of valid time; None before there are two.
        mean_delay: Mean of available time minus valid time, nanoseconds; None before the first.
        delay_99: What 99 % of the delays do not exceed, nanoseconds.
        violations: How many violations of the policy there were.
        late: How many samples were left out because they came too late or out of order.
    """

    provider: str
    receiver: str
    number: int = 1
    policy: str = ""
    is_output: bool = False
    samples: int = 0
    rate: float | None = None
    mean_delay: Duration | None = None
    delay_99: Duration | None = None
    violations: int = 0
    late: int = 0

    @classmethod
    def of(
        cls, provider: str, receiver: str, number: int, policy: str, figures: Statistics
    ) -> "StreamFigures":
        """Return a stream with its figures; one with the number 0 is an output."""
        has_delays = figures.samples > 0
        return cls(
            provider=provider,
            receiver=receiver,
            number=number,
            policy=policy,
            is_output=number == 0,
            samples=figures.samples,
            rate=figures.rate if figures.samples > 1 else None,
            mean_delay=figures.mean_delay if has_delays else None,
            delay_99=figures.delay_99 if has_delays else None,
            violations=figures.violations,
            late=figures.late,
        )

    @property
    def name(self) -> str:
        """What recordings call the stream, such as `cars/1` or `output/cars`."""
        if self.is_output:
            return output_name(self.receiver)
        return input_name(self.receiver, self.number)


@dataclass(frozen=True, slots=True, kw_only=True)
class Snapshot:
    """A network at one time, with what has happened since another.

    Attributes:
        begin: From when on the figures count, nanoseconds.
        now: Until when they count.
        processes: Every knowledge process, inputs before those that use them.
        streams: Every stream, in the order in which they were asked for.
        outputs: The names of the outputs that the specification declares and that were built.
    """

    begin: TimePoint = START
    now: TimePoint = START
    processes: tuple[ProcessFigures, ...] = ()
    streams: tuple[StreamFigures, ...] = ()
    outputs: tuple[str, ...] = ()

    @property
    def span(self) -> Duration:
        """How much time the figures are about."""
        return Duration(self.now - self.begin)

    @property
    def seconds(self) -> float:
        """Processor seconds of all processes together, as far as they are known."""
        return sum(process.seconds or 0.0 for process in self.processes)

    def inputs_of(self, label: str) -> tuple[StreamFigures, ...]:
        """Return the streams that feed the process *label*, in the order of its inputs."""
        found = [s for s in self.streams if s.receiver == label and not s.is_output]
        return tuple(sorted(found, key=lambda stream: stream.number))

    def streams_of(self, label: str) -> tuple[StreamFigures, ...]:
        """Return the streams that the generator *label* feeds."""
        return tuple(stream for stream in self.streams if stream.provider == label)

    def since(self, earlier: "Snapshot") -> "Snapshot":
        """Return what has happened between *earlier* and this snapshot of the same network.

        Counts are differences, and a rate is that of the samples in between. Processes and
        streams that are gone are left out, new ones count from their beginning, and a 99 % delay
        is the one since the beginning, for it has no difference.

        Raises:
            ValueError: *earlier* is later than this one.
        """
        if earlier.now > self.now:
            raise ValueError(f"the earlier snapshot is of {earlier.now}, this one of {self.now}")
        process_before = {process.label: process for process in earlier.processes}
        stream_before = dict(_keyed(earlier.streams))
        elapsed = (self.now - earlier.now) / SECOND
        return replace(
            self,
            begin=earlier.now,
            processes=tuple(
                _process_since(process, process_before.get(process.label))
                for process in self.processes
            ),
            streams=tuple(
                _stream_since(stream, stream_before.get(key), elapsed)
                for key, stream in _keyed(self.streams)
            ),
        )

    def to_json(self) -> str:
        """Write the snapshot as a JSON document; times are nanoseconds."""
        document = _Document(format=FORMAT, version=VERSION, network=self)
        return _DOCUMENT.dump_json(document, indent=1).decode() + "\n"

    @staticmethod
    def from_json(text: str | bytes) -> "Snapshot":
        """Read what `to_json` has written.

        Raises:
            ValueError: The text is something else, or of another version.
        """
        try:
            header = _HEADER.validate_json(text)
            if (header.format, header.version) == (FORMAT, VERSION):
                return _DOCUMENT.validate_json(text).network
        except ValidationError as error:
            fault = error.errors()[0]
            where = ".".join(map(str, fault["loc"]))
            message = f"{where}: {fault['msg']}" if where else fault["msg"]
            raise ValueError(f"not a snapshot of a network: {message}") from error
        found = f"'{header.format}' version {header.version}"
        raise ValueError(f"expected '{FORMAT}' version {VERSION}, found {found}")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Header:
    """What says how to read a document."""

    format: str
    version: int


@dataclass(frozen=True, slots=True, kw_only=True)
class _Document:
    """A snapshot under its header."""

    format: str
    version: int
    network: Snapshot


_HEADER: Final = TypeAdapter(_Header)
_DOCUMENT: Final = TypeAdapter(_Document)


def _keyed(
    streams: Iterable[StreamFigures],
) -> Iterator[tuple[tuple[str, str, int, int], StreamFigures]]:
    """Yield streams with what tells them apart; several may have the same two ends."""
    seen: Counter[tuple[str, str, int]] = Counter()
    for stream in streams:
        ends = (stream.provider, stream.receiver, stream.number)
        seen[ends] += 1
        yield (*ends, seen[ends]), stream


def _minus(later: Amount | None, earlier: Amount | None) -> Amount | None:
    return None if later is None or earlier is None else later - earlier


def _process_since(process: ProcessFigures, before: ProcessFigures | None) -> ProcessFigures:
    if before is None:
        return process
    return replace(
        process,
        calls=_minus(process.calls, before.calls),
        seconds=_minus(process.seconds, before.seconds),
        samples=process.samples - before.samples,
        heartbeats=process.heartbeats - before.heartbeats,
        violations=process.violations - before.violations,
        failures=process.failures - before.failures,
    )


def _stream_since(
    stream: StreamFigures, before: StreamFigures | None, elapsed: float
) -> StreamFigures:
    if before is None:
        return stream
    samples = stream.samples - before.samples
    return replace(
        stream,
        samples=samples,
        rate=samples / elapsed if elapsed else None,
        mean_delay=_mean_since(stream, before, samples),
        violations=stream.violations - before.violations,
        late=stream.late - before.late,
    )


def _mean_since(stream: StreamFigures, before: StreamFigures, samples: int) -> Duration | None:
    if stream.mean_delay is None or not samples:
        return None
    earlier = (before.mean_delay or 0) * before.samples
    return Duration(round((stream.mean_delay * stream.samples - earlier) / samples))
