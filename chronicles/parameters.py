"""Parameters of a chronicle file: lengths of time and numbers that whoever uses it may replace.

A name in a constraint is that of an instant or of a parameter: what is declared tells which, when
the whole file has been read. So all that is made of a file knows values only.
"""

import re
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping

from chronicles.errors import ChronicleError, UnknownParameterError
from chronicles.expansion import instants_of, statements_used
from chronicles.spacing import respaced
from chronicles.syntax import (
    Amount,
    Chronicle,
    ChronicleFile,
    Comparison,
    ConstraintDeclaration,
    Difference,
    Inclusion,
    Instant,
    InstantDeclaration,
    Length,
    Number,
    Operand,
    ParameterDeclaration,
    Parametric,
    Statement,
    Within,
)
from dyknow.errors import SortMismatchError, SpecificationError, UnknownNameError
from dyknow.source_text import MADE_IN_PYTHON, SourceText, Span, nearest_name
from dyknow.time import MILLISECOND, Duration, duration_from_text

__all__ = [
    "LONGEST",
    "Given",
    "Values",
    "amount_from",
    "faults_of_instants",
    "faults_of_values",
    "length_from",
    "parameters_behind",
]

LONGEST = 1 << 58
"""The longest length of time that may be written, in nanoseconds: nine years."""

Given = Amount | int | float | str
"""What a parameter can be set to: 3, "3", "30 s", "-1 s", or an `Amount`, which knows its place.

A bare number is milliseconds where a length of time stands.
"""

_WHOLE = re.compile(r"\s*[+-]?\d{1,18}\s*", re.ASCII)


def amount_from(given: Given, span: Span = MADE_IN_PYTHON) -> Amount:
    """Return what a parameter is set to, written at *span*.

    Raises:
        ChronicleError: It is neither a length of time nor a number.
    """
    if isinstance(given, Length | Number):
        return given
    text = str(given)
    if isinstance(given, float) and given.is_integer():
        text = str(int(given))
    if not isinstance(given, bool) and _WHOLE.fullmatch(text):
        return Number(span, int(text))
    return Length(span, length_from(text, span))


def length_from(text: str, span: Span) -> Duration:
    """Return the length of time that *text*, written at *span*, says.

    Raises:
        ChronicleError: It says none, or one that chronicles cannot have.
    """
    try:
        length = duration_from_text(text)
    except ValueError as error:
        raise ChronicleError(str(error), span) from error
    if length % MILLISECOND:
        message = f"'{text}' is finer than a millisecond, the instant of chronicles"
        raise ChronicleError(message, span)
    if abs(length) > LONGEST:
        raise ChronicleError(f"'{text}' is longer than nine years", span)
    return length


