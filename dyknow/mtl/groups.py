"""Formula groups: named formulas over one domain and one sequence of states.

Formula groups are those of the stream reasoning engine of Heintz, 'Semantically grounded stream
reasoning integrated with ROS', section VI.6. An atom is evaluated once for all formulas of the
group, and a formula is progressed until it is decided. Formulas come and go while states arrive.
"""

from collections.abc import Iterable, Mapping
from typing import Any

from dyknow.mtl.check import Vocabulary, check
from dyknow.mtl.columns import AtomColumns
from dyknow.mtl.monitors import Monitor, check_order
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.progression import DEFAULT_LIMIT, ProgressionTable
from dyknow.mtl.quantifiers import Domains, expand
from dyknow.mtl.symbols import Symbols, extract_symbols
from dyknow.mtl.syntax import Atom, Formula, TimeModel, Verdict
from dyknow.source_text import did_you_mean, nearest_name
from dyknow.time import TimePoint

__all__ = ["FormulaGroup"]


class FormulaGroup:
    """Named formulas that are monitored over the same states.

    A formula is about the states from the first `step` after it was added. Once it is decided
    it keeps its verdict and asks for no features any more; it stays until it is removed.

    Attributes:
        domains: The objects of each domain, fixed for all formulas of the group.
        time_model: The time model of all formulas of the group.
    """

    def __init__(
        self,
        domains: Domains | None = None,
        vocabulary: Vocabulary | None = None,
        *,
        time_model: TimeModel | str = TimeModel.HOLD,
        limit: int = DEFAULT_LIMIT,
    ) -> None:
        """Make a group without formulas.

        Args:
            domains: The objects of each domain.
            vocabulary: The names that formulas may use; without one all names are free.
            time_model: At which time-points there is a state.
            limit: The bound on the memory for each different formula; see `ProgressionTable`.
        """
        self.domains: Domains = dict(domains or {})
        self.time_model = TimeModel(time_model)
        self._vocabulary = vocabulary
        self._limit = limit
        self._written: dict[str, Formula] = {}
        self._monitors: dict[str, Monitor] = {}
        self._undecided: dict[str, Monitor] = {}
        self._sources: dict[str, tuple[int, ...]] = {}
        self._columns = AtomColumns(())
        self._time: TimePoint | None = None

    def __len__(self) -> int:
        """Return the number of formulas."""
        return len(self._monitors)

    def __contains__(self, name: object) -> bool:
        return name in self._monitors

    def add(self, name: str, formula: Formula | str) -> None:
        """Monitor a formula from the next state on.

        Args:
            name: How results refer to the formula; no other formula of the group has it.
            formula: The formula or its text, with quantifiers over the group's domains.

        Raises:
            FormulaSyntaxError: The text is not a formula.
            SpecificationErrors: Every other fault of the formula, at once.
            UnknownNameError: A quantifier ranges over a domain that the group does not have.
        """
        if name in self._monitors:
            raise ValueError(f"there is a formula called '{name}' already")
        if isinstance(formula, str):
            formula = parse_formula(formula, name)
        check(formula, self._vocabulary)
        ground = expand(formula, self.domains)
        monitor = Monitor(self._table(ground))
        self._written[name] = formula
        self._monitors[name] = self._undecided[name] = monitor
        self._gather_atoms()

    def remove(self, name: str) -> Verdict:
        """Forget a formula and return its last verdict."""
        verdict = self._monitor(name).verdict
        del self._monitors[name], self._written[name]
        self._undecided.pop(name, None)
        self._gather_atoms()
        return verdict

    def step(self, now: TimePoint, state: Mapping[str, Any]) -> dict[str, Verdict]:
        """Take in the state at *now* and return the verdicts that it brought about.

        Args:
            now: The time of the state, later than that of the state before.
            state: The features by their printed terms; more than needed may be given.

        Raises:
            FeatureError: A feature is missing, of the wrong kind, or NaN; nothing has changed.
            StateOrderError: The state is not later than the one before; nothing has changed.
        """
        check_order(self._time, now)
        bits = self._columns.of_state(state)
        self._time = now
        decided: dict[str, Verdict] = {}
        for name, monitor in self._undecided.items():
            own = 0
            for number, source in enumerate(self._sources[name]):
                own |= (bits >> source & 1) << number
            verdict = monitor.step_bits(now, own)
            if verdict is not Verdict.UNDECIDED:
                decided[name] = verdict
        if decided:
            for name in decided:
                del self._undecided[name]
            self._gather_atoms()
        return decided

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """The present verdict of each formula."""
        return {name: monitor.verdict for name, monitor in self._monitors.items()}

    def formula(self, name: str) -> Formula:
        """Return a formula as it was added."""
        self._monitor(name)
        return self._written[name]

    def residual(self, name: str) -> Formula:
        """Return what must hold from now on for a formula to be true."""
        return self._monitor(name).residual

    def symbols(self) -> Symbols:
        """Return the features that each state must have, and the sorts that are quantified over.

        The features are those of the undecided formulas, for each object of the domains; the
        sorts are those of all formulas.
        """
        ground = (monitor.table.formula for monitor in self._undecided.values())
        sorts = extract_symbols(self._written.values()).sorts
        return Symbols(extract_symbols(ground).features, sorts)

    def _monitor(self, name: str) -> Monitor:
        if name not in self._monitors:
            hint = did_you_mean(nearest_name(name, self._monitors))
            raise ValueError(f"no formula called '{name}'{hint}")
        return self._monitors[name]

    def _table(self, ground: Formula) -> ProgressionTable:
        for monitor in self._monitors.values():
            if monitor.table.formula == ground:
                return monitor.table
        return ProgressionTable(ground, self._limit, self.time_model)

    def _gather_atoms(self) -> None:
        """Number the atoms of the undecided formulas, each atom once."""
        number_by_atom: dict[Atom, int] = {}
        self._sources = {
            name: _numbers(monitor.table.atoms, number_by_atom)
            for name, monitor in self._undecided.items()
        }
        self._columns = AtomColumns(tuple(number_by_atom))


def _numbers(atoms: Iterable[Atom], number_by_atom: dict[Atom, int]) -> tuple[int, ...]:
    return tuple(number_by_atom.setdefault(atom, len(number_by_atom)) for atom in atoms)
