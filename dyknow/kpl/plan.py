"""From a KPL specification to a network that runs."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from dyknow.kpl.syntax import Specification
from dyknow.mtl.syntax import Formula
from dyknow.runtime.generators import Receive
from dyknow.runtime.kernel import Kernel
from dyknow.streams.process import ComputationalUnit, Source

__all__ = ["Implementations", "LinkFactory", "Network", "build_network"]


class LinkFactory(Protocol):
    """Makes the process that a `link(...)` generator declares."""

    def __call__(
        self,
        unit: str,
        establish: Formula,
        reestablish: Formula,
        maintain: Formula,
        settings: Mapping[str, Any],
    ) -> ComputationalUnit:
        """Return a link process with one input, the objects to be linked.

        *unit* is the symbol of the computational unit that computes the upper objects;
        *settings* has what the declaration sets by name.
        """


@dataclass(frozen=True)
class Implementations:
    """What the symbols of a specification stand for (Heintz 2009, definition 4.5.2).

    Attributes:
        sources: Source symbol to a function without arguments that makes the source.
        units: Computational unit symbol to a function that takes the settings as keyword
            arguments and makes the unit. Settings are checked against its signature. A setting
            annotated `Duration` may be written as a bare number of milliseconds.
        link: Makes link processes, if the specification has any.
    """

    sources: Mapping[str, Callable[[], Source]] = field(default_factory=dict)
    units: Mapping[str, Callable[..., ComputationalUnit]] = field(default_factory=dict)
    link: LinkFactory | None = None


class Network:
    """A kernel with the processes of a specification, and the outputs it declares.

    Attributes:
        kernel: Runs the network: `kernel.run(until, on_time)`, `kernel.accounts`.
        outputs: The names of the `stream` declarations that were built.
    """

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel

    def subscribe(self, output: str, receive: Receive) -> Callable[[], None]:
        """Hand the samples of an output stream to *receive*, under its declared policy."""
        raise NotImplementedError


def build_network(
    specification: Specification,
    implementations: Implementations,
    parameters: Mapping[str, object] | None = None,
    outputs: Collection[str] | None = None,
) -> Network:
    """Return a network of what the wanted *outputs* need; of all outputs when None.

    *parameters* gives values to `parameter` declarations, in place of their defaults: numbers
    as KPL writes them (a bare one is milliseconds where a time is meant), True, False, or
    strings (`"truth"`, `"100 ms"`).

    Raises:
        SpecificationErrors: Every fault of the specification, of the parameters, and of the
            settings of what is built.
    """
    raise NotImplementedError
