"""The members of sets, and the unit of a mediation, which merges streams that come and go."""

import re
from collections.abc import Callable, Iterable
from typing import Any

from dyknow.kpl.syntax import Label, Name
from dyknow.streams.merging import Merge
from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_SAMPLE, NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint

__all__ = ["Mediator", "is_object", "label_from", "members_in", "objects_in"]

_NAME = re.compile(r"[A-Za-z_]\w*")
_LABEL = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:\[([^\[\]]*)\]\s*)?")


class Mediator(Reactive):
    """Emits every sample of its inputs but the first, which has sets of members.

    Which inputs there are besides the first is up to somebody else, who is told of each new set.
    Samples that become available at one instant follow each other in the order of the inputs,
    a nanosecond apart. Both times of a sample stay as they are otherwise.
    """

    def __init__(self) -> None:
        self.on_members: Callable[[Any], object] = lambda _members: None
        self._merge = Merge(1)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Emit the new samples of the streams that are merged; tell of a new set."""
        members, *merged = inputs
        if members.available_time == now and members is not NO_SAMPLE:
            self.on_members(members.value)
        return self._merge.push(now, tuple(merged))


def members_in(value: Any) -> tuple[str, ...]:
    """Return the members that a value stands for: objects, or labels.

    A table stands for the objects that it has, a set, list or tuple of names for these, in the
    order of the alphabet if it has none of its own, and a name for itself.

    Raises:
        ValueError: The value is none of these.
    """
    match value:
        case Table():
            return tuple(value.symbol(int(each)) for each in value.ids)
        case str():
            return (value,)
        case set() | frozenset():
            return tuple(sorted(_names(value)))
        case list() | tuple():
            return tuple(dict.fromkeys(_names(value)))
        case _ if value is NO_VALUE:
            return ()
        case _:
            raise ValueError(f"expected a set of objects, or one, found {value!r}")


def objects_in(value: Any) -> tuple[str, ...]:
    """Return the members that a value stands for, which must be objects.

    Raises:
        ValueError: They are not.
    """
    members = members_in(value)
    for member in members:
        if not is_object(member):
            raise ValueError(f"expected the name of an object, found {member!r}")
    return members


def is_object(name: str) -> bool:
    """Return whether *name* can stand in a label."""
    return _NAME.fullmatch(name) is not None


def label_from(text: str) -> Label:
    """Return the label that *text* is.

    Raises:
        ValueError: It is none.
    """
    found = _LABEL.fullmatch(text)
    objects = [] if found is None or found[2] is None else found[2].split(",")
    if found is None or not all(_NAME.fullmatch(each.strip()) for each in objects):
        raise ValueError(f"expected a label such as 'pos[car1]', found {text!r}")
    return Label(Name(found[1]), tuple(Name(each.strip()) for each in objects))


def _names(values: Iterable[Any]) -> list[str]:
    names = list(values)
    if not all(isinstance(name, str) for name in names):
        raise ValueError(f"expected the names of objects, found {names!r}")
    return names
