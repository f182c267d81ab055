"""The link process does what its definition says, for all objects at once."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from anchoring.links import LinkSettings
from anchoring.processes import LinkProcess
from dyknow.errors import UnknownNameError
from dyknow.mtl.parser import parse_formula
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import milliseconds
from tests.anchoring.naive_links import FlatUnit, NaiveLinks


def _settings(establish, reestablish, maintain, remove_after=2000, least_states=1):
    return LinkSettings(
        establish=parse_formula(establish),
        reestablish=parse_formula(reestablish),
        maintain=parse_formula(maintain),
        remove_after=milliseconds(remove_after),
        least_states=least_states,
    )


def _table(seen):
    """Return a table of lower objects from id -> (position, loud, observed)."""
    values = list(seen.values())
    return Table(
        "percept",
        list(seen),
        {
            "position": np.array([v[0] for v in values], dtype=float).reshape(-1, 2),
            "loud": np.array([v[1] for v in values], dtype=bool),
            "observed": np.array([v[2] for v in values], dtype=bool),
        },
    )


def _push(process, time, seen):
    now = milliseconds(time)
    (sample,) = process.push(now, (Sample(_table(seen), now, now),))
    return sample.value


def _links(process):
    """Return the standing links, lower id -> upper id."""
    return {
        int(link.lower.removeprefix("percept")): int(link.upper.removeprefix("thing"))
        for link in process.history
        if link.end is None
    }


ESTABLISH = [
    "true",
    "eventually [300, oo] true",
    "always [0, 200] loud(from)",
    "eventually [0, oo] always [0, 300] loud(from)",
]
REESTABLISH = [
    ("false", 0.0),
    ("eventually [0, 400] xydist(from, to) < 3", 3.0),
    ("eventually [0, 400] (xydist(from, to) < 3 and loud(from))", 3.0),
    ("eventually [0, 600] always [0, 200] xydist(from, to) <= 5", 5.0),
    ("xydist(from, to) < 6 until [0, 700] loud(from)", 6.0),
    ("eventually [0, oo] (xydist(from, to) < 4 and calm(to))", 4.0),
    ("eventually [200, 500] calm(to)", 0.0),
    ("eventually [100, 500] loud(from)", 0.0),
    ("eventually [0, 300] (xydist(from, to) < 2 or xydist(from, to) > 7 and loud(from))", 7.0),
    ("eventually [0, 400] 2 * xydist(from, to) < 5", 0.0),
]
MAINTAIN = [
    "true",
    "always xydist(from, to) < 3",
    "always eventually [0, 500] loud(from)",
    "always [0, 600] not loud(from)",
]

_places = st.tuples(st.integers(0, 8), st.integers(0, 2))
_seen = st.dictionaries(
    st.integers(1, 4),
    st.tuples(_places, st.booleans(), st.sampled_from([True, True, False])),
    max_size=4,
)
_scenario = st.lists(st.tuples(st.sampled_from([100, 100, 170, 450]), _seen), max_size=14)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(
    _scenario,
    st.sampled_from(ESTABLISH),
    st.sampled_from(REESTABLISH),
    st.sampled_from(MAINTAIN),
    st.sampled_from([(300, 1), (300, 4), (1000, 1), (5000, 2)]),
    st.booleans(),
)
def test_all_at_once_does_what_one_at_a_time_does(
    scenario, establish, reestablish, maintain, patience, trusts
):
    """Links, symbols and states are those of the definition, object by object and all pairs."""
    rng = np.random.default_rng(len(scenario))
    condition, gate = reestablish
    chosen = _settings(establish, condition, maintain, *patience)
    process = LinkProcess(FlatUnit(trusts_predictions=trusts), chosen)
    naive = NaiveLinks(chosen, gate, trusts_predictions=trusts)
    time = 0

    for elapsed, seen in scenario:
        time += elapsed
        # Distances are never equal, so that there is one best choice.
        moved = {
            p: (tuple(np.array(place) + rng.uniform(-0.2, 0.2, 2)), loud, observed)
            for p, (place, loud, observed) in seen.items()
        }
        expected = naive.step(milliseconds(time), moved)
        found = _push(process, time, moved)

        assert _links(process) == expected
        assert found.ids.tolist() == list(naive.things)
        for row, (position, calm, *_) in enumerate(naive.things.values()):
            np.testing.assert_allclose(found["position"][row], position)
            assert found["calm"][row] == calm


NEAR = "eventually [0, 400] xydist(from, to) < 3"


def test_a_new_object_is_established_when_its_condition_is_true():
    """Until the establish condition is true there is no upper object."""
    process = LinkProcess(FlatUnit(), _settings("eventually [300, oo] true", NEAR, "true"))
    seen = {7: ((0, 0), False, True)}

    counts = [len(_push(process, t, seen)) for t in range(0, 500, 100)]

    assert counts == [0, 0, 0, 1, 1]
    assert _links(process) == {7: 1}


def test_reestablish_wins_over_establish():
    """If both become true in one state, no new symbol is made."""
    process = LinkProcess(FlatUnit(), _settings("true", NEAR, "true"))
    _push(process, 0, {1: ((0, 0), False, True)})
    _push(process, 100, {})

    _push(process, 200, {2: ((1, 0), False, True)})

    assert _links(process) == {2: 1}


def test_an_object_stays_when_its_percept_is_gone_until_it_is_given_up():
    """An unanchored object is kept for as long as the settings say."""
    process = LinkProcess(FlatUnit(), _settings("true", NEAR, "true", remove_after=1000))
    _push(process, 0, {1: ((0, 0), False, True)})

    counts = [len(_push(process, t, {})) for t in range(100, 1300, 100)]

    assert counts == [1] * 9 + [0] * 3
    assert [(link.begin, link.end) for link in process.history] == [(0, milliseconds(100))]


def test_a_violated_link_is_removed_and_another_hypothesis_made():
    """When maintain fails the object remains, and its percept looks for another one."""
    process = LinkProcess(
        FlatUnit(), _settings("eventually [200, oo] true", "false", "always not loud(from)")
    )
    for time in range(0, 400, 100):
        _push(process, time, {1: ((0, 0), False, True)})
    _push(process, 400, {1: ((0, 0), True, True)})
    assert _links(process) == {}

    for time in range(500, 900, 100):
        _push(process, time, {1: ((0, 0), False, True)})

    assert _links(process) == {1: 2}
    assert len(_push(process, 900, {1: ((0, 0), False, True)})) == 2


def test_a_row_of_objects_is_not_shifted_by_one():
    """Objects that all have moved on by the same amount are found again in their order."""
    process = LinkProcess(
        FlatUnit(), _settings("true", "eventually [0, 400] xydist(from, to) < 9", "true")
    )
    _push(process, 0, {i: ((10 * i, 0), False, True) for i in range(5)})
    _push(process, 100, {})

    _push(process, 200, {10 + i: ((10 * i + 5.5, 0), False, True) for i in range(5)})

    assert _links(process) == {10 + i: 1 + i for i in range(5)}


def test_predicted_lower_objects_hold_no_link_unless_predictions_are_trusted():
    """A lower object that is only predicted counts as vanished, or not, as the unit says."""
    predicted = {1: ((0, 0), False, False)}
    for trusts, expected in ((False, {}), (True, {1: 1})):
        unit = FlatUnit(trusts_predictions=trusts)
        process = LinkProcess(unit, _settings("true", NEAR, "true"))
        _push(process, 0, {1: ((0, 0), False, True)})
        _push(process, 100, predicted)

        assert _links(process) == expected


def test_samples_without_value_and_late_ones_say_nothing():
    """Only tables that are later than the last one, and new, make the process speak."""
    process = LinkProcess(FlatUnit(), _settings("true", NEAR, "true"))
    _push(process, 100, {1: ((0, 0), False, True)})
    late = Sample(_table({}), milliseconds(100), milliseconds(150))
    old = Sample(_table({}), milliseconds(120), milliseconds(150))

    assert list(process.push(milliseconds(150), (late,))) == []
    assert list(process.push(milliseconds(160), (old,))) == []
    assert list(process.push(160, (Sample(NO_VALUE, 160, 160),))) == []
    assert list(process.advance(milliseconds(170))) == []
    assert process.due() is None


def test_an_unknown_feature_is_named():
    """A condition about a feature that there is not is reported with its place."""
    process = LinkProcess(FlatUnit(), _settings("lod(from)", NEAR, "true"))

    with pytest.raises(UnknownNameError, match="did you mean 'loud'") as caught:
        _push(process, 0, {1: ((0, 0), False, True)})

    assert caught.value.span.place == "<formula>:1:1"


def test_who_comes_back_under_its_own_name_takes_up_its_link():
    """No condition is asked, unless the upper object is linked to another one by then."""
    near = "eventually [0, oo] xydist(from, to) < 2"
    process = LinkProcess(FlatUnit(), _settings("true", near, "true", 5000))
    here, there = ((0, 0), False, True), ((8, 0), False, True)

    _push(process, 100, {1: here})
    _push(process, 200, {})
    _push(process, 300, {1: there})
    taken_up = _links(process)
    _push(process, 400, {})
    _push(process, 500, {2: there})
    _push(process, 600, {1: here, 2: there})

    assert taken_up == {1: 1}
    assert _links(process) == {2: 1, 1: 2}


def test_an_object_is_looked_for_in_a_few_states_however_seldom_they_are():
    """It is given up in the fifth state without it if its time is over by then."""
    process = LinkProcess(FlatUnit(), _settings("true", "false", "true", 300, 5))
    _push(process, 100, {1: ((0, 0), False, True)})

    left = [len(_push(process, 100 + 1000 * k, {})) for k in range(1, 6)]

    assert left == [1, 1, 1, 1, 0]
