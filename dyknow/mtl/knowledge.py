"""What is known about a part of a formula at past instants."""

from dataclasses import dataclass

from dyknow.mtl.instants import EMPTY, Instants, both, either
from dyknow.mtl.nodes import Literal

__all__ = ["NOTHING", "Knowledge"]


@dataclass(frozen=True, slots=True)
class Knowledge:
    """The past instants at which a node is known to be true, and known to be false."""

    true: Instants = EMPTY
    false: Instants = EMPTY

    def of(self, literal: Literal) -> "Knowledge":
        """Return the same for a literal of the node."""
        return Knowledge(self.false, self.true) if literal & 1 else self

    def joined(self, true: Instants, false: Instants) -> "Knowledge":
        """Return what is known here or there."""
        return Knowledge(either(self.true, true), either(self.false, false))

    def within(self, instants: Instants) -> "Knowledge":
        """Forget all other instants."""
        if not instants:
            return NOTHING
        return Knowledge(both(self.true, instants), both(self.false, instants))


NOTHING = Knowledge()
