"""What a chronicle file declares, by name."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from chronicles.conditions import holds, members_of, parts_of, references_of, variables_in
from chronicles.syntax import (
    Amount,
    AttributeDeclaration,
    Chronicle,
    ChronicleFile,
    Condition,
    ConstraintDeclaration,
    Domain,
    DomainDeclaration,
    Membership,
    MessageDeclaration,
)

__all__ = ["Declared", "Named", "Signal"]


Named = Chronicle | ConstraintDeclaration | AttributeDeclaration | MessageDeclaration
Signal = AttributeDeclaration | MessageDeclaration | Chronicle


@dataclass(frozen=True)
class Declared:
    """What a file declares, by name."""

    domains: Mapping[str, Domain]
    constraints: Mapping[str, ConstraintDeclaration]
    signals: Mapping[str, AttributeDeclaration | MessageDeclaration]
    chronicles: Mapping[str, Chronicle]
    parameters: Mapping[str, Amount]

    @staticmethod
    def of(file: ChronicleFile) -> "Declared":
        """Return what *file* declares; of several of one name, the first."""
        return Declared(
            _whole_domains(file.domains),
            file.constraint_by_name,
            {declaration.name: declaration for declaration in file.signals},
            file.chronicle_by_name,
            {declaration.name: declaration.value for declaration in reversed(file.parameters)},
        )

    def allowed(self, signal: Signal, parameter: str) -> Callable[[str], bool]:
        """Return what tells whether a value may stand for *parameter* in *signal*."""
        conditions = [
            condition
            for condition in getattr(signal, "conditions", ())
            if {variable.name for variable in variables_in(condition)} == {parameter}
            and self.knows_domains_of(condition)
        ]
        return lambda value: all(
            holds(condition, {parameter: value}, self.domains) for condition in conditions
        )

    def listed(self, signal: Signal, parameter: str) -> Iterator[str]:
        """Yield the values that are written down for *parameter* in *signal*."""
        for condition in getattr(signal, "conditions", ()):
            names = [variable.name for variable in variables_in(condition)]
            is_membership = isinstance(condition, Membership) and names == [parameter]
            if is_membership and self.knows_domains_of(condition):
                yield from sorted(members_of(condition.domain, self.domains).values)

    def knows_domains_of(self, condition: Condition) -> bool:
        """Return whether every domain in *condition* is known."""
        parts = [part for part in parts_of(condition) if isinstance(part, Membership)]
        names = [ref.name for part in parts for ref in references_of(part.domain)]
        return all(name in self.domains for name in names)


def _whole_domains(declarations: Sequence[DomainDeclaration]) -> dict[str, Domain]:
    """Return the domains that can be worked out, by name: no circle, no unknown name."""
    waiting = {declaration.name: declaration.domain for declaration in declarations}
    whole: dict[str, Domain] = {}
    while True:
        ready = [n for n, d in waiting.items() if all(r.name in whole for r in references_of(d))]
        if not ready:
            return whole
        for name in ready:
            whole[name] = waiting.pop(name)
