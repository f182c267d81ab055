"""Branches: the places on the road network where an object may be.

An object on a road has one branch. At the end of the road it splits into one branch for each
successor, as Heintz, Kvarnström and Doherty (2009, section V) let predicted objects do at
crossings; here observed objects do it too, so that the decision which way a vehicle goes is taken
by the measurements that follow, and not at the moment when it enters the crossing. Each branch
has filters of its own along and across its road, and a weight, the logarithm of its likelihood.

The branches of n objects are a structured array (n, limit), the likeliest first and empty places
(road -1) last; while work is done on them they are `Branches`, one row per branch.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from anchoring.motion import ACROSS_A_ROAD, ALONG_A_ROAD, AxisState, Floats
from networks.roads import RoadMap

__all__ = ["BRANCH", "BranchSettings", "Branches", "RoadFollower", "grown_unseen"]

_ALONG = len(ALONG_A_ROAD.kinds)
_ACROSS = len(ACROSS_A_ROAD.kinds)

BRANCH = np.dtype(
    [
        ("road", np.int32),
        ("weight", np.float64),
        ("along_mean", np.float64, (_ALONG, 2)),
        ("along_covariance", np.float64, (_ALONG, 3)),
        ("along_weight", np.float64, (_ALONG,)),
        ("across_mean", np.float64, (_ACROSS, 2)),
        ("across_covariance", np.float64, (_ACROSS, 3)),
        ("across_weight", np.float64, (_ACROSS,)),
    ]
)
"""One branch of one object: road, logarithm of its weight, and the state of its two filters."""

_MOST_ROADS_AT_ONCE = 16
"""How many road ends an object passes within one step before it waits for the next step."""

_PATIENCE = 1.0
"""Seconds without measurement after which a vehicle may have done anything."""

_REVERSING = 1.5
"""How fast, in m/s, vehicles usually go backwards at most."""

_GAP_DENSITY = 2.0
"""Spectral density of the acceleration, m²/s³, of a vehicle that nobody sees."""

_GAP_DRIFT = 0.25
"""How fast the variance of its place across the road grows, m²/s."""


@dataclass(frozen=True, slots=True)
class BranchSettings:
    """How branches are followed, made and dropped.

    Attributes:
        limit: The most branches an object has.
        map_deviation: How far a road's centre line may lie from where it is driven, in metres.
        hopeless: A branch that is by this much less likely, in nats, is dropped.
        match_distance: How far from a road an object may be to be put on it, in metres.
    """

    limit: int = 8
    map_deviation: float = 0.2
    hopeless: float = 10.0
    match_distance: float = 15.0


@dataclass(frozen=True, slots=True)
class Branches:
    """Branches of several objects, one row per branch.

    Attributes:
        owner: shape (k,), row of the object.
        state: shape (k,), of type `BRANCH`.
    """

    owner: npt.NDArray[np.intp]
    state: npt.NDArray[np.void]

    @classmethod
    def of(cls, table: npt.NDArray[np.void]) -> "Branches":
        """Return the branches in an array of shape (n, limit)."""
        alive = table["road"] >= 0
        return cls(np.nonzero(alive)[0], table[alive])

    @property
    def along(self) -> AxisState:
        """The filters along the roads."""
        s = self.state
        return AxisState(s["along_mean"], s["along_covariance"], s["along_weight"])

    @property
    def across(self) -> AxisState:
        """The filters across the roads."""
        s = self.state
        return AxisState(s["across_mean"], s["across_covariance"], s["across_weight"])

    def with_filters(self, along: AxisState, across: AxisState) -> "Branches":
        """Return the same branches with other filters."""
        state = self.state.copy()
        for name, axis in (("along", along), ("across", across)):
            state[f"{name}_mean"] = axis.mean
            state[f"{name}_covariance"] = axis.covariance
            state[f"{name}_weight"] = axis.weight
        return Branches(self.owner, state)

    def select(self, rows: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> "Branches":
        """Return some of the branches."""
        return Branches(self.owner[rows], self.state[rows])

    def joined(self, other: "Branches") -> "Branches":
        """Return these branches and those of *other*."""
        return Branches(
            np.concatenate((self.owner, other.owner)), np.concatenate((self.state, other.state))
        )


class RoadFollower:
    """Carries branches along the roads and corrects them by measured positions."""

    def __init__(self, roads: RoadMap, settings: BranchSettings) -> None:
        self._roads = roads
        self._settings = settings
        self._lengths: Floats = np.asarray(roads.road_length, dtype=np.float64)
        self._half_widths: Floats = np.asarray(roads.road_width, dtype=np.float64) / 2
        # Straight on is the likelier way: a bend costs one nat per radian.
        self._bends: Floats = np.abs(roads.graph.bends)

    def start(
        self,
        owner: npt.NDArray[np.intp],
        road: npt.NDArray[np.int32],
        mean: Floats,
        covariance: Floats,
    ) -> Branches:
        """Return branches on *road* for objects in state (x, y, vx, vy).

        Args:
            owner: shape (k,).
            road: shape (k,).
            mean: shape (k, 4).
            covariance: shape (k, 4, 4).
        """
        s, d = self._roads.project(mean[:, :2], road)
        turn = _turns(self._roads.heading_at(road, s))
        along_velocity = (turn[:, :, 0] * mean[:, 2:]).sum(axis=1)
        place = turn.transpose(0, 2, 1) @ covariance[:, :2, :2] @ turn
        speed = turn.transpose(0, 2, 1) @ covariance[:, 2:, 2:] @ turn
        nothing = np.zeros_like(s)
        state = np.zeros(len(s), dtype=BRANCH)
        state["road"] = road
        least = self._settings.map_deviation**2
        return Branches(owner, state).with_filters(
            ALONG_A_ROAD.start(
                np.stack((s, along_velocity), axis=1),
                np.stack((place[:, 0, 0] + least, nothing, speed[:, 0, 0] + least), axis=1),
            ),
            ACROSS_A_ROAD.start(
                np.stack((d, nothing), axis=1),
                np.stack((place[:, 1, 1] + least, nothing, nothing + least), axis=1),
            ),
        )

    def advance(self, branches: Branches, elapsed: Floats) -> Branches:
        """Split branches that have passed the end of their road, *elapsed* seconds later.

        The filters stay at the time of their last measurement; only the road they refer to
        changes, and with it where its s and d begin.

        Args:
            branches: k branches.
            elapsed: shape (k,), seconds since the last measurement of each.
        """
        done: list[Branches] = []
        for _ in range(_MOST_ROADS_AT_ONCE):
            s, _ = self.position(branches, elapsed)
            over = s > self._lengths[branches.state["road"]]
            if not over.any():
                break
            done.append(branches.select(~over))
            branches, elapsed = self._split(branches.select(over), elapsed[over])
            ended = elapsed < 0
            done.append(branches.select(ended))
            branches, elapsed = branches.select(~ended), elapsed[~ended]
        for part in done:
            branches = branches.joined(part)
        return branches

    def position(self, branches: Branches, elapsed: Floats) -> tuple[Floats, Floats]:
        """Return s and d of each branch *elapsed* seconds later, at retained speed."""
        along, across = branches.along.expected(), branches.across.expected()
        return along[:, 0] + np.maximum(along[:, 1], 0.0) * elapsed, across[:, 0]

    def correct(
        self, branches: Branches, elapsed: Floats, position: Floats, noise: Floats
    ) -> Branches:
        """Correct branches by the measured positions of their owners.

        Args:
            branches: k branches.
            elapsed: shape (k,), seconds since the last measurement of each.
            position: shape (k, 2), measured.
            noise: shape (k, 2, 2), its covariance.
        """
        road = branches.state["road"]
        s, d = self._roads.project(position, road)
        turn = _turns(self._roads.heading_at(road, s))
        variance = turn.transpose(0, 2, 1) @ noise @ turn
        variance += self._settings.map_deviation**2 * np.eye(2)
        along, across = self._carried(branches, elapsed)
        along, along_fit = ALONG_A_ROAD.update(along, s, variance[:, 0, 0])
        across, across_fit = ACROSS_A_ROAD.update(across, d, variance[:, 1, 1])
        corrected = branches.with_filters(along, across)
        corrected.state["weight"] += along_fit + across_fit
        return corrected

    def tabulate(self, branches: Branches, n: int) -> npt.NDArray[np.void]:
        """Return branches as an array (n, limit), each object's likeliest first.

        Of branches of one object on one road only the likeliest is kept, and none that is
        hopeless beside the object's best.
        """
        settings = self._settings
        table = np.zeros((n, settings.limit), dtype=BRANCH)
        table["road"] = -1
        if len(branches.owner) == n:
            table[branches.owner, 0] = branches.state
            table["weight"] = 0.0
            return table
        score = branches.state["weight"] - self._strangeness(branches)
        order = np.lexsort((-score, branches.state["road"], branches.owner))
        owner, road = branches.owner[order], branches.state["road"][order]
        first = np.ones(len(order), dtype=np.bool_)
        first[1:] = (owner[1:] != owner[:-1]) | (road[1:] != road[:-1])
        order = order[first]
        order = order[np.lexsort((-score[order], branches.owner[order]))]
        owner = branches.owner[order]
        begins = np.searchsorted(owner, np.arange(n))[owner]
        rank = np.arange(len(order)) - begins
        hopeful = score[order] >= score[order[begins]] - settings.hopeless
        kept = (rank < settings.limit) & hopeful
        table[owner[kept], rank[kept]] = branches.state[order[kept]]
        table["weight"] -= table["weight"][:, :1]
        return table

    def _strangeness(self, branches: Branches) -> Floats:
        """Return how unusual it is, in nats, to be so far from the middle, or to go backwards."""
        across = branches.across.expected()
        usual = self._half_widths[branches.state["road"]] + 1.5
        backwards = np.minimum(branches.along.expected()[:, 1], 0.0)
        strangeness: Floats = 0.5 * ((across[:, 0] / usual) ** 2 + (backwards / _REVERSING) ** 2)
        return strangeness

    def _split(self, branches: Branches, elapsed: Floats) -> tuple[Branches, Floats]:
        """Return a branch for each successor of each road; a road's end keeps its branch.

        Branches that cannot go on are marked by an elapsed time of -1.
        """
        road = branches.state["road"]
        successors = [self._roads.successors(int(r)) for r in road]
        counts = np.array([max(len(s), 1) for s in successors])
        parent = np.repeat(np.arange(len(road)), counts)
        child = np.concatenate(
            [s if len(s) else [r] for s, r in zip(successors, road, strict=True)]
        )
        child = child.astype(np.int32)
        split = branches.select(parent)
        ended = child == split.state["road"]
        _, d = self.position(split, elapsed[parent])
        length = self._lengths[split.state["road"]]
        end = self._roads.point_at(split.state["road"], length, d)
        new_s, new_d = self._roads.project(end, child)
        go_on = ~ended
        split.state["along_mean"][go_on, :, 0] += (new_s - length)[go_on, None]
        split.state["across_mean"][go_on, :, 0] += (new_d - d)[go_on, None]
        split.state["weight"][go_on] -= self._bends[child][go_on]
        split.state["road"] = child
        return split, np.where(ended, -1.0, elapsed[parent])

    def _carried(self, branches: Branches, elapsed: Floats) -> tuple[AxisState, AxisState]:
        """Return the filters at the time of a measurement; after a long gap they begin anew."""
        along = ALONG_A_ROAD.predict(branches.along, elapsed)
        across = ACROSS_A_ROAD.predict(branches.across, elapsed)
        late = np.flatnonzero(elapsed > _PATIENCE)
        if not len(late):
            return along, across
        gap = branches.select(late)
        s, d = self.position(gap, elapsed[late])
        mean, covariance = gap.along.estimate()
        t = elapsed[late]
        _, sideways = gap.across.estimate()
        grown, sideways = grown_unseen(covariance, sideways, t)
        again = ALONG_A_ROAD.start(np.stack((s, np.maximum(mean[:, 1], 0)), axis=1), grown)
        beside = ACROSS_A_ROAD.start(np.stack((d, np.zeros_like(d)), axis=1), sideways)
        return _replaced(along, late, again), _replaced(across, late, beside)


def grown_unseen(along: Floats, across: Floats, elapsed: Floats) -> tuple[Floats, Floats]:
    """Return covariances along and across roads after *elapsed* seconds without measurements.

    Args:
        along: shape (n, 3), of position and velocity.
        across: shape (n, 3).
        elapsed: shape (n,), seconds.
    """
    pp, pv, vv = along.T
    t = elapsed
    grown = (
        pp + 2 * pv * t + vv * t**2 + _GAP_DENSITY * t**3 / 3,
        pv + vv * t + _GAP_DENSITY * t**2 / 2,
        vv + _GAP_DENSITY * t,
    )
    sideways = (across[:, 0] + _GAP_DRIFT * t, np.zeros_like(t), np.full_like(t, 0.1))
    return np.stack(grown, axis=1), np.stack(sideways, axis=1)


def _turns(heading: Floats) -> Floats:
    """Return matrices, shape (k, 2, 2), whose columns point along and to the left of a road."""
    c, s = np.cos(heading), np.sin(heading)
    return np.stack((np.stack((c, -s), axis=-1), np.stack((s, c), axis=-1)), axis=-2)


def _replaced(state: AxisState, rows: npt.NDArray[np.intp], other: AxisState) -> AxisState:
    """Return *state* with the states *other* at *rows*."""
    arrays = [state.mean.copy(), state.covariance.copy(), state.weight.copy()]
    for array, new in zip(arrays, (other.mean, other.covariance, other.weight), strict=True):
        array[rows] = new
    return replace(state, mean=arrays[0], covariance=arrays[1], weight=arrays[2])
