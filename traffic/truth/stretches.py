"""Since when something has been the case without a break."""

from collections.abc import Hashable, Iterable
from typing import Generic, NamedTuple, TypeVar

from dyknow.time import TimePoint

__all__ = ["Stretch", "Stretches"]

Key = TypeVar("Key", bound=Hashable)


class Stretch(NamedTuple, Generic[Key]):
    """Something was the case in all frames from one to another.

    Attributes:
        key: What.
        begin: The first frame.
        end: The last one.
    """

    key: Key
    begin: TimePoint
    end: TimePoint


class Stretches(Generic[Key]):
    """Finds the stretches of frames in which things are the case."""

    def __init__(self) -> None:
        self._begins: dict[Key, TimePoint] = {}
        self._last = TimePoint(0)

    def __contains__(self, key: Key) -> bool:
        return key in self._begins

    def observe(self, time: TimePoint, holding: Iterable[Key]) -> list[Stretch[Key]]:
        """Take in all that is the case in the next frame; return what ended in the one before."""
        begins = {key: self._begins.get(key, time) for key in holding}
        ended = [
            Stretch(key, begin, self._last)
            for key, begin in self._begins.items()
            if key not in begins
        ]
        self._begins, self._last = begins, time
        return ended

    def finish(self) -> list[Stretch[Key]]:
        """Return what is the case in the last frame."""
        return [Stretch(key, begin, self._last) for key, begin in self._begins.items()]
