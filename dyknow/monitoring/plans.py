"""The execution of a plan, monitored over the streams of a network.

The formulas are those that `dyknow.mtl.operators` generates from operators (Heintz 2009, sections
7.6 and 7.7). Execution flags come from no stream: who executes the plan says when actions begin
and end.
"""

from bisect import bisect_right
from collections.abc import Iterable, Mapping
from contextlib import suppress
from itertools import count

from dyknow.errors import LabelInUseError
from dyknow.monitoring.evaluation import Evaluation
from dyknow.monitoring.interpretation import Interpretation
from dyknow.monitoring.reasoner import StreamReasoner
from dyknow.monitoring.unit import Decision
from dyknow.mtl.execution import FormulaViolation, Recovery
from dyknow.mtl.operators import Action, MonitorFormula, execution_flag, monitor_formulas
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.symbols import extract_symbols
from dyknow.time import TimePoint

__all__ = ["PlanMonitor"]

_FLAG = "executing_"


class PlanMonitor:
    """Monitors the actions of a plan while they are executed.

    An execution flag is false until its first action has begun. That an action begins or ends at
    some instant is true of the states that are valid from then on, whenever these are made.
    """

    def __init__(
        self, reasoner: StreamReasoner, recoveries: Mapping[str, Recovery] | None = None
    ) -> None:
        """Evaluate formulas with *reasoner*; *recoveries* are called by name from operators."""
        self._reasoner = reasoner
        self._recoveries = dict(recoveries or {})
        self._executing: dict[str, str] = {}
        self._flags: dict[str, _Flag] = {}

    @property
    def executing(self) -> tuple[str, ...]:
        """The names of the actions that are being executed."""
        return tuple(self._executing)

    def begin(self, action: Action, links: Iterable[MonitorFormula] = ()) -> Evaluation | None:
        """Set the execution flag of an action, and evaluate its formulas from the next state on.

        A recovery is called once for each that is violated, when the work of that instant is
        done. When all are decided they are removed, unless others use their verdicts.

        Args:
            action: The action; it is not being executed already.
            links: Formulas for what it brings about for later actions.

        Returns:
            The evaluation of the formulas; None if there are none.

        Raises:
            NoFeaturesError: The formulas are about execution flags alone, so that no stream says
                when there are states; nothing has changed. So it is with the errors of
                `StreamReasoner.add`.
            ValueError: The action is being executed, or a recovery is not known.
        """
        if action.name in self._executing:
            raise ValueError(f"'{action.name}' is being executed already")
        formulas = {each.name: each for each in (*monitor_formulas(action), *links)}
        wanted = {each.recovery for each in formulas.values() if each.recovery is not None}
        if unknown := wanted - set(self._recoveries):
            raise ValueError(f"no recovery called {', '.join(map(repr, sorted(unknown)))}")
        evaluation = self._evaluate(action, formulas) if formulas else None
        flag = text_from_formula(execution_flag(action))
        self._executing[action.name] = flag
        self._flag(flag).change(self._reasoner.network.kernel.now, value=True)
        return evaluation

    def end(self, action: Action) -> None:
        """Clear the execution flag of an action; its formulas are evaluated until decided.

        Raises:
            ValueError: The action is not being executed.
        """
        if action.name not in self._executing:
            raise ValueError(f"'{action.name}' is not being executed")
        flag = self._executing.pop(action.name)
        is_left = flag in self._executing.values()
        self._flag(flag).change(self._reasoner.network.kernel.now, value=is_left)

    def _evaluate(self, action: Action, formulas: Mapping[str, MonitorFormula]) -> Evaluation:
        reasoner, recoveries = self._reasoner, self._recoveries
        parsed = {name: parse_formula(each.text, name) for name, each in formulas.items()}
        printed = map(text_from_formula, extract_symbols(parsed.values()).features)
        known = {each: self._flag(each).at for each in printed if each.startswith(_FLAG)}

        def recover(decision: Decision) -> None:
            recovery = formulas[decision.formula].recovery
            if recovery is not None:
                formula = parsed[decision.formula]
                told = FormulaViolation(decision.formula, formula, decision.decided_at)
                recoveries[recovery](told)

        names = (f"{action.operator.name}_{number}" for number in count(1))
        name = next(each for each in names if each not in reasoner.evaluations)
        meaning = Interpretation(known=known)
        evaluation = reasoner.add(name, parsed, meaning, on_violation=recover)
        kernel = reasoner.network.kernel
        evaluation.unit.on_over = lambda: kernel.change(lambda: self._remove(name))
        return evaluation

    def _remove(self, name: str) -> None:
        with suppress(LabelInUseError):  # somebody looks at the verdicts, and may remove them
            self._reasoner.remove(name)

    def _flag(self, name: str) -> "_Flag":
        return self._flags.setdefault(name, _Flag())


class _Flag:
    """Whether something is the case, at any valid time."""

    def __init__(self) -> None:
        self._times: list[TimePoint] = []
        self._values = [False]

    def change(self, time: TimePoint, *, value: bool) -> None:
        """Let *value* hold from *time* on, which is not earlier than the last change."""
        self._times.append(time)
        self._values.append(value)

    def at(self, time: TimePoint) -> bool:
        """Return what holds at a valid time; of two changes at one time, the last counts."""
        return self._values[bisect_right(self._times, time)]
