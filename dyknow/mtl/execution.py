"""Monitoring the execution of a plan: execution flags, formulas of actions, and recovery.

This is the execution monitor of Heintz (2009), sections 7.5.3 and 7.6. Global formulas are
monitored all the time, those of an action from the state after its execution has begun; an
execution flag tells formulas whether an action is being executed.
"""

from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from typing import Any

from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.operators import Action, MonitorFormula, execution_flag, monitor_formulas
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Formula, Verdict
from dyknow.time import TimePoint

__all__ = ["ExecutionMonitor", "FormulaViolation", "Recovery"]

_FLAG = "executing_"


@dataclass(frozen=True, slots=True)
class FormulaViolation:
    """A formula that has become false.

    Attributes:
        name: The name of the formula.
        formula: The formula.
        time: The time of the state that decided it.
    """

    name: str
    formula: Formula
    time: TimePoint


Recovery = Callable[[FormulaViolation], None]
"""What is done when a formula is violated."""


class ExecutionMonitor:
    """Formulas that are monitored while actions are executed.

    A recovery is called exactly once for a formula, after the step that decided it; it may
    begin and end actions and add formulas. The features of execution flags are not looked up in
    states but known from `begin` and `end`.

    Attributes:
        group: The formulas.
    """

    def __init__(
        self, group: FormulaGroup | None = None, recoveries: Mapping[str, Recovery] | None = None
    ) -> None:
        """Begin without actions.

        Args:
            group: A formula group to work with; its formulas are monitored too.
            recoveries: The recoveries that operators refer to, by name.
        """
        self.group = FormulaGroup() if group is None else group
        self._recoveries = dict(recoveries or {})
        self._recovery_by_formula: dict[str, Recovery] = {}
        self._executing: dict[str, str] = {}
        self._flags: dict[str, bool] = {}

    @property
    def executing(self) -> tuple[str, ...]:
        """The names of the actions that are being executed."""
        return tuple(self._executing)

    def add(self, name: str, formula: Formula | str, recovery: Recovery | None = None) -> None:
        """Monitor a global formula from the next state on; see `FormulaGroup.add`."""
        self.group.add(name, formula)
        if recovery is not None:
            self._recovery_by_formula[name] = recovery
        for feature in self.group.symbols().features:
            if feature.name.startswith(_FLAG):
                self._flags.setdefault(text_from_formula(feature), False)

    def remove(self, name: str) -> Verdict:
        """Stop monitoring a formula, without its recovery, and return its last verdict."""
        self._recovery_by_formula.pop(name, None)
        return self.group.remove(name)

    def begin(self, action: Action, links: Iterable[MonitorFormula] = ()) -> list[str]:
        """Set the execution flag of an action and monitor its formulas from the next state on.

        Args:
            action: The action; it is not being executed already.
            links: Formulas for what it brings about for later actions.

        Returns:
            The names under which the formulas are monitored. Where a formula of that name is
            being monitored already, ` #2` and so on are appended.

        Raises:
            ValueError: The action is being executed, or a recovery is not known.
        """
        if action.name in self._executing:
            raise ValueError(f"{action.name} is being executed already")
        formulas = [*monitor_formulas(action), *links]
        unknown = {f.recovery for f in formulas if f.recovery is not None} - set(self._recoveries)
        if unknown:
            raise ValueError(f"no recovery called {', '.join(map(repr, sorted(unknown)))}")
        flag = text_from_formula(execution_flag(action))
        self._executing[action.name] = flag
        self._flags[flag] = True
        names = []
        for formula in formulas:
            names.append(self._free_name(formula.name))
            recovery = None if formula.recovery is None else self._recoveries[formula.recovery]
            self.add(names[-1], formula.text, recovery)
        return names

    def end(self, action: Action) -> None:
        """Clear the execution flag of an action; its formulas are monitored until decided.

        Raises:
            ValueError: The action is not being executed.
        """
        if action.name not in self._executing:
            raise ValueError(f"{action.name} is not being executed")
        flag = self._executing.pop(action.name)
        self._flags[flag] = flag in self._executing.values()

    def step(self, now: TimePoint, state: Mapping[str, Any]) -> dict[str, Verdict]:
        """Take in a state, call the recoveries of what it violates, and return the verdicts.

        Decided formulas are removed. If a recovery fails, the others are called all the same.

        Raises:
            FeatureError: As by `FormulaGroup.step`; nothing has changed.
            StateOrderError: As by `FormulaGroup.step`; nothing has changed.
        """
        decided = self.group.step(now, {**state, **self._flags})
        violations = [
            FormulaViolation(name, self.group.formula(name), now)
            for name, verdict in decided.items()
            if verdict is Verdict.FALSE
        ]
        recoveries = {name: self._recovery_by_formula.pop(name, None) for name in decided}
        for name in decided:
            self.group.remove(name)
        with ExitStack() as calls:
            for violation in reversed(violations):
                recovery = recoveries[violation.name]
                if recovery is not None:
                    calls.callback(partial(recovery, violation))
        return decided

    def _free_name(self, name: str) -> str:
        free, number = name, 1
        while free in self.group:
            number += 1
            free = f"{name} #{number}"
        return free
