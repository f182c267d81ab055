"""What a network is made of, as plain data that can be written into a file."""

from dataclasses import dataclass, field
from typing import TypedDict

__all__ = [
    "GeneratorDescription",
    "InputDescription",
    "NetworkChange",
    "NetworkDescription",
    "OutputDescription",
]


class InputDescription(TypedDict):
    """One input stream of a process.

    Attributes:
        number: Its place among the inputs, from 1 on.
        provider: The label of the stream generator that it comes from.
        policy: As KPL writes it after `with`; empty if it restricts nothing.
    """

    number: int
    provider: str
    policy: str


class GeneratorDescription(TypedDict):
    """A stream generator and its process.

    Attributes:
        label: Its label; of a process that has none in the specification, its text.
        kind: `source`, `unit`, `link`, `synchronisation`, `merging`, `mediation`, `selection` or
            `view`.
        process: The process, as KPL writes it after `=`.
        sort: Of its samples, as KPL writes it.
        inputs: In their order. Those of a mediation change while the network runs.
        output_policy: What its samples keep; of a synchronisation, the state policy.
        on_failure: `stop` or `end`.
    """

    label: str
    kind: str
    process: str
    sort: str
    inputs: list[InputDescription]
    output_policy: str
    on_failure: str


class OutputDescription(TypedDict):
    """An output stream.

    Attributes:
        name: Its name.
        provider: The label of the stream generator that it comes from.
        policy: As KPL writes it after `with`.
    """

    name: str
    provider: str
    policy: str


class NetworkDescription(TypedDict):
    """A network at one moment: what has been built, in the order of building."""

    generators: list[GeneratorDescription]
    outputs: list[OutputDescription]


@dataclass
class NetworkChange:
    """What was changed in a network between two instants.

    Attributes:
        built: The labels of new processes, in the order of building.
        removed: The labels of processes that were taken out.
        opened: The names of new output streams.
        closed: The names of output streams that have ended.
    """

    built: list[str] = field(default_factory=list)
    removed: list[str] = field(default_factory=list)
    opened: list[str] = field(default_factory=list)
    closed: list[str] = field(default_factory=list)

    def __bool__(self) -> bool:
        return bool(self.built or self.removed or self.opened or self.closed)
