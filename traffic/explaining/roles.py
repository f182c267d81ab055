"""Which streams of a network matter to explanations, found by walking its description.

Nothing here knows labels or units by name: sorts of streams, kinds of processes, and who feeds
whom say what is an event, an attribute, an object or an image.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from dyknow.kpl.description import GeneratorDescription, NetworkDescription

__all__ = ["EVENTS", "RECOGNITIONS", "Roles"]

EVENTS = "events"
RECOGNITIONS = "recognitions"
_LINK = "link"
_SOURCE = "source"
_UNIT = "unit"


@dataclass(frozen=True)
class Roles:
    """The streams of a network by what they are to an explanation.

    Attributes:
        network: What the network is made of.
        image_sorts: The sorts of images.
    """

    network: NetworkDescription
    image_sorts: frozenset[str]

    @cached_property
    def generators(self) -> Mapping[str, GeneratorDescription]:
        """All stream generators by label."""
        return {each["label"]: each for each in self.network["generators"]}

    @cached_property
    def events(self) -> tuple[str, ...]:
        """The streams of events."""
        return self._of_sort(EVENTS)

    @cached_property
    def recognitions(self) -> tuple[str, ...]:
        """The streams of recognitions."""
        return self._of_sort(RECOGNITIONS)

    @cached_property
    def images(self) -> tuple[str, ...]:
        """The streams of images."""
        return tuple(
            e["label"] for e in self.network["generators"] if e["sort"] in self.image_sorts
        )

    @cached_property
    def links(self) -> tuple[str, ...]:
        """The streams of objects that link processes make, from the lowest up."""
        return tuple(e["label"] for e in self.network["generators"] if e["kind"] == _LINK)

    @cached_property
    def anchored(self) -> tuple[str, ...]:
        """The streams of the objects that events are about: the first links that one meets.

        From the streams of events and of recognitions one goes upstream, up to the first objects
        that a link process has made.
        """
        found: dict[str, None] = {}
        for label in (*self.events, *self.recognitions):
            found |= dict.fromkeys(self._first_links(label))
        return tuple(label for label in self.links if label in found)

    @cached_property
    def percepts(self) -> tuple[str, ...]:
        """The streams of the lowest objects: others are linked to them, and nothing is below."""
        below = dict.fromkeys(p for label in self.links for p in self.providers(label))
        return tuple(each for each in below if not set(self.upstream(each)) & set(self.links))

    @cached_property
    def attributes(self) -> tuple[str, ...]:
        """The streams of attributes: what units make events of."""
        made = (label for label in self.events if self.generators[label]["kind"] == _UNIT)
        below = dict.fromkeys(p for label in made for p in self.providers(label))
        return tuple(label for label in below if label not in {*self.events, *self.recognitions})

    @cached_property
    def raw(self) -> tuple[str, ...]:
        """What the streams of attributes are made of directly, such as values before a filter."""
        return self._below(self.attributes)

    @cached_property
    def measured(self) -> tuple[str, ...]:
        """What the raw streams are made of, if that is not objects: it may hold quantities."""
        return tuple(label for label in self._below(self.raw) if label not in self.links)

    @cached_property
    def filmed(self) -> tuple[str, ...]:
        """What images are made of, such as vehicles."""
        return tuple(dict.fromkeys(p for label in self.images for p in self.providers(label)))

    def providers(self, label: str) -> tuple[str, ...]:
        """Return the labels that feed *label* directly."""
        known = self.generators.get(label)
        return () if known is None else tuple(each["provider"] for each in known["inputs"])

    def upstream(self, label: str) -> Iterator[str]:
        """Yield *label* and all labels that feed it, the nearest first."""
        ahead = [label]
        seen = {label: None}
        while ahead:
            yield from ahead
            ahead = list(dict.fromkeys(p for each in ahead for p in self.providers(each)))
            ahead = [each for each in ahead if each not in seen]
            seen |= dict.fromkeys(ahead)

    def told_to(self, recogniser: str) -> frozenset[str]:
        """Return the streams of events that a stream of recognitions is made of.

        These are its inputs; if some of them are no events, all events upstream of it.
        """
        inputs = self.providers(recogniser)
        if inputs and set(inputs) <= set(self.events):
            return frozenset(inputs)
        return frozenset(self.upstream(recogniser)) & frozenset(self.events)

    def _first_links(self, label: str) -> Iterator[str]:
        """Yield the first labels of links on every way upstream from *label*."""
        ahead, seen = [label], {label}
        while ahead:
            one = ahead.pop()
            if one in self.links:
                yield one
                continue
            new = [each for each in self.providers(one) if each not in seen]
            seen.update(new)
            ahead += new

    def _below(self, labels: Iterable[str]) -> tuple[str, ...]:
        """Return what feeds some streams, without percepts, images, sources and themselves."""
        below = dict.fromkeys(p for label in labels for p in self.providers(label))
        known = {*labels, *self.percepts, *self.images}
        return tuple(
            each
            for each in below
            if each not in known and self.generators[each]["kind"] != _SOURCE
        )

    def _of_sort(self, sort: str) -> tuple[str, ...]:
        return tuple(each["label"] for each in self.network["generators"] if each["sort"] == sort)
