"""Knowledge process prototypes: what a knowledge process can be made of.

The interface is that of Heintz (2009), section 5.3.1. A prototype stands for a source or a
computational unit that a host offers; an instance of it is a process in a running network.
"""

from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

from dyknow.errors import PolicyNotSupportedError, WrongNumberOfInputsError
from dyknow.runtime.generators import Label, StreamGenerator
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import Policy
from dyknow.streams.process import ComputationalUnit, Source

__all__ = ["InputStream", "KnowledgeProcessPrototype", "SourcePrototype", "UnitPrototype"]

T = TypeVar("T")

InputStream = tuple[Label, Policy]
"""An input stream: the label of its stream generator, and the policy that it has to keep."""


class KnowledgeProcessPrototype(Protocol):
    """Something that knowledge processes are made of."""

    @property
    def arity(self) -> int:
        """How many input streams an instance takes."""

    def create_instance(
        self,
        kernel: Kernel,
        label: Label,
        input_streams: Sequence[InputStream],
        output_policy: Policy,
    ) -> StreamGenerator:
        """Add an instance to the network of *kernel* and return its stream generator.

        Raises:
            LabelAlreadyExistsError: There is a stream generator called *label*.
            NoSuchLabelError: There is none of an input stream's label.
            PolicyNotSupportedError: The process cannot keep *output_policy*, or the provider of
                an input stream cannot keep the policy of that.
            WrongNumberOfInputsError: There are too few or too many input streams.
        """


class SourcePrototype:
    """A source, of which an instance is a primitive process.

    Args:
        make: Makes a source whose samples keep a policy; a ValueError says why it cannot.
    """

    arity = 0

    def __init__(self, make: Callable[[Policy], Source]) -> None:
        self._make = make

    def create_instance(
        self,
        kernel: Kernel,
        label: Label,
        input_streams: Sequence[InputStream],
        output_policy: Policy,
    ) -> StreamGenerator:
        """Add a primitive process; it takes no input streams."""
        _check_arity(label, 0, input_streams)
        kernel.add_source(label, _made(self._make, label, output_policy), output_policy)
        return kernel.generator(label)


class UnitPrototype:
    """A computational unit, of which an instance is a refinement process.

    Args:
        make: Makes a unit whose samples keep a policy; a ValueError says why it cannot.
        arity: How many input streams it takes, at least one.
    """

    def __init__(self, make: Callable[[Policy], ComputationalUnit], arity: int) -> None:
        if arity < 1:
            raise ValueError(f"a computational unit takes at least one input, found {arity}")
        self.arity = arity
        self._make = make

    def create_instance(
        self,
        kernel: Kernel,
        label: Label,
        input_streams: Sequence[InputStream],
        output_policy: Policy,
    ) -> StreamGenerator:
        """Add a refinement process that is fed by *input_streams*."""
        _check_arity(label, self.arity, input_streams)
        unit = _made(self._make, label, output_policy)
        kernel.add_unit(label, unit, input_streams, output_policy)
        return kernel.generator(label)


def _made(make: Callable[[Policy], T], label: Label, output_policy: Policy) -> T:
    try:
        return make(output_policy)
    except ValueError as fault:
        raise PolicyNotSupportedError(label, str(fault)) from fault


def _check_arity(label: Label, expected: int, input_streams: Sequence[InputStream]) -> None:
    if len(input_streams) != expected:
        raise WrongNumberOfInputsError(label, expected, len(input_streams))
