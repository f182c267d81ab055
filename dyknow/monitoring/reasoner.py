"""Formulas over the streams of a network that may be running.

A `StreamReasoner` does what the stream reasoning coordinator of Heintz, 'Semantically grounded
stream reasoning integrated with ROS', does in sections VI.7 and VII: it extracts the features of
a formula, finds their streams, has them made into states, evaluates the formula in each state,
and takes away what has been made when the formula is removed.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from itertools import count

from dyknow.errors import PrototypeAlreadyExistsError
from dyknow.kpl.build import specification
from dyknow.kpl.implementations import Implementations
from dyknow.kpl.names import Declarations
from dyknow.kpl.network import Network
from dyknow.monitoring.declaring import (
    UNIT,
    VERDICTS,
    beginning_of_states,
    constraints_of_states,
    declaration_of_states,
    declaration_of_unit,
    declarations_of_verdicts,
    is_name,
)
from dyknow.monitoring.errors import (
    EvaluationAlreadyExistsError,
    EvaluationEndedError,
    NoFeaturesError,
    NoSuchEvaluationError,
)
from dyknow.monitoring.evaluation import Evaluation
from dyknow.monitoring.grounding import constants_in, grounded
from dyknow.monitoring.interpretation import Interpretation, Origin, origins_of
from dyknow.monitoring.reading import StateReader
from dyknow.monitoring.sharing import SharedStates, StateStream
from dyknow.monitoring.unit import Decision, FormulaUnit, OnGap
from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.symbols import extract_symbols
from dyknow.mtl.syntax import Formula, TimeModel, Verdict
from dyknow.source_text import nearest_name
from dyknow.time import TimePoint

__all__ = ["EvaluationSettings", "Formulas", "StreamReasoner"]

Formulas = str | Formula | Mapping[str, str | Formula]
"""A formula or its text, or several by name."""

OnViolation = Callable[[Decision], object]
"""Is called when a formula has become false."""


@dataclass(frozen=True, slots=True)
class EvaluationSettings:
    """How formulas are evaluated.

    Attributes:
        policy: How states are made of the streams: what KPL writes after `sync(...) with`.
        time_model: At which time-points there is a state.
        on_gap: What becomes of the evaluation when a state is missing, or not as it should be.
    """

    policy: str = "any update, use most recent"
    time_model: TimeModel = TimeModel.HOLD
    on_gap: OnGap = OnGap.END


class StreamReasoner:
    """Evaluates formulas over the streams of a network, which may be running.

    Each evaluation is a process of the network, whose samples are the verdicts. Evaluations over
    the same streams under the same state policy share one stream of states.

    Attributes:
        network: The network.
        interpretation: What symbols stand for in all formulas.
        settings: How formulas are evaluated, where nothing else is said.
    """

    def __init__(
        self,
        network: Network,
        interpretation: Interpretation | None = None,
        settings: EvaluationSettings | None = None,
    ) -> None:
        """Evaluate formulas over the streams of *network*; one reasoner for each network.

        Raises:
            PrototypeAlreadyExistsError: The network has the unit of a reasoner already.
        """
        if UNIT in network.declarations.units:
            raise PrototypeAlreadyExistsError(UNIT)
        self.network = network
        self.interpretation = interpretation or Interpretation()
        self.settings = settings or EvaluationSettings()
        self._evaluations: dict[str, Evaluation] = {}
        self._states = SharedStates()
        self._unit_by_name: dict[str, FormulaUnit] = {}
        network.provide(Implementations(units={UNIT: self._unit}))
        network.kernel.subscribe_violations(self._states.hear)

    @property
    def evaluations(self) -> Mapping[str, Evaluation]:
        """What is being evaluated, by name."""
        return dict(self._evaluations)

    def add(
        self,
        name: str,
        formulas: Formulas,
        interpretation: Interpretation | None = None,
        *,
        settings: EvaluationSettings | None = None,
        on_violation: OnViolation | None = None,
    ) -> Evaluation:
        """Evaluate a formula, or a group of formulas, from the next state on.

        The verdicts are the samples of the stream generator `verdicts[NAME]`, and an output of
        this name. A formula that has been decided stays until it is removed.

        Args:
            name: What the evaluation is called, and the formula if there is one alone.
            formulas: The formula, or several by name, which share their states.
            interpretation: What symbols stand for, beside what they stand for in all formulas.
            settings: How they are evaluated, if not as all others.
            on_violation: Called once for each formula that becomes false, when the work of
                that instant is done; it may change the network, add formulas and remove them.

        Raises:
            EvaluationAlreadyExistsError: Something is being evaluated under this name.
            FormulaSyntaxError: A text is no formula.
            NoFeaturesError: There is no feature in the formulas.
            SpecificationError: The policy is at fault, or a domain is not given.
            SpecificationErrors: There is no stream for some features, or another fault.
            ValueError: The name cannot stand in a label.
        """
        self._check_name(name)
        settings = settings or self.settings
        meaning = self.interpretation.joined(interpretation or Interpretation())
        constraints = constraints_of_states(settings.policy)
        written = _by_name(name, formulas)
        ground = {each: grounded(formula, meaning) for each, formula in written.items()}
        declared = self.network.declarations
        origins = _origins(name, ground.values(), meaning, declared)
        streams = tuple(dict.fromkeys(origin.stream for origin in origins))
        states = self._states.find(streams, constraints)
        states = states or StateStream(_new_label(declared), streams, constraints)
        constants = constants_in(ground.values(), meaning)
        reader = StateReader(origins, states.streams, constants, meaning.known)
        unit = FormulaUnit(_group(ground, settings.time_model), reader, settings.on_gap)
        unit.on_decided = self._teller(on_violation)
        evaluation = Evaluation(name, f"{VERDICTS}[{name}]", states.label, origins, unit)
        self._declare(evaluation, states, written)
        self._states.join(states, evaluation)
        self._evaluations[name] = evaluation
        return evaluation

    def remove(self, name: str) -> Evaluation:
        """Evaluate a formula or a group no more, and take away what was made for it alone.

        Raises:
            LabelInUseError: Others use the verdicts, or states that no evaluation needs any more.
            NoSuchEvaluationError: Nothing is being evaluated under this name.
        """
        if name not in self._evaluations:
            raise NoSuchEvaluationError(name, nearest_name(name, self._evaluations))
        evaluation = self._evaluations[name]
        removed = [f"stream {evaluation.label}", f"strmgen {evaluation.label}"]
        if len(self._states.of(evaluation).evaluations) == 1:
            removed.append(f"strmgen {evaluation.states}")
        if len(self._evaluations) == 1:
            removed.append(f"compunit {UNIT}")
        self.network.remove(removed)
        self._states.leave(evaluation)
        return self._evaluations.pop(name)

    def evaluate(
        self,
        formula: str | Formula,
        until: TimePoint | None = None,
        interpretation: Interpretation | None = None,
        *,
        settings: EvaluationSettings | None = None,
    ) -> Evaluation:
        """Run the network until a formula has been decided; return the verdict and when it came.

        The run ends with the instant at which the formula is decided, at the latest at *until*,
        or with the sources. The formula is removed then. The network must not be running already.

        Raises:
            EvaluationEndedError: States were missing, and the settings say that this is the end.
        """
        names = (f"formula_{number}" for number in count(1))
        name = next(each for each in names if each not in self._evaluations)
        evaluation = self.add(name, formula, interpretation, settings=settings)
        evaluation.unit.on_over = self.network.kernel.stop
        try:
            self.network.kernel.run(until)
        finally:
            self.remove(name)
        gap = evaluation.ended_by or evaluation.unit.pending
        if gap is not None and evaluation.verdict is Verdict.UNDECIDED:
            text = formula if isinstance(formula, str) else text_from_formula(formula)
            raise EvaluationEndedError(text, gap)
        return evaluation

    def _check_name(self, name: str) -> None:
        if name in self._evaluations:
            raise EvaluationAlreadyExistsError(name)
        if not is_name(name) or name in self.network.declarations.parameters:
            raise ValueError(f"expected a name that can stand in a label, found '{name}'")

    def _declare(
        self, evaluation: Evaluation, states: StateStream, formulas: Mapping[str, Formula]
    ) -> None:
        """Declare what a new evaluation needs, and have it built."""
        texts = {each: text_from_formula(formula) for each, formula in formulas.items()}
        declarations = [*declarations_of_verdicts(evaluation.name, states.label, texts)]
        if not states.evaluations:
            begin = beginning_of_states(states.streams, states.constraints, self.network.kernel)
            made = declaration_of_states(states.label, states.streams, states.constraints, begin)
            declarations.insert(0, made)
        if not self._evaluations:
            declarations.insert(0, declaration_of_unit())
        self._unit_by_name[evaluation.name] = evaluation.unit
        try:
            self.network.add(specification(*declarations))
        finally:
            del self._unit_by_name[evaluation.name]

    def _unit(self, name: str, formulas: tuple[str, ...]) -> FormulaUnit:  # noqa: ARG002, shown
        """Return the unit of an evaluation that is being added."""
        return self._unit_by_name[name]

    def _teller(self, on_violation: OnViolation | None) -> OnViolation:
        """Return what calls *on_violation*, between two instants, for formulas that are false."""

        def tell(decision: Decision) -> None:
            if on_violation is not None and decision.verdict is Verdict.FALSE:
                self.network.kernel.change(lambda: on_violation(decision))

        return tell


def _by_name(name: str, formulas: Formulas) -> dict[str, Formula]:
    """Return formulas by their names, parsed."""
    given = formulas if isinstance(formulas, Mapping) else {name: formulas}
    if not given:
        raise ValueError(f"expected at least one formula for '{name}'")
    return {
        each: parse_formula(formula, each) if isinstance(formula, str) else formula
        for each, formula in given.items()
    }


def _origins(
    name: str, formulas: Collection[Formula], meaning: Interpretation, declared: Declarations
) -> tuple[Origin, ...]:
    """Return where the features of formulas come from."""
    features = [each for each in extract_symbols(formulas).features if meaning.needs_stream(each)]
    if not features:
        raise NoFeaturesError(name, [text_from_formula(each) for each in formulas])
    return origins_of(features, meaning, declared)


def _new_label(declared: Declarations) -> str:
    """Return a label for a stream of states that nothing else has."""
    labels = (f"states_{number}" for number in count(1))
    return next(each for each in labels if each not in declared.arities)


def _group(formulas: Mapping[str, Formula], time_model: TimeModel) -> FormulaGroup:
    group = FormulaGroup(time_model=time_model)
    for name, formula in formulas.items():
        group.add(name, formula)
    return group
