"""What output streams need, and declarations that none of them can need."""

from collections.abc import Collection, Iterable

from dyknow.errors import SpecificationError
from dyknow.kpl.names import Declarations, Placed, Scope, descendants, labels_of
from dyknow.kpl.syntax import (
    Configuration,
    Declaration,
    GeneratorDeclaration,
    Link,
    Name,
    ParameterDeclaration,
    Process,
    Provider,
    SourceDeclaration,
    SourceInstance,
    Specification,
    StreamDeclaration,
    UnitDeclaration,
    UnitInstance,
)

__all__ = ["Needs", "warnings"]


def warnings(specification: Specification) -> list[SpecificationError]:
    """Return a remark on every declaration that is not used, in reading order.

    A stream generator is used if an output stream needs it, for some values of the parameters:
    a label with a parameter in it may mean any label of that feature.
    """
    parameters = Declarations(specification).parameters
    declared = Declarations(specification, wild=parameters)
    use = _Use(declared)
    unused = [each for each, _ in declared.scoped() if not use.needs(each)]
    return [SpecificationError(f"'{_name(each)}' is not used", each.span) for each in unused]


class Needs:
    """Which stream generators and configuration blocks some output streams need.

    Attributes:
        generators: The generators, by the identity of their declarations.
        blocks: The blocks, by identity: those around a generator or an output that is needed.
    """

    def __init__(self, declared: Declarations, outputs: Iterable[StreamDeclaration]) -> None:
        self.generators: dict[int, Placed] = {}
        self.blocks: dict[int, Configuration] = {}
        self._declared = declared
        wanted = {id(output) for output in outputs}
        self._waiting: list[tuple[Process | Provider, Scope]] = []
        for declaration, scope in declared.scoped():
            if isinstance(declaration, StreamDeclaration) and id(declaration) in wanted:
                self._enter(scope)
                self._waiting.append((declaration.stream.provider, scope))
        while self._waiting:
            self._follow(*self._waiting.pop())

    @property
    def outside(self) -> list[GeneratorDeclaration]:
        """The generators that are not declared in a block, in reading order."""
        found = [p for p in self._declared.placed if id(p.declaration) in self.generators]
        return [placed.declaration for placed in found if not placed.scope.blocks]

    def _follow(self, node: Process | Provider, scope: Scope) -> None:
        for label, place in labels_of(node, scope):
            for placed in self._declared.meaning(label, place).all:
                if id(placed.declaration) not in self.generators:
                    self.generators[id(placed.declaration)] = placed
                    self._enter(placed.scope)
                    self._waiting.append((placed.declaration.process, placed.scope))

    def _enter(self, scope: Scope) -> None:
        for at, block in enumerate(scope.blocks):
            if id(block) not in self.blocks:
                self.blocks[id(block)] = block
                self._waiting.append((block.members.provider, Scope(scope.blocks[:at])))


class _Use:
    """What is used in a specification whose parameters are not bound."""

    def __init__(self, declared: Declarations) -> None:
        everything = [declaration for declaration, _ in declared.scoped()]
        outputs = [each for each in everything if isinstance(each, StreamDeclaration)]
        self._needs = Needs(declared, outputs)
        self._symbols = _symbols(placed.declaration.process for placed in declared.placed)
        kinds = GeneratorDeclaration | StreamDeclaration | Configuration
        users = tuple(each for each in declared.all if isinstance(each, kinds))
        self._names = {node.text for node in descendants(users) if isinstance(node, Name)}

    def needs(self, declaration: Declaration) -> bool:
        match declaration:
            case SourceDeclaration(_, name) | UnitDeclaration(_, name):
                return name.text in self._symbols
            case ParameterDeclaration(name):
                return name.text in self._names
            case GeneratorDeclaration():
                return id(declaration) in self._needs.generators
            case Configuration():
                return id(declaration) in self._needs.blocks
            case StreamDeclaration():
                return True


def _symbols(processes: Iterable[Process]) -> Collection[str]:
    """Return the symbols of the sources and computational units that are in use."""
    return {
        process.source.text if isinstance(process, SourceInstance) else process.unit.text
        for process in processes
        if isinstance(process, SourceInstance | UnitInstance | Link)
    }


def _name(declaration: Declaration) -> str:
    match declaration:
        case GeneratorDeclaration(label):
            return label.text
        case Configuration(member):
            return f"for each {member.text}"
        case _:
            return declaration.name.text
