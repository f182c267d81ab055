"""What a chronicle says in its own words: named constraints and included chronicles put in.

Both are purely a way of writing (Heintz 2009, sections 8.3.3 and 8.4). The instants and local
variables of an included chronicle get the name of that chronicle in front, which nothing that a
person writes can be mistaken for: `overtake.t1`, `?overtake.x`.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any

from chronicles.printer import text_of_moment
from chronicles.syntax import (
    Anything,
    Chronicle,
    ChronicleFile,
    Comparison,
    ConstraintDeclaration,
    Difference,
    Displaced,
    EventAt,
    Inclusion,
    Instant,
    InstantDeclaration,
    Interval,
    Membership,
    NamedConstraint,
    Parameter,
    ReportAll,
    ReportNonOverlapping,
    Star,
    Statement,
    Value,
    Variable,
    VariableDeclaration,
)
from dyknow.source_text import Span
from dyknow.time import Duration

__all__ = [
    "DEEPEST",
    "END",
    "MOST_EVENTS",
    "START",
    "Expansion",
    "Extreme",
    "expand",
    "instants_of",
    "statements_used",
]

START = "start"
END = "end"

DEEPEST = 100
"""How many chronicles and constraints may be inside one another."""

MOST_EVENTS = 500
"""How many events a chronicle may ask for, with those of what it includes."""

_MOST_STATEMENTS = 10_000


@dataclass(frozen=True, slots=True)
class Extreme:
    """`start` or `end`: the earliest or the latest of some instants.

    Attributes:
        is_end: Whether it is the latest.
        members: The instants, all of them times of events.
    """

    is_end: bool
    members: tuple[str, ...]


@dataclass
class Expansion:
    """A chronicle in statements that need no others.

    Attributes:
        statements: Events, counters, constraints, conditions, and reports, of instants without
            displacement as times of events.
        extremes: What stands for the beginning or the end, by name.
        declared: The instants that are declared, and where.
        stars: The star variables that are declared, and where.
        is_too_large: Whether something is left out because there is too much.
    """

    statements: list[Statement] = field(default_factory=list)
    extremes: dict[str, Extreme] = field(default_factory=dict)
    declared: dict[str, Span] = field(default_factory=dict)
    stars: dict[str, Span] = field(default_factory=dict)
    is_too_large: bool = False

    @property
    def events(self) -> list[EventAt]:
        """The `event` predicates."""
        return [s for s in self.statements if isinstance(s, EventAt)]


@dataclass(frozen=True)
class _Words:
    """What the words of a text that is put in stand for."""

    prefix: str = ""
    variables: Mapping[str, Parameter] = field(default_factory=dict)
    instants: Mapping[str, Instant] = field(default_factory=dict)

    def instant(self, name: str, span: Span) -> Instant:
        return self.instants.get(name, Instant(span, f"{self.prefix}{name}", Duration(0)))

    def variable(self, node: Variable | Star) -> Parameter:
        if node.name in self.variables:
            return self.variables[node.name]
        mark, name = node.name[0], node.name[1:]
        return replace(node, name=f"{mark}{self.prefix}{name}")


def expand(chronicle: Chronicle, file: ChronicleFile) -> Expansion:
    """Return what *chronicle* says, with everything of *file* that it refers to put in.

    Names that nothing declares, and circles, are left out; `chronicles.check` tells them.
    """
    return _Expander(file).expand(chronicle)


def instants_of(statement: Any) -> Iterator[str]:  # noqa: C901, PLR0912  # one case each
    """Yield the names of the instants in a statement, as often as they stand in it."""
    match statement:
        case Instant(_, name, _) | Displaced(_, name, _) | EventAt(_, _, name, _):
            yield name
        case Difference(_, later, earlier, _):
            yield from (later, earlier)
        case ReportNonOverlapping(_, begin, end):
            yield from (begin, end)
        case tuple():
            for part in statement:
                yield from instants_of(part)
        case _ if is_dataclass(statement):
            for each in fields(statement):
                if each.name != "span":
                    yield from instants_of(getattr(statement, each.name))
        case _:
            pass


def statements_used(
    declaration: Chronicle | ConstraintDeclaration,
) -> Iterator[Inclusion | NamedConstraint]:
    """Yield the statements that put something in."""
    for statement in declaration.plain:
        if isinstance(statement, Inclusion | NamedConstraint):
            yield statement


class _Expander:
    def __init__(self, file: ChronicleFile) -> None:
        self._chronicles = file.chronicle_by_name
        self._constraints = file.constraint_by_name
        self._found = Expansion()
        self._path: list[str] = []
        self._n_events = 0
        self._n_anonymous: dict[str, int] = {}

    def expand(self, chronicle: Chronicle) -> Expansion:
        self._put_in(chronicle, _Words())
        return self._found

    def _put_in(self, chronicle: Chronicle, words: _Words) -> None:
        self._path.append(chronicle.name)
        first = len(self._found.statements)
        self._add(chronicle.plain, words, is_included=bool(words.prefix))
        events = [s for s in self._found.statements[first:] if isinstance(s, EventAt)]
        members = tuple(dict.fromkeys(event.instant for event in events))
        for name in (START, END):
            if name not in words.instants:
                extreme = Extreme(name == END, members)
                self._found.extremes[f"{words.prefix}{name}"] = extreme
        self._path.pop()

    def _add(self, statements: Sequence[Statement], words: _Words, *, is_included: bool) -> None:
        for statement in statements:
            match statement:
                case Inclusion():
                    self._include(statement, words)
                case NamedConstraint():
                    self._constrain(statement, words, is_included=is_included)
                case VariableDeclaration():
                    self._declare(statement, words)
                case InstantDeclaration(span, names):
                    self._found.declared.update(
                        {words.instant(n, span).name: span for n in names if not is_included}
                    )
                case ReportAll() | ReportNonOverlapping() if is_included:
                    pass
                case EventAt():
                    self._add_event(_renamed(statement, words))
                case _:
                    self._found.statements.append(_renamed(statement, words))

    def _is_full(self, n_inside: int = 0) -> bool:
        """Return whether nothing more may be put in, and remember it if so.

        Args:
            n_inside: How many chronicles and constraints are around what would be put in.
        """
        found = self._found
        is_full = (
            n_inside > DEEPEST
            or self._n_events > MOST_EVENTS
            or len(found.statements) > _MOST_STATEMENTS
        )
        found.is_too_large = found.is_too_large or is_full
        return is_full

    def _add_event(self, event: EventAt) -> None:
        """Add an event; the time of one that is displaced is an instant of its own."""
        self._n_events += 1
        if self._is_full():
            return
        displacement = event.displacement
        if displacement is None:
            self._found.statements.append(event)
            return
        span = event.span
        moment = Displaced(event.span, event.instant, displacement)
        name = text_of_moment(event.instant, displacement)
        if displacement.lower != displacement.upper:
            self._n_anonymous[name] = self._n_anonymous.get(name, 0) + 1
            if self._n_anonymous[name] > 1:
                name = f"{name} #{self._n_anonymous[name]}"
        self._found.statements.append(replace(event, instant=name, displacement=None))
        where = Comparison(span, (Instant(span, name, Duration(0)), moment), ("=",))
        self._found.statements.append(where)

    def _declare(self, declaration: VariableDeclaration, words: _Words) -> None:
        for variable in declaration.variables:
            renamed = words.variable(variable)
            if isinstance(renamed, Star):
                self._found.stars.setdefault(renamed.name, variable.span)
            if declaration.domain is not None:
                membership = Membership(declaration.span, variable, declaration.domain)
                self._found.statements.append(_renamed(membership, words))

    def _constrain(self, use: NamedConstraint, words: _Words, *, is_included: bool) -> None:
        declaration = self._constraints.get(use.name)
        if declaration is None or use.name in self._path or not _fits(use, declaration):
            return
        if self._is_full(len(self._path)):
            return
        names = [parameter.name for parameter in declaration.parameters]
        use = _renamed(use, words)
        inner = _Words(
            prefix=words.prefix,
            variables=dict(zip(names, use.parameters, strict=True)),
            instants=dict(zip(declaration.instants, use.instants, strict=True)),
        )
        self._path.append(use.name)
        self._add(declaration.plain, inner, is_included=is_included)
        self._path.pop()

    def _include(self, use: Inclusion, words: _Words) -> None:
        chronicle = self._chronicles.get(use.name)
        if chronicle is None or use.name in self._path or not _fits_chronicle(use, chronicle):
            return
        if self._is_full(len(self._path)):
            return
        number = self._n_anonymous[use.name] = self._n_anonymous.get(use.name, 0) + 1
        prefix = f"{words.prefix}{use.name}{'' if number == 1 else number}."
        parameters = zip(chronicle.parameters, use.parameters, strict=True)
        instants = {
            binding.label or chronicle.instants[i]: _renamed(binding.instant, words)
            for i, binding in enumerate(use.bindings)
        }
        inner = _Words(
            prefix=prefix,
            variables={
                formal.name: _actual(_renamed(actual, words), f"{prefix}{formal.name[1:]}")
                for formal, actual in parameters
            },
            instants={n: i for n, i in instants.items() if n not in (START, END)},
        )
        self._put_in(chronicle, inner)
        self._bind_extremes(prefix, instants)

    def _bind_extremes(self, prefix: str, instants: Mapping[str, Instant]) -> None:
        """Let our instants that were bound to `start` and `end` of what is included be those."""
        for label in (START, END):
            if label in instants:
                ours = instants[label]
                inner = Instant(ours.span, f"{prefix}{label}", Duration(0))
                comparison = Comparison(ours.span, (ours, inner), ("=",))
                self._found.statements.append(comparison)


def _actual(parameter: Parameter, name: str) -> Parameter:
    """Return what a parameter of an included chronicle stands for.

    What does not matter to us is still one value for the chronicle that is included.
    """
    if isinstance(parameter, Anything | Star):
        return Variable(parameter.span, f"?{name}")
    return parameter


def _fits(use: NamedConstraint, declaration: ConstraintDeclaration) -> bool:
    return len(use.parameters) == len(declaration.parameters) and len(use.instants) == len(
        declaration.instants
    )


def _fits_chronicle(use: Inclusion, chronicle: Chronicle) -> bool:
    n_by_place = sum(binding.label is None for binding in use.bindings)
    by_place_first = all(binding.label is None for binding in use.bindings[:n_by_place])
    return (
        len(use.parameters) == len(chronicle.parameters)
        and by_place_first
        and n_by_place <= len(chronicle.instants)
    )


def _renamed(node: Any, words: _Words) -> Any:  # noqa: C901, PLR0911, PLR0912  # one case each
    """Return *node* with every variable and instant replaced by what it stands for."""
    match node:
        case Variable() | Star():
            return words.variable(node)
        case Instant(span, name, offset):
            instant = words.instant(name, span)
            return replace(instant, span=span, offset=Duration(instant.offset + offset))
        case Difference(span, later, earlier, offset):
            first, second = words.instant(later, span), words.instant(earlier, span)
            total = Duration(offset + first.offset - second.offset)
            return Difference(span, first.name, second.name, total)
        case Displaced(span, name, interval):
            instant = words.instant(name, span)
            return Displaced(span, instant.name, _shifted(interval, instant.offset))
        case EventAt(span, event_type, name, displacement):
            instant = words.instant(name, span)
            where = displacement or Interval(span, Duration(0), Duration(0))
            where = _shifted(where, instant.offset)
            at_once = where.lower == where.upper == 0
            return EventAt(
                span, _renamed(event_type, words), instant.name, None if at_once else where
            )
        case ReportNonOverlapping(span, begin, end):
            first, second = words.instant(begin, span), words.instant(end, span)
            return ReportNonOverlapping(span, first.name, second.name)
        case tuple():
            return tuple(_renamed(part, words) for part in node)
        case _ if is_dataclass(node) and not isinstance(node, Span | Value | type):
            parts = {each.name: getattr(node, each.name) for each in fields(node)}
            renamed = {
                name: part if isinstance(part, Span) else _renamed(part, words)
                for name, part in parts.items()
            }
            return type(node)(**renamed)
        case _:
            return node


def _shifted(interval: Interval, offset: int) -> Interval:
    def plus(limit: Duration | None) -> Duration | None:
        return None if limit is None else Duration(limit + offset)

    return Interval(interval.span, plus(interval.lower), plus(interval.upper))
