"""The knowledge process factory: makes knowledge processes of prototypes, by name.

The interface is that of Heintz (2009), section 5.4.1.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from dyknow.errors import (
    NoSuchLabelError,
    NoSuchPrototypeError,
    PrototypeAlreadyExistsError,
    WrongNumberOfInputsError,
)
from dyknow.runtime.generators import ANYTHING, Label, StreamGenerator
from dyknow.runtime.kernel import Kernel
from dyknow.service.prototypes import InputStream, KnowledgeProcessPrototype
from dyknow.source_text import nearest_name
from dyknow.streams.policy import Policy

__all__ = ["KnowledgeProcessFactory", "RegisteredPrototype"]


@dataclass(frozen=True, slots=True)
class RegisteredPrototype:
    """A prototype as a host has registered it.

    Attributes:
        prototype: What instances are made of.
        input_sorts: The sorts of the inputs.
        output_sort: The sort of the output.
    """

    prototype: KnowledgeProcessPrototype
    input_sorts: tuple[str, ...]
    output_sort: str


class KnowledgeProcessFactory:
    """Keeps the prototypes of an application, and makes and destroys knowledge processes."""

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._registered: dict[str, RegisteredPrototype] = {}
        self._created: dict[Label, str] = {}

    @property
    def prototypes(self) -> Mapping[str, RegisteredPrototype]:
        """The registered prototypes, by name."""
        return MappingProxyType(self._registered)

    @property
    def created(self) -> Mapping[Label, str]:
        """The label of each process made here, and the name of its prototype."""
        return MappingProxyType(self._created)

    def add_prototype(
        self,
        prototype: KnowledgeProcessPrototype,
        name: str,
        input_sorts: Sequence[str],
        output_sort: str,
    ) -> None:
        """Register a prototype, which is what a `source` or `compunit` declaration does.

        Raises:
            PrototypeAlreadyExistsError: There is one of this name.
            WrongNumberOfInputsError: There are not as many sorts as the prototype takes inputs.
        """
        if name in self._registered:
            raise PrototypeAlreadyExistsError(name)
        if len(input_sorts) != prototype.arity:
            raise WrongNumberOfInputsError(name, prototype.arity, len(input_sorts))
        self._registered[name] = RegisteredPrototype(prototype, tuple(input_sorts), output_sort)

    def remove_prototype(self, name: str) -> None:
        """Forget a prototype; processes that were made of it go on.

        Raises:
            NoSuchPrototypeError: There is none of this name.
        """
        self._find(name)
        del self._registered[name]

    def create_knowledge_process(
        self,
        label: Label,
        name: str,
        input_streams: Sequence[InputStream] = (),
        output_policy: Policy = ANYTHING,
    ) -> StreamGenerator:
        """Make a process of the prototype called *name* and return its stream generator.

        Args:
            label: What the stream generator is called from then on.
            name: Of the prototype.
            input_streams: The label and the policy of each input stream.
            output_policy: What the process has to promise about its output.

        Raises:
            NoSuchPrototypeError: There is no prototype of this name.
            LabelAlreadyExistsError: There is a stream generator called *label*.
            NoSuchLabelError: There is none of an input stream's label.
            WrongNumberOfInputsError: There are too few or too many input streams.
            PolicyNotSupportedError: The process cannot keep *output_policy*, or the provider of
                an input stream cannot keep the policy of that.
        """
        prototype = self._find(name).prototype
        if len(input_streams) != prototype.arity:
            raise WrongNumberOfInputsError(name, prototype.arity, len(input_streams))
        generator = prototype.create_instance(self._kernel, label, input_streams, output_policy)
        self._created[label] = name
        return generator

    def destroy_knowledge_process(self, label: Label) -> None:
        """End a process that was made here, with its stream generator.

        Raises:
            NoSuchLabelError: No process of this label was made here.
            LabelInUseError: Others receive its streams.
        """
        if label not in self._created:
            raise NoSuchLabelError(label, nearest_name(label, self._created))
        self._kernel.remove(label)
        del self._created[label]

    def _find(self, name: str) -> RegisteredPrototype:
        if name not in self._registered:
            raise NoSuchPrototypeError(name, nearest_name(name, self._registered))
        return self._registered[name]
