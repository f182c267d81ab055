"""What a benchmark finds out, as values and as a file of JSON.

Everything measured is repeated, and is told as the median of the repetitions with the smallest
and the largest.
"""

from collections.abc import Sequence
from statistics import median

from pydantic import BaseModel, ConfigDict

__all__ = [
    "BenchmarkResult",
    "Experiment",
    "Figure",
    "Findings",
    "Line",
    "Machine",
    "Measurement",
    "Point",
    "Published",
    "Ratio",
    "Series",
]


class _Value(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Measurement(_Value):
    """One quantity, measured several times.

    Attributes:
        median: Of the repetitions.
        low: The smallest.
        high: The largest.
        repetitions: How many there were.
    """

    median: float
    low: float
    high: float
    repetitions: int

    @classmethod
    def of(cls, values: Sequence[float]) -> "Measurement":
        """Return what *values*, one for each repetition, amount to."""
        return cls(
            median=median(values), low=min(values), high=max(values), repetitions=len(values)
        )


class Point(_Value):
    """A measurement at one place of a curve."""

    x: float
    y: Measurement


class Line(_Value):
    """The straight line that fits the medians of a series best."""

    slope: float
    intercept: float

    def at(self, x: float) -> float:
        """Return the height of the line at *x*."""
        return self.intercept + self.slope * x


class Series(_Value):
    """A curve: what was measured for each value of what was varied.

    Attributes:
        name: Whose curve it is.
        points: In order of x.
        line: Fitted to the points, if a line is what they should be on.
    """

    name: str
    points: list[Point]
    line: Line | None = None


class Published(_Value):
    """A curve from the literature, to stand beside the measured ones.

    Attributes:
        source: Author, year, and place.
        unit: Of y, which may be another one than ours.
        points: Pairs of x and y.
        remark: How the points were come by, and on what machine.
    """

    source: str
    unit: str
    points: list[tuple[float, float]]
    remark: str


class Experiment(_Value):
    """What happens when one thing is varied.

    Attributes:
        name: A few words without spaces; pictures are called by it.
        what: What is measured, as a sentence.
        x: What is varied.
        y: What is measured.
        unit: Of y.
        series: The curves; ours is the first.
        published: The curve of the literature, if there is one.
        logarithmic: Whether x grows by factors rather than by steps.
    """

    name: str
    what: str
    x: str
    y: str
    unit: str
    series: list[Series]
    published: Published | None = None
    logarithmic: bool = False


class Figure(_Value):
    """A single number with a name.

    Attributes:
        name: What it is.
        unit: Its unit.
        value: The number.
        published: What the literature has for it, and where, if it has.
    """

    name: str
    unit: str
    value: Measurement
    published: str | None = None


class Ratio(_Value):
    """How another library compares, measured in the same run.

    Attributes:
        peer: The name of the library.
        version: Of the library.
        what: What both did.
        times_as_long: Their time divided by ours.
    """

    peer: str
    version: str
    what: str
    times_as_long: Measurement


class Findings(_Value):
    """What a benchmark has measured.

    Attributes:
        experiments: Curves.
        figures: Single numbers.
        ratios: Comparisons with other libraries.
        notes: What a reader should know, a sentence each.
    """

    experiments: list[Experiment] = []
    figures: list[Figure] = []
    ratios: list[Ratio] = []
    notes: list[str] = []


class Machine(_Value):
    """What a benchmark ran on.

    Attributes:
        processor: The name of the processor.
        cores: How many processors this process may use.
        memory: Bytes.
        system: Operating system and kind of machine.
        versions: Of this program, of Python, and of what figures may depend on.
    """

    processor: str
    cores: int
    memory: int
    system: str
    versions: dict[str, str]


class BenchmarkResult(_Value):
    """Everything that `traffic benchmark` shows and writes.

    Attributes:
        benchmark: The name of the benchmark.
        what: What it is about, as a sentence.
        quick: Whether it was shortened, so that its figures say little.
        seconds: How long it took, on the clock.
        machine: What it ran on.
        findings: What it found out.
    """

    benchmark: str
    what: str
    quick: bool
    seconds: float
    machine: Machine
    findings: Findings