class Values:
    """The values of the parameters of a file that is being read, and where they are used.

    Args:
        source: The text of the file.
        declared: What the file declares, by name.
        given: What takes the place of that.

    Attributes:
        faults: What is wrong with values and names.
    """

    def __init__(
        self, source: SourceText, declared: Mapping[str, Amount], given: Mapping[str, Amount]
    ) -> None:
        self._source = source
        self._amounts = {name: given.get(name, amount) for name, amount in declared.items()}
        self._given = given
        self._places: list[int] = []
        self._names: list[str] = []
        self.faults = list(faults_of_values(given, declared, source.name))

    def length(self, name: str, start: int) -> Duration:
        """Return the length that a name stands for at an offset of the text."""
        return MILLISECOND if self._used(name, start) is None else self._length(name, start)

    def count(self, name: str, start: int) -> int:
        """Return the number of events that a name stands for at an offset of the text."""
        amount = self._used(name, start)
        if isinstance(amount, Length):
            what = f"the parameter '{name}'"
            place = self._blamed(name, start)
            self.faults.append(SortMismatchError(what, "number", "time", place))
        elif amount is not None and amount.value < 0:
            message = f"expected a number of events, found the parameter '{name}', which is"
            place = self._blamed(name, start)
            self.faults.append(ChronicleError(f"{message} {amount.value}", place))
        return amount.value if isinstance(amount, Number) else 1

    def stated(self, statement: Statement) -> Statement | Parametric:
        """Return a statement with the values of its parameters, and how it was written."""
        span = statement.span
        statement, names = self._resolved(statement)
        first = bisect_left(self._places, span.start)
        last = bisect_left(self._places, span.end)
        names += self._names[first:last]
        if not names:
            return statement
        text = respaced(span.source.text[span.start : span.end])
        return Parametric(span, text, tuple(sorted(set(names))), statement)

    def _resolved(self, statement: Statement) -> tuple[Statement, list[str]]:
        """Return a statement without names of parameters where instants can stand."""
        names: list[str] = []
        match statement:
            case Comparison(span, operands, orders):
                found = tuple(self._operand(operand, names) for operand in operands)
                return Comparison(span, found, orders), names
            case Within(span, Difference(_, _, earlier, _) as difference, interval):
                operand = self._operand(difference, names)
                if earlier in self._amounts and isinstance(operand, Instant):
                    return Within(span, operand, interval), names
            case _:
                pass
        return statement, []

    def _operand(self, operand: Operand, names: list[str]) -> Operand:
        """Return an operand with the lengths of its parameters, and note their names."""
        match operand:
            case Instant(span, name, offset) if name in self._amounts:
                names.append(name)
                return Length(span, Duration(self._length(name, span.start) + offset))
            case Difference(span, later, earlier, offset) if earlier in self._amounts:
                names.append(earlier)
                rest = Duration(offset - self._length(earlier, span.start))
                return self._operand(Instant(span, later, rest), names)
            case _:
                return operand

    def _length(self, name: str, start: int) -> Duration:
        """Return the length that a parameter stands for, at most a longest one."""
        amount = self._amounts[name]
        length = amount.duration if isinstance(amount, Length) else amount.value * MILLISECOND
        if abs(length) <= LONGEST:
            return Duration(length)
        message = f"the parameter '{name}' is longer than nine years"
        self.faults.append(ChronicleError(message, self._blamed(name, start)))
        return MILLISECOND

    def _used(self, name: str, start: int) -> Amount | None:
        amount = self._amounts.get(name)
        if amount is None:
            nearest = nearest_name(name, self._amounts)
            self.faults.append(
                UnknownNameError("parameter", name, self._span(name, start), nearest)
            )
        else:
            self._places.append(start)
            self._names.append(name)
        return amount

    def _blamed(self, name: str, start: int) -> Span:
        """Return where an unfit value was given, or else where the name stands."""
        return self._given[name].span if name in self._given else self._span(name, start)

    def _span(self, name: str, start: int) -> Span:
        return Span(self._source, start, start + len(name))


def parameters_behind(chronicle: Chronicle, file: ChronicleFile) -> list[ParameterDeclaration]:
    """Return the parameters on which depends what *chronicle* means, also through others."""
    found: set[str] = set()
    seen: set[int] = set()
    ahead: list[Chronicle | ConstraintDeclaration] = [chronicle]
    while ahead:
        declaration = ahead.pop()
        if id(declaration) in seen:
            continue
        seen.add(id(declaration))
        for statement in declaration.statements:
            if isinstance(statement, Parametric):
                found.update(statement.parameters)
        for use in statements_used(declaration):
            known = (
                file.chronicle_by_name if isinstance(use, Inclusion) else file.constraint_by_name
            )
            ahead += [known[use.name]] if use.name in known else []
    return [parameter for parameter in file.parameters if parameter.name in found]


def faults_of_values(
    given: Mapping[str, Amount], known: Iterable[str], file: str
) -> Iterator[SpecificationError]:
    """Yield the values that no parameter of a file is there for."""
    known = list(known)
    for name, amount in given.items():
        if name not in known:
            yield UnknownParameterError(name, file, known, amount.span)


def faults_of_instants(file: ChronicleFile) -> Iterator[SpecificationError]:
    """Yield the places where a name can only be an instant, and is a parameter."""
    parameters = {parameter.name for parameter in file.parameters}
    if not parameters:
        return
    declarations: list[Chronicle | ConstraintDeclaration] = [*file.chronicles, *file.constraints]
    for declaration in declarations:
        for name, span in dict(reversed([*_instants(declaration)])).items():
            if name in parameters:
                message = f"'{name}' is a parameter of the file; expected an instant"
                yield ChronicleError(message, span)


def _instants(declaration: Chronicle | ConstraintDeclaration) -> Iterator[tuple[str, Span]]:
    """Yield the names of instants in a declaration, and where they stand."""
    yield from ((name, declaration.span) for name in declaration.instants)
    for statement in declaration.plain:
        names = statement.names if isinstance(statement, InstantDeclaration) else ()
        yield from ((name, statement.span) for name in (*names, *instants_of(statement)))
