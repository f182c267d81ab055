"""What a recognition says, in the words of the truth."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from chronicles.events import Recognition

__all__ = ["Claim", "claim_of", "kinds_claimed"]


@dataclass(frozen=True, slots=True)
class Claim:
    """What recognitions of a chronicle say.

    Attributes:
        kind: The kind of manoeuvre, as the truth calls it.
        place: The arguments that say where, if the truth is to agree about that.
        is_mutual: Whether the vehicles do it to each other; then their order says nothing, and
            the truth has them in order of number.
    """

    kind: str
    place: tuple[str, ...] = ()
    is_mutual: bool = False

    def vehicles_of(self, found: Iterable[int]) -> tuple[int, ...]:
        """Return the vehicles that a recognition is about as the truth has them."""
        return tuple(sorted(found)) if self.is_mutual else tuple(found)

    def place_of(self, recognition: Recognition) -> tuple[str, ...]:
        """Return where a recognition says that it happened."""
        return tuple(recognition.arguments[name] for name in self.place)


def claim_of(chronicle: str) -> Claim:
    """Return what recognitions of *chronicle* say: that which it is called, anywhere.

    The vehicles are the cars among its arguments, in their order.
    """
    return _EXCEPTIONS.get(chronicle) or Claim(chronicle)


def kinds_claimed(chronicles: Iterable[str]) -> tuple[str, ...]:
    """Return the kinds of manoeuvres that recognitions of *chronicles* claim."""
    return tuple(dict.fromkeys(claim_of(name).kind for name in chronicles))


def _turns() -> dict[str, Claim]:
    """Return what turns claim: the links and the crossing too, observed or predicted."""
    return {
        f"turn_{direction}{form}": Claim(f"turn_{direction}", ("l1", "x", "l2"))
        for direction in ("left", "right", "straight", "uturn")
        for form in ("", "_predicted")
    }


_EXCEPTIONS: Mapping[str, Claim] = {
    **_turns(),
    "convoy_caught_up": Claim("convoy"),
    "near_collision": Claim("near_collision", is_mutual=True),
    "overtake_predicted": Claim("overtake"),
    "parking_beside_building": Claim("parking_beside_building", ("building",)),
    "stop_in_crossing": Claim("stop_in_crossing", ("x",)),
}
