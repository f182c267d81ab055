"""What is made of itself: domains, named constraints, and chronicles."""

from collections.abc import Iterator, Mapping, Sequence

from chronicles.conditions import references_of
from chronicles.errors import RecursionInChroniclesError
from chronicles.event_types import event_type_of
from chronicles.expansion import statements_used
from chronicles.syntax import ChronicleFile, DomainDeclaration, Inclusion
from dyknow.errors import CircularDefinitionError, SpecificationError, UnknownNameError
from dyknow.source_text import nearest_name

__all__ = ["circles", "faults_of_domains"]


def faults_of_domains(declarations: Sequence[DomainDeclaration]) -> Iterator[SpecificationError]:
    """Yield the domains that are made of unknown ones or of themselves."""
    names = [declaration.name for declaration in declarations]
    for declaration in declarations:
        for reference in references_of(declaration.domain):
            if reference.name not in names:
                nearest = nearest_name(reference.name, names)
                yield UnknownNameError("domain", reference.name, reference.span, nearest)
    used = {d.name: [r.name for r in references_of(d.domain)] for d in declarations}
    for declaration in declarations:
        circle = _circle(declaration.name, used)
        if circle and declaration.name == min(circle):
            yield CircularDefinitionError(circle, declaration.span)


def circles(file: ChronicleFile) -> Iterator[SpecificationError]:
    """Yield the chronicles and constraints that are made of themselves."""
    chronicles = {chronicle.name for chronicle in file.chronicles}
    signals = {signal.name for signal in file.signals}
    used: dict[str, list[str]] = {}
    for chronicle in file.chronicles:
        names = [u.name for u in statements_used(chronicle) if isinstance(u, Inclusion)]
        types = [event_type_of(statement) for statement in chronicle.plain]
        events = {t.name for t in types if t is not None} - signals
        used.setdefault(chronicle.name, [*names, *sorted(events & chronicles)])
    for chronicle in file.chronicles:
        circle = _circle(chronicle.name, used)
        if circle and chronicle.name == min(circle):
            yield RecursionInChroniclesError(circle, chronicle.span)
    used = {c.name: [u.name for u in statements_used(c)] for c in file.constraints}
    for constraint in file.constraints:
        circle = _circle(constraint.name, used)
        if circle and constraint.name == min(circle):
            yield RecursionInChroniclesError(circle, constraint.span)


def _circle(name: str, used: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the shortest way from *name* to itself; empty if there is none."""
    ways = [[name]]
    seen: set[str] = set()
    for way in ways:
        for following in used.get(way[-1], ()):
            if following == name:
                return [*way, name]
            if following not in seen:
                seen.add(following)
                ways.append([*way, following])
    return []
