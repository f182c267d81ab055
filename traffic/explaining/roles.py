"""Which streams of a network matter to explanations, found by walking its description.

Nothing here knows labels or units by name: sorts of streams, kinds of processes, and who feeds
whom say what is an event, an attribute, an object or an image.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from dyknow.kpl.description import GeneratorDescription, NetworkDescription

__all__ = ["EVENTS", "RECOGNITIONS", "Roles"]

EVENTS = "events"
RECOGNITIONS = "recognitions"
_LINK = "link"
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
        """The streams of the highest objects: linked, and not linked to anything further."""
        below = {provider for label in self.links for provider in self.providers(label)}
        return tuple(label for label in self.links if label not in below)

    @cached_property
    def percepts(self) -> tuple[str, ...]:
        """The streams of the lowest objects: what others are linked to, not linked themselves."""
        below = dict.fromkeys(p for label in self.links for p in self.providers(label))
        return tuple(label for label in below if label not in self.links)

    @cached_property
    def attributes(self) -> tuple[str, ...]:
        """The streams of attributes: what units make events of."""
        made = (label for label in self.events if self.generators[label]["kind"] == _UNIT)
        below = dict.fromkeys(p for label in made for p in self.providers(label))
        return tuple(label for label in below if label not in {*self.events, *self.recognitions})

    @cached_property
    def raw(self) -> tuple[str, ...]:
        """What the streams of attributes are made of directly, such as values before a filter."""
        below = dict.fromkeys(p for label in self.attributes for p in self.providers(label))
        known = {*self.attributes, *self.percepts, *self.images}
        return tuple(label for label in below if label not in known)

    @cached_property
    def filmed(self) -> tuple[str, ...]:
        """What images show first of all, such as vehicles: the first input of what makes them."""
        return tuple(dict.fromkeys(each[0] for each in map(self.providers, self.images) if each))

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

    def _of_sort(self, sort: str) -> tuple[str, ...]:
        return tuple(each["label"] for each in self.network["generators"] if each["sort"] == sort)
