"""Declarations that no output stream can need."""

from dyknow.errors import SpecificationError
from dyknow.kpl.names import Declarations, descendants, labels_in, streams_of
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    Declaration,
    GeneratorDeclaration,
    Label,
    Link,
    Name,
    ParameterDeclaration,
    SourceDeclaration,
    SourceInstance,
    Specification,
    StreamDeclaration,
    UnitDeclaration,
    UnitInstance,
)

__all__ = ["warnings"]


def warnings(specification: Specification) -> list[SpecificationError]:
    """Return a remark on every declaration that is not used, in reading order.

    A stream generator is used if an output stream needs it, for some values of the parameters:
    a label with a parameter in it may mean any label of that feature.
    """
    use = _Use(specification)
    unused = [each for each in specification.declarations if not use.needs(each)]
    return [SpecificationError(f"'{_name(each)}' is not used", each.span) for each in unused]


class _Use:
    """What is used in a specification whose parameters are not bound."""

    def __init__(self, specification: Specification) -> None:
        declared = Declarations(specification)
        self._parameters = declared.parameters.keys()
        self._generators = [d for d in declared.all if isinstance(d, GeneratorDeclaration)]
        outputs = [d for d in declared.all if isinstance(d, StreamDeclaration)]
        processes = [each.process for each in self._generators]
        self._symbols = {
            process.source.text if isinstance(process, SourceInstance) else process.unit.text
            for process in processes
            if isinstance(process, SourceInstance | UnitInstance | Link)
        }
        self._names = {
            node.text
            for node in descendants((*self._generators, *outputs))
            if isinstance(node, Name)
        }
        self._needed: list[Label] = []
        for label in labels_in([output.stream for output in outputs]):
            self._need(label)

    def needs(self, declaration: Declaration) -> bool:
        match declaration:
            case SourceDeclaration(_, name) | UnitDeclaration(_, name):
                return name.text in self._symbols
            case ParameterDeclaration(name):
                return name.text in self._names
            case GeneratorDeclaration(label):
                return any(self._may_mean(needed, label) for needed in self._needed)
            case StreamDeclaration():
                return True

    def _need(self, label: Label) -> None:
        if label in self._needed:
            return
        self._needed.append(label)
        for generator in self._generators:
            if self._may_mean(label, generator.label):
                for each in labels_in(streams_of(generator.process)):
                    self._need(each)

    def _may_mean(self, label: Label, other: Label) -> bool:
        if label.feature != other.feature or len(label.objects) != len(other.objects):
            return False
        return all(
            one == two or one.text in self._parameters or two.text in self._parameters
            for one, two in zip(label.objects, other.objects, strict=True)
        )


def _name(declaration: Declaration) -> str:
    if isinstance(declaration, GeneratorDeclaration):
        return text_from(declaration.label)
    return declaration.name.text
