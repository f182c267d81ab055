"""The formulas and the sequences of states of Heintz (2009), section 7.10.

There is one proposition, and a state every 100 ms, or about that. In a sequence the proposition
is false for some states and then true for some states, over and over. Where the period varies,
a stretch has as many states as fit into the time that it has with the regular period, so that no
formula is ever violated and the worst case stays the worst.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dyknow.mtl.parser import parse_formula
from dyknow.mtl.syntax import Formula
from dyknow.time import Duration, TimePoint, milliseconds

__all__ = ["FORMULAS", "JITTERS", "PERIOD", "Alternation", "FormulaUnderTest", "times", "truth"]

PERIOD = milliseconds(100)
"""Between states, on the average."""

JITTERS = (0.0, 0.1, 0.5)
"""How much the time between two states differs from the period, at most, as a share of it."""

_GOLDEN = (5**0.5 - 1) / 2


@dataclass(frozen=True, slots=True)
class Alternation:
    """A sequence of states.

    Attributes:
        n_false: For how many states the proposition is false.
        n_true: For how many it is true after that.
    """

    n_false: int
    n_true: int

    def __str__(self) -> str:
        """Return the sequence as the thesis writes it."""
        return f"false*{self.n_false}, true*{self.n_true}" if self.n_false else "true"


@dataclass(frozen=True, slots=True)
class FormulaUnderTest:
    """A formula with what the thesis has to say about it.

    Attributes:
        name: A few words without spaces.
        text: The formula.
        alternations: The sequences of states, from the best to the worst.
        average: The figure with the average times.
        by_state: The figure with the time of each state.
        least: The shortest time of a state, µs.
        most: The longest time of a state, µs.
        at_once: How many can be followed at 100 ms with the worst sequence.
        cycle: The times of the states of the worst sequence, over and over, µs.
        remark: How that is known.
    """

    name: str
    text: str
    alternations: tuple[Alternation, ...]
    average: str
    by_state: str
    least: float
    most: float
    at_once: int
    cycle: tuple[float, ...]
    remark: str

    @property
    def formula(self) -> Formula:
        """The formula."""
        return parse_formula(self.text)

    def published(self, at: int) -> float:
        """Return the time of state number *at*, in the thesis, µs."""
        return self.cycle[at % len(self.cycle)]

    @property
    def worst(self) -> Alternation:
        """The sequence of states that takes longest."""
        return self.alternations[-1]


FORMULAS = (
    FormulaUnderTest(
        name="eventually",
        text="always eventually [0, 1000] p",
        alternations=(Alternation(0, 1), Alternation(1, 1), Alternation(10, 1)),
        average="7.14",
        by_state="7.15",
        least=30,
        most=47,
        at_once=2_500,
        cycle=(30, *[40] * 9, 47),
        remark="the worst sequence, as the text has it: 30, a plateau of 40, a peak of 47",
    ),
    FormulaUnderTest(
        name="eventually-always",
        text="always (not p -> eventually [0, 1000] always [0, 999] p)",
        alternations=(
            Alternation(0, 1),
            Alternation(1, 10),
            Alternation(1, 40),
            Alternation(10, 10),
        ),
        average="7.16",
        by_state="7.17",
        least=32,
        most=72,
        at_once=1_500,
        cycle=(72,),
        remark="from the text: no state takes longer, and none less than 32",
    ),
)


def times(n_states: int, jitter: float) -> list[TimePoint]:
    """Return the times of states, which differ from a regular grid in a way without a period."""
    gaps = [
        Duration(round(PERIOD * (1 + jitter * (2 * (number * _GOLDEN % 1) - 1))))
        for number in range(n_states)
    ]
    found, now = [], 0
    for gap in gaps:
        found.append(TimePoint(now))
        now += gap
    return found


def truth(
    alternation: Alternation, at: Sequence[TimePoint], n_before: int = 0
) -> npt.NDArray[np.bool_]:
    """Return the truth of the proposition in states at the given times, shape (n,).

    It is true in the first *n_before* states, and then the sequence begins.
    """
    values = np.ones(len(at), dtype=np.bool_)
    if alternation.n_false == 0:
        return values
    longest = alternation.n_false * PERIOD
    shortest = alternation.n_true * PERIOD
    begin, is_true, number = n_before, False, n_before
    while number < len(at):
        values[number] = is_true
        number += 1
        following = at[min(number + (not is_true), len(at) - 1)] - at[begin]
        is_over = following >= shortest if is_true else following > longest
        enough = number - begin >= (alternation.n_true if is_true else 1)
        if is_over and enough:
            begin, is_true = number, not is_true
    return values
