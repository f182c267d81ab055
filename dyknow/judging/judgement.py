"""What a judge has found: which declarations hold of an execution, and where others are broken.

The numbers of definitions are those of Heintz (2009), *DyKnow: A Stream-Based Knowledge
Processing Middleware Framework*.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum, StrEnum

from dyknow.streams.sample import Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = [
    "NOT_RECORDED",
    "PROVIDER_NOT_RECORDED",
    "Basis",
    "Breach",
    "Definition",
    "Draft",
    "Finding",
    "Judgement",
    "Tally",
]

NOT_RECORDED = "not recorded"
"""Why a stream is not judged that there was, but not in the execution that is known."""

PROVIDER_NOT_RECORDED = "what it is made of is not recorded"
"""Why a stream is not compared with that of its provider."""


class Definition(StrEnum):
    """What a breach breaks."""

    FLUENT_STREAM = "4.3.5"
    MODEL = "4.5.3"
    SORT = "4.5.4"
    SOURCE = "4.5.7"
    UNIT = "4.5.8"
    SUBSTREAM = "4.5.9"
    TERM = "4.5.10"
    POLICY = "4.5.11"
    STREAM = "4.5.12"
    HEARTBEAT = "heartbeat"

    @property
    def meaning(self) -> str:
        """What the definition asks for, in a few words."""
        return _MEANINGS[self]


_MEANINGS = {
    Definition.FLUENT_STREAM: "available times are unique and in order",
    Definition.MODEL: "every declaration holds",
    Definition.SORT: "values are of the declared sort",
    Definition.SOURCE: "the stream has the samples of its source",
    Definition.UNIT: "the stream has what its unit computes from its inputs",
    Definition.SUBSTREAM: "every sample comes from the extended stream of the provider",
    Definition.TERM: "no sample is left out or held back that the policy would let through",
    Definition.POLICY: "the policy is kept, or its violation published",
    Definition.STREAM: "the output stream is one that its term allows",
    Definition.HEARTBEAT: "nothing comes that a heartbeat has ruled out",
}


class Basis(Enum):
    """What the samples of a stream were compared with."""

    RECORDED = "recorded inputs"
    COMPUTED = "inputs that were computed again, for want of a recording"
    CORRECTED = "inputs that were computed again, since those recorded are at fault"
    NOTHING = "nothing"


@dataclass(frozen=True, slots=True)
class Breach:
    """One place where an execution does not satisfy its specification.

    Attributes:
        stream: The topic of the stream: a label, `RECEIVER/NUMBER` or `output/NAME`.
        definition: What is broken.
        expected: What should have been there.
        found: What is there.
        valid_time: Of the sample in question; None if the breach concerns no single sample.
        available_time: Of the same.
    """

    stream: str
    definition: Definition
    expected: str
    found: str
    valid_time: TimePoint | None = None
    available_time: TimePoint | None = None

    @classmethod
    def at(
        cls,
        stream: str,
        definition: Definition,
        sample: Sample[object],
        expected: str,
        found: str,
    ) -> "Breach":
        """Return a breach at *sample*."""
        return cls(stream, definition, expected, found, sample.valid_time, sample.available_time)

    def __str__(self) -> str:
        place = self.stream
        if self.valid_time is not None and self.available_time is not None:
            valid, available = map(text_from_duration, (self.valid_time, self.available_time))
            place = f"{place}: sample valid at {valid}, available at {available}"
        return f"{place}: [{self.definition}] expected {self.expected}, found {self.found}"


@dataclass(frozen=True, slots=True)
class Finding:
    """What was found about one declaration.

    Attributes:
        stream: The topic of the stream that the declaration is about.
        definition: By which definition the declaration holds or not.
        samples: How many samples the stream has in the execution.
        basis: What they were compared with.
        breaches: The first of them, in order of available time.
        breach_count: How many there are in all.
        unjudged: What could not be judged, and why.
    """

    stream: str
    definition: Definition
    samples: int = 0
    basis: Basis = Basis.NOTHING
    breaches: tuple[Breach, ...] = ()
    breach_count: int = 0
    unjudged: tuple[str, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether nothing speaks against the declaration."""
        return self.breach_count == 0


@dataclass(frozen=True, slots=True)
class Judgement:
    """What was found about all declarations of a specification, inputs before what they feed.

    Attributes:
        findings: One for each declaration.
        unjudged: What concerns no single declaration.
    """

    findings: tuple[Finding, ...]
    unjudged: tuple[str, ...] = field(default=())

    @property
    def is_satisfied(self) -> bool:
        """Whether the execution is a model of the specification, as far as can be judged."""
        return all(finding.holds for finding in self.findings)

    @property
    def breaches(self) -> tuple[Breach, ...]:
        """The breaches that were kept, those of inputs before those of what they feed."""
        return tuple(breach for finding in self.findings for breach in finding.breaches)

    @property
    def breach_count(self) -> int:
        """How many breaches there are in all."""
        return sum(finding.breach_count for finding in self.findings)


class Tally:
    """Counts breaches and keeps the first few.

    Attributes:
        count: How many there were.
    """

    def __init__(self, keep: int) -> None:
        self.count = 0
        self._keep = keep
        self._kept: list[Breach] = []

    def add(self, breaches: Iterable[Breach]) -> None:
        """Count *breaches*, which are in the order in which they shall be kept."""
        for breach in breaches:
            self.count += 1
            if len(self._kept) < self._keep:
                self._kept.append(breach)

    def merge(self, other: "Tally") -> None:
        """Count what *other* has counted."""
        self._kept = [*self._kept, *other.kept][: self._keep]
        self.count += other.count

    @property
    def kept(self) -> tuple[Breach, ...]:
        """The first breaches."""
        return tuple(self._kept)


class Draft:
    """A finding while it is being made.

    Attributes:
        stream: The topic.
        definition: By which the declaration holds or not.
        tally: Takes the breaches.
        samples: How many samples there are.
        basis: What they were compared with.
        unjudged: What could not be judged.
    """

    def __init__(self, stream: str, definition: Definition, keep: int) -> None:
        self.stream = stream
        self.definition = definition
        self.tally = Tally(keep)
        self.samples = 0
        self.basis = Basis.NOTHING
        self.unjudged: list[str] = []

    def finished(self) -> Finding:
        """Return the finding."""
        return Finding(
            self.stream,
            self.definition,
            self.samples,
            self.basis,
            self.tally.kept,
            self.tally.count,
            tuple(self.unjudged),
        )
