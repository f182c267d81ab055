"""What each process of a network has cost and given."""

from dataclasses import dataclass

__all__ = ["Account"]


@dataclass(slots=True)
class Account:
    """Running totals of one process.

    Attributes:
        calls: How often the process was asked or told something.
        samples: How many samples it produced.
        seconds: Processor time spent in it.
        violations: How many violations its input streams have seen.
        failures: How often it failed.
    """

    calls: int = 0
    samples: int = 0
    seconds: float = 0.0
    violations: int = 0
    failures: int = 0
