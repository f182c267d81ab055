"""A formula, or a group of formulas, that is being evaluated over streams."""

from collections.abc import Mapping, Sequence

from dyknow.monitoring.interpretation import Origin
from dyknow.monitoring.unit import Decision, FormulaUnit
from dyknow.mtl.syntax import Formula, Verdict
from dyknow.streams.policy import Violation
from dyknow.time import TimePoint

__all__ = ["Evaluation"]


class Evaluation:
    """What is known about formulas that a network evaluates, also when it does so no more.

    Attributes:
        name: What was given to the reasoner as the name.
        label: The label of the stream generator of the verdicts.
        states: The label of the stream generator of the states.
        origins: For each feature, with its objects, the stream that its values come from.
        unit: The process that makes the verdicts.
    """

    def __init__(
        self, name: str, label: str, states: str, origins: Sequence[Origin], unit: FormulaUnit
    ) -> None:
        self.name = name
        self.label = label
        self.states = states
        self.origins = tuple(origins)
        self.unit = unit

    @property
    def verdicts(self) -> Mapping[str, Verdict]:
        """The present verdict on each formula, by name; of a single one this is its own."""
        return self.unit.group.verdicts

    @property
    def verdict(self) -> Verdict:
        """The present verdict on all formulas together: false as soon as one of them is."""
        return min(self.verdicts.values())

    @property
    def decisions(self) -> Sequence[Decision]:
        """The verdicts in the order in which they came."""
        return tuple(self.unit.decisions)

    @property
    def decided_at(self) -> TimePoint | None:
        """The valid time of the state that brought about the verdict, if there is one."""
        if self.verdict is Verdict.UNDECIDED:
            return None
        deciding = [each for each in self.decisions if each.verdict is self.verdict]
        return (deciding[0] if self.verdict is Verdict.FALSE else deciding[-1]).decided_at

    @property
    def gaps(self) -> int:
        """How often states were missing, or were not as they should be."""
        return self.unit.gaps

    @property
    def ended_by(self) -> Violation | None:
        """What ended the evaluation before everything was decided, if anything did."""
        return self.unit.ended_by

    def residual(self, formula: str | None = None) -> Formula:
        """Return what must hold from now on for a formula, the only one by default, to be true.

        Raises:
            ValueError: There is no such formula, or more than one to choose from.
        """
        if formula is None and len(self.verdicts) > 1:
            names = ", ".join(f"'{each}'" for each in self.verdicts)
            raise ValueError(f"expected the name of one of the formulas {names}")
        return self.unit.group.residual(formula or self.name)
