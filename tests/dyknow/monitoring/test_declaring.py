"""What is declared for formulas."""

import pytest

from dyknow.errors import PolicyError
from dyknow.kpl.build import specification
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.printer import text_from
from dyknow.monitoring.declaring import (
    Beginning,
    beginning_of_states,
    constraints_of_states,
    declaration_of_states,
    declaration_of_unit,
    declarations_of_verdicts,
    is_name,
)
from tests.support.networks import network_of, samples_at
from tests.support.streams import ms

NETWORK = """
source n fast
source n slow
strmgen fast = fast
strmgen slow = slow
stream fast = fast
stream slow = slow
"""


def _kernel(until, slow=0):
    sources = {
        "fast": samples_at(dict.fromkeys(range(0, 1000, 40), 1)),
        "slow": samples_at({slow: 1}),
    }
    network = network_of(NETWORK, sources)
    network.kernel.run(ms(until))
    return network.kernel


def test_declarations_are_texts_of_kpl():
    """Written and read again they are the same, whatever stands in a formula."""
    constraints = constraints_of_states("sample every 50, use most recent, to 900")
    begin = Beginning({"slow[a, b]": ms(120)}, ms(450))
    declared = specification(
        declaration_of_unit(),
        declaration_of_states("states_1", ["fast", "slow[a, b]"], constraints, begin),
        *declarations_of_verdicts("f", "states_1", {"f": 'x = "\\\\"', "g": 'y = "\\""'}),
    )

    text = text_from(declared)
    assert text == (
        "compunit verdict EvaluateFormulas(any)\n"
        "strmgen states_1 = sync(fast, slow[a, b] with from 120) with sample every 50, use most "
        "recent, from 450 to 900\n"
        'strmgen verdicts[f] = EvaluateFormulas(states_1, name = "f", formulas = '
        '["x = \\"\\\\\\\\\\"", "g: y = \\"\\\\\\"\\""])\n'
        "stream verdicts[f] = verdicts[f]\n"
    )
    assert parse_specification(text) == declared


@pytest.mark.parametrize(
    ("policy", "expected"),
    [
        ("any update, use most recent", Beginning({"fast": ms(480), "slow": ms(0)}, ms(500))),
        ("sample every 50, use linear", Beginning({"fast": ms(480), "slow": ms(0)}, ms(530))),
        ("sample every 20, use linear", Beginning({"fast": ms(480), "slow": ms(0)}, ms(500))),
        ("use most recent, from 600", Beginning({"fast": ms(480), "slow": ms(0)})),
        (
            "sample every common period, use most recent",
            Beginning({"fast": ms(480), "slow": ms(0)}),
        ),
        ("any update", Beginning({})),
        ("", Beginning({})),
    ],
)
def test_states_begin_now_with_the_newest_values(policy, expected):
    """Unless nothing may stand for a value, or the policy says when they begin."""
    constraints = constraints_of_states(policy)
    assert beginning_of_states(["fast", "slow"], constraints, _kernel(500)) == expected


def test_states_wait_for_a_stream_that_has_not_spoken():
    """The others are taken from their newest sample on all the same."""
    constraints = constraints_of_states("use most recent")
    kernel = _kernel(500, slow=700)
    assert beginning_of_states(["fast", "slow"], constraints, kernel) == Beginning(
        {"fast": ms(480)}
    )
    assert beginning_of_states(["other"], constraints, kernel) == Beginning({})
    kernel.generator("fast").reset()
    assert beginning_of_states(["fast"], constraints, kernel) == Beginning({})


def test_states_that_are_made_twice_are_refused():
    """Regular states of the latest values are made once each."""
    assert constraints_of_states("sample every 100, use latest")
    with pytest.raises(PolicyError, match="'use latest' may make several"):
        constraints_of_states("any change, use latest")


def test_a_name_is_what_can_stand_in_a_label():
    """Words that KPL reserves cannot."""
    assert is_name("calm")
    assert is_name("select")
    assert not any(map(is_name, ["", "use", "a b", "a[b]", "7", "true", "été"]))
