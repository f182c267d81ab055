"""Object linkage structures: which objects are taken to be the same physical object, over time.

See Heintz (2009), section 8.5.2, and Heintz, Kvarnström and Doherty (2009), section IV. Links are
kept for good, with the time at which they ended, so that whatever was concluded about a symbol can
be followed down to the percepts behind it.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from anchoring.links import Link, LinkEnd
from dyknow.time import TimePoint

__all__ = ["LinkHistory", "ObjectLinkageStructure", "ObjectLinkageStructures"]


class LinkHistory:
    """All links that one link process has made, standing and removed."""

    def __init__(self) -> None:
        self._by_upper: dict[str, list[Link]] = defaultdict(list)
        self._uppers_by_lower: dict[str, list[str]] = defaultdict(list)

    def __iter__(self) -> Iterator[Link]:
        for links in self._by_upper.values():
            yield from links

    def make(self, upper: str, lower: str, time: TimePoint) -> None:
        """Record that *upper* was linked to *lower*."""
        self._by_upper[upper].append(Link(upper, lower, time))
        self._uppers_by_lower[lower].append(upper)

    def remove(self, upper: str, time: TimePoint, reason: LinkEnd | None = None) -> None:
        """Record that the standing link of *upper* was removed, and why."""
        links = self._by_upper[upper]
        links[-1] = replace(links[-1], end=time, ended_by=reason)

    def of_upper(self, symbol: str) -> tuple[Link, ...]:
        """Return the links of an upper object, oldest first."""
        return tuple(self._by_upper.get(symbol, ()))

    def of_lower(self, symbol: str) -> tuple[Link, ...]:
        """Return the links of a lower object, oldest first."""
        uppers = dict.fromkeys(self._uppers_by_lower.get(symbol, ()))
        links = [link for u in uppers for link in self._by_upper[u] if link.lower == symbol]
        return tuple(sorted(links, key=lambda link: link.begin))


@dataclass(frozen=True, slots=True)
class ObjectLinkageStructure:
    """The objects linked to one symbol at one time, from the symbol down.

    Attributes:
        time: When these links stood.
        symbols: The symbol, the object it is linked to, and so on; the last one is a percept if
            the symbol is anchored.
        links: The links between them.
    """

    time: TimePoint
    symbols: tuple[str, ...]
    links: tuple[Link, ...]


class ObjectLinkageStructures:
    """What several link processes know together, from any symbol down to its percepts."""

    def __init__(self, histories: Iterable[LinkHistory]) -> None:
        self._histories = tuple(histories)

    @property
    def histories(self) -> tuple[LinkHistory, ...]:
        """The histories of the link processes, in the order in which they were given."""
        return self._histories

    def structure_of(self, symbol: str, time: TimePoint) -> ObjectLinkageStructure:
        """Return the structure of *symbol* at *time*; it has no links if there were none."""
        symbols, links = [symbol], list[Link]()
        while found := [link for link in self._links_of(symbols[-1]) if link.holds_at(time)]:
            links.append(found[-1])
            symbols.append(found[-1].lower)
        return ObjectLinkageStructure(time, tuple(symbols), tuple(links))

    def percepts_of(self, symbol: str, begin: TimePoint, end: TimePoint) -> tuple[Link, ...]:
        """Return the lowest links below *symbol* between two times, cut to these times.

        Each says which percept the symbol rested on, from when to when, in order of time.
        """
        links = [_cut(link, begin, end) for link in self._links_of(symbol)]
        below: list[Link] = []
        for link in links:
            if link is None:
                continue
            stop = end if link.end is None else link.end
            rests_on = self._links_of(link.lower)
            below += self.percepts_of(link.lower, link.begin, stop) if rests_on else [link]
        named = (replace(link, upper=symbol) for link in below)
        return tuple(sorted(named, key=lambda link: (link.begin, link.lower)))

    def _links_of(self, symbol: str) -> list[Link]:
        return [link for history in self._histories for link in history.of_upper(symbol)]


def _cut(link: Link, begin: TimePoint, end: TimePoint) -> Link | None:
    """Return the part of *link* from *begin* up to *end*, or None if it did not stand then."""
    first = max(link.begin, begin)
    last = end if link.end is None else min(link.end, end)
    return replace(link, begin=first, end=last) if first < last else None
