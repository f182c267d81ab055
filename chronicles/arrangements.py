"""From what the grammar puts together to the fields of a node, where the two are not the same."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from chronicles import syntax
from chronicles.syntax import Displaced, Interval
from dyknow.time import MILLISECOND

__all__ = ["ARRANGEMENTS", "plain"]


def plain(child: Any) -> Any:
    """Return a child as it goes into a node: tokens as mere text."""
    return str(child) if isinstance(child, str) else child


def _interval(children: Sequence[Any]) -> Sequence[Any]:
    """Turn the brackets of an interval into its closed ends."""
    left, lower, upper, right = children
    if lower is not None and left == "]":
        lower += MILLISECOND
    if upper is not None and right == "[":
        upper -= MILLISECOND
    return lower, upper


def _comparison(children: Sequence[Any]) -> Sequence[Any]:
    """Part a chain into its operands and the orders between them."""
    return tuple(children[::2]), tuple(str(order) for order in children[1::2])


def _values(children: Sequence[Any]) -> Sequence[Any]:
    return (tuple(child for child in children if child is not None),)


def _event_at(children: Sequence[Any]) -> Sequence[Any]:
    """Turn the moment of an event into its instant and how much later than that it is."""
    event_type, moment = children
    if isinstance(moment, Displaced):
        displacement = moment.interval
    else:
        displacement = Interval(moment.span, moment.offset, moment.offset)
    at_once = displacement.lower == displacement.upper == 0
    return event_type, moment.name, None if at_once else displacement


def _difference(children: Sequence[Any]) -> Sequence[Any]:
    later, _sign, earlier, offset = children
    return str(later), str(earlier), offset


def _length(children: Sequence[Any]) -> Sequence[Any]:
    first, rest = children
    return (first + rest,)


def _chronicle(children: Sequence[Any]) -> Sequence[Any]:
    name, parameters, instants, statements = children
    return str(name), parameters, statements, instants


def _named_constraint(children: Sequence[Any]) -> Sequence[Any]:
    name, *rest = children
    has_terms = bool(rest) and isinstance(rest[0], tuple)
    if has_terms:
        return str(name), rest[0], rest[1]
    return str(name), (), _values(rest)[0]


def _variable_declaration(children: Sequence[Any]) -> Sequence[Any]:
    variables = tuple(c for c in children if isinstance(c, syntax.Variable | syntax.Star))
    return variables, next((c for c in children if c is not None and c not in variables), None)


def _conditional(children: Sequence[Any]) -> Sequence[Any]:
    condition, consequence, *alternative = children
    return condition, consequence, alternative[0] if alternative else None


def _instant_binding(children: Sequence[Any]) -> Sequence[Any]:
    *label, instant = children
    return str(label[0]) if label and label[0] else None, instant


def _names(children: Sequence[Any]) -> Sequence[Any]:
    return (tuple(map(str, children)),)


ARRANGEMENTS: Mapping[str, Callable[[Sequence[Any]], Sequence[Any]]] = {
    "chronicle_file": _values,
    "interval": _interval,
    "comparison": _comparison,
    "value_set": _values,
    "event_at": _event_at,
    "difference": _difference,
    "length": _length,
    "chronicle": _chronicle,
    "named_constraint": _named_constraint,
    "variable_declaration": _variable_declaration,
    "instant_declaration": _names,
    "conditional": _conditional,
    "instant_binding": _instant_binding,
}
