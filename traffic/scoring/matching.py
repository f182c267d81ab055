"""Pairs recognitions with the true manoeuvres that explain them, each at most once."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from dyknow.time import Duration

__all__ = ["Episode", "EpisodeKey", "match"]

EpisodeKey = tuple[str, tuple[int, ...], tuple[str, ...]]
"""The kind of manoeuvre, the vehicles that do it, and where, by names."""


@dataclass(frozen=True, slots=True)
class Episode:
    """Something that happened to certain vehicles at a certain place for a while.

    Attributes:
        key: What happened, to which vehicles, where; only equal keys match.
        begin: First time-point, nanoseconds.
        end: Last time-point, nanoseconds.
    """

    key: EpisodeKey
    begin: int
    end: int


def match(
    claims: Sequence[Episode], truths: Sequence[Episode], tolerances: Mapping[str, Duration]
) -> dict[int, int]:
    """Pair claims with truths of equal key whose spans overlap, give or take a tolerance.

    Each kind of manoeuvre among the truths has one of the *tolerances*.

    As many pairs as possible are made: among the claims that overlap a truth, the one that
    ends first is taken, truths being served in order of their end.

    Returns:
        Position of the truth by position of the claim.
    """
    claims_by_key: defaultdict[EpisodeKey, list[int]] = defaultdict(list)
    for i in sorted(range(len(claims)), key=lambda i: claims[i].end):
        claims_by_key[claims[i].key].append(i)
    pairs: dict[int, int] = {}
    for j in sorted(range(len(truths)), key=lambda j: truths[j].end):
        tolerance = tolerances[truths[j].key[0]]
        free = (i for i in claims_by_key[truths[j].key] if i not in pairs)
        found = next((i for i in free if _overlap(claims[i], truths[j], tolerance)), None)
        if found is not None:
            pairs[found] = j
    return pairs


def _overlap(one: Episode, other: Episode, tolerance: Duration) -> bool:
    return one.begin <= other.end + tolerance and other.begin <= one.end + tolerance
