"""Streams of states, each made once for all who evaluate formulas over the same streams."""

from collections.abc import Collection
from dataclasses import dataclass, field

from dyknow.kpl.syntax import Constraint
from dyknow.monitoring.evaluation import Evaluation
from dyknow.runtime.subscriptions import StreamViolation

__all__ = ["SharedStates", "StateStream"]


@dataclass(eq=False)
class StateStream:
    """A stream of states, and what is evaluated in them.

    Attributes:
        label: The label of the stream generator.
        streams: The labels of the streams whose values make a state, in their order.
        constraints: The state policy.
        evaluations: Those that receive the states.
    """

    label: str
    streams: tuple[str, ...]
    constraints: tuple[Constraint, ...]
    evaluations: list[Evaluation] = field(default_factory=list)


class SharedStates:
    """The streams of states that there are.

    Two are the same if they are made of the same streams, in whatever order, under one policy.
    """

    def __init__(self) -> None:
        self._streams: list[StateStream] = []

    def find(
        self, streams: Collection[str], constraints: tuple[Constraint, ...]
    ) -> StateStream | None:
        """Return the stream of states of some streams under a policy, if there is one."""
        wanted = set(streams), constraints
        found = (s for s in self._streams if (set(s.streams), s.constraints) == wanted)
        return next(found, None)

    def of(self, evaluation: Evaluation) -> StateStream:
        """Return the stream of states that an evaluation receives."""
        return next(s for s in self._streams if evaluation in s.evaluations)

    def join(self, states: StateStream, evaluation: Evaluation) -> None:
        """Let an evaluation receive a stream of states, which may be new."""
        if states not in self._streams:
            self._streams.append(states)
        states.evaluations.append(evaluation)

    def leave(self, evaluation: Evaluation) -> None:
        """Let an evaluation receive states no more."""
        states = self.of(evaluation)
        states.evaluations.remove(evaluation)
        if not states.evaluations:
            self._streams.remove(states)

    def hear(self, told: StreamViolation) -> None:
        """Tell those who receive states what is wrong with these or their inputs."""
        for states in self._streams:
            if states.label == told.receiver:
                for evaluation in states.evaluations:
                    evaluation.unit.note(told.violation)
