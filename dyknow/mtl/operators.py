"""Monitor formulas that are generated from the operators of a plan.

The formulas are those of Heintz (2009), sections 7.6 and 7.7. An operator says what must hold when
it is invoked, what must hold while it is executed, what it brings about, and how long it
takes; each of these is monitored if it is marked so. From a whole plan, links from the effect of
one action to the precondition of another follow, over which the effect must persist.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from dyknow.errors import ArityError
from dyknow.mtl import syntax
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.quantifiers import Stand, bind, bound_feature
from dyknow.mtl.symbols import extract_symbols
from dyknow.mtl.syntax import ALWAYS_HENCEFORTH, Feature, Formula, Interval, Name, Number
from dyknow.source_text import MADE_IN_PYTHON
from dyknow.time import Duration

__all__ = [
    "Action",
    "CausalLink",
    "Condition",
    "DurationConstraint",
    "Effect",
    "MonitorFormula",
    "Operator",
    "causal_links",
    "execution_flag",
    "monitor_formulas",
]

_EXECUTING = "EXEC"
_AT_ONCE = Duration(0)


@dataclass(frozen=True, slots=True)
class Condition:
    """A formula about an operator, in which its parameters stand for objects and numbers.

    Attributes:
        text: The formula; `EXEC` in it stands for the execution flag of the operator.
        monitored: Whether a monitor formula is generated from it.
        recovery: What to do when it is violated, by a name that the execution monitor knows.
    """

    text: str
    monitored: bool = True
    recovery: str | None = None


@dataclass(frozen=True, slots=True)
class Effect:
    """What an operator brings about.

    Attributes:
        text: The formula, as of a condition.
        lasting: Whether it must still hold at the end of the execution, not only at some time
            during it.
        monitored: Whether a monitor formula is generated from it.
        recovery: What to do when it is violated, by a name that the execution monitor knows.
    """

    text: str
    lasting: bool = True
    monitored: bool = True
    recovery: str | None = None


@dataclass(frozen=True, slots=True)
class DurationConstraint:
    """How long the execution takes, if it goes as intended.

    Attributes:
        most: The longest duration.
        least: The shortest duration.
        monitored: Whether a monitor formula is generated from it.
        recovery: What to do when it is violated, by a name that the execution monitor knows.
    """

    most: Duration
    least: Duration = _AT_ONCE
    monitored: bool = True
    recovery: str | None = None


@dataclass(frozen=True, slots=True)
class Operator:
    """A kind of action.

    Attributes:
        name: The name, as it stands in features: `attach_box`.
        parameters: The names of the parameters.
        preconditions: What must hold when the execution begins.
        prevail_conditions: What must hold throughout the execution.
        effects: What it brings about.
        duration: How long it takes, if that is limited.
        formulas: Further formulas that are monitored from the beginning of the execution on.
        flag_parameters: The parameters of the execution flag; all of them if none are given.
    """

    name: str
    parameters: tuple[str, ...] = ()
    preconditions: tuple[Condition, ...] = ()
    prevail_conditions: tuple[Condition, ...] = ()
    effects: tuple[Effect, ...] = ()
    duration: DurationConstraint | None = None
    formulas: tuple[Condition, ...] = ()
    flag_parameters: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Action:
    """An operator with its arguments: a step of a plan.

    Attributes:
        operator: The operator.
        arguments: Names of objects, and numbers, one for each parameter.
    """

    operator: Operator
    arguments: tuple[str | float, ...] = ()

    def __post_init__(self) -> None:
        expected, found = len(self.operator.parameters), len(self.arguments)
        if expected != found:
            raise ArityError(self.operator.name, expected, found, MADE_IN_PYTHON)

    @property
    def name(self) -> str:
        """How the action is written: `attach_box(heli1, bx7)`."""
        arguments = ", ".join(text_from_formula(_stand(value)) for value in self.arguments)
        return f"{self.operator.name}({arguments})" if arguments else self.operator.name


@dataclass(frozen=True, slots=True)
class MonitorFormula:
    """A formula to be monitored while a plan is executed.

    Attributes:
        name: The action and what the formula is about.
        text: The formula.
        recovery: What to do when it is violated, by a name that the execution monitor knows.
    """

    name: str
    text: str
    recovery: str | None = None


@dataclass(frozen=True, slots=True)
class CausalLink:
    """An effect of one action that is needed by another.

    Attributes:
        producer: The place in the plan of the action that has the effect.
        consumer: The place in the plan of the action that has it as a precondition.
        condition: What must persist between the two.
    """

    producer: int
    consumer: int
    condition: Formula

    def monitor_formula(
        self, plan: Sequence[Action], tolerance: Duration | None = None
    ) -> MonitorFormula:
        """Return the formula that the condition persists, to be monitored with the producer.

        Args:
            plan: The plan that the link is about.
            tolerance: How long actions between the two may destroy the condition at a time; None
                if they must not.
        """
        first, second = execution_flag(plan[self.producer]), execution_flag(plan[self.consumer])
        if tolerance is None:
            kept: Formula = _until(self.condition, second)
        else:
            within = Interval(Duration(0), tolerance)
            restored = syntax.Eventually(within, self.condition)
            waiting = syntax.Conjunction((syntax.Negation(second), restored))
            used = syntax.Conjunction((second, self.condition))
            kept = syntax.Conjunction((self.condition, _until(waiting, used)))
        condition = text_from_formula(self.condition)
        name = f"{plan[self.producer].name}: {condition} for {plan[self.consumer].name}"
        return MonitorFormula(name, text_from_formula(_until(first, kept)))


def execution_flag(action: Action) -> Feature:
    """Return the feature that is true exactly while *action* is being executed."""
    operator = action.operator
    shown = operator.parameters if operator.flag_parameters is None else operator.flag_parameters
    flag = Feature(f"executing_{operator.name}", tuple(Name(name) for name in shown))
    return bound_feature(flag, _binding(action))


def monitor_formulas(action: Action) -> list[MonitorFormula]:
    """Return the formulas to be monitored from the beginning of the execution of *action*.

    Raises:
        FormulaSyntaxError: A condition of the operator is not a formula.
    """
    return list(_monitor_formulas(action))


def causal_links(plan: Sequence[Action]) -> list[CausalLink]:
    """Return which effects in *plan* persist until they are used as preconditions.

    A precondition is linked to the last action before that has it as an effect, unless another
    effect in between is about the same features. Effects and preconditions that are not monitored
    give no links.
    """
    links: list[CausalLink] = []
    for consumer, action in enumerate(plan):
        for precondition in action.operator.preconditions:
            if precondition.monitored:
                for condition in _conjuncts(_bound(action, precondition.text)):
                    producer = _producer(plan[:consumer], condition)
                    if producer is not None:
                        links.append(CausalLink(producer, consumer, condition))
    return links


_Origin = Condition | Effect | DurationConstraint


def _monitor_formulas(action: Action) -> Iterator[MonitorFormula]:
    for number, (kind, origin, formula) in enumerate(_formulas(action), 1):
        if origin.monitored:
            name = f"{action.name}: {kind} {number}"
            yield MonitorFormula(name, text_from_formula(formula), origin.recovery)


def _formulas(action: Action) -> Iterator[tuple[str, _Origin, Formula]]:
    """Yield what each formula is about, where it comes from, and the formula."""
    operator, flag = action.operator, execution_flag(action)
    ended = syntax.Negation(flag)
    for precondition in operator.preconditions:
        yield "precondition", precondition, _bound(action, precondition.text)
    for prevailing in operator.prevail_conditions:
        during = syntax.Conjunction((flag, _bound(action, prevailing.text)))
        yield "prevail condition", prevailing, _until(during, ended)
    for effect in operator.effects:
        brought = _bound(action, effect.text)
        achieved = syntax.Conjunction((ended, brought)) if effect.lasting else brought
        yield "effect", effect, _until(flag, achieved)
    if operator.duration is not None:
        within = Interval(operator.duration.least, operator.duration.most)
        yield "duration", operator.duration, syntax.Until(within, flag, ended)
    for further in operator.formulas:
        yield "formula", further, _bound(action, further.text)


def _until(left: Formula, right: Formula) -> Formula:
    return syntax.Until(ALWAYS_HENCEFORTH, left, right)


def _bound(action: Action, text: str) -> Formula:
    """Return a formula of an operator for one action."""
    formula = parse_formula(text, action.operator.name)
    return bind(formula, {**_binding(action), _EXECUTING: execution_flag(action)})


def _binding(action: Action) -> dict[str, Stand]:
    pairs = zip(action.operator.parameters, action.arguments, strict=True)
    return {name: _stand(value) for name, value in pairs}


def _stand(value: str | float) -> Stand:
    if isinstance(value, str):
        return Name(value)
    number = Number(abs(float(value)))
    return syntax.Minus(number) if value < 0 else number


def _conjuncts(formula: Formula) -> tuple[Formula, ...]:
    return formula.bodies if isinstance(formula, syntax.Conjunction) else (formula,)


def _producer(before: Sequence[Action], condition: Formula) -> int | None:
    """Return the last action that brings *condition* about, if no later one touches it."""
    features = set(extract_symbols([condition]).features)
    for place in reversed(range(len(before))):
        action = before[place]
        effects = [(e, _bound(action, e.text)) for e in action.operator.effects]
        parts = [(e, part) for e, formula in effects for part in _conjuncts(formula)]
        touching = [(e, p) for e, p in parts if features & set(extract_symbols([p]).features)]
        if touching:
            right = all(part == condition and e.monitored for e, part in touching)
            return place if right else None
    return None
