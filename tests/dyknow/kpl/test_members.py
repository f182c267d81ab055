"""The members that a value stands for, and the labels that texts are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.kpl.members import Mediator, label_from, members_in, objects_in
from dyknow.streams.sample import NO_SAMPLE, NO_VALUE, Sample
from dyknow.streams.table import Table
from tests.support.streams import ms, text


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("car1", ("car1",)),
        ({"b", "a"}, ("a", "b")),
        (frozenset(), ()),
        (["b", "a", "b"], ("b", "a")),
        (("b",), ("b",)),
        (Table("car", np.array([7, 3]), {}), ("car7", "car3")),
        (NO_VALUE, ()),
    ],
)
def test_a_value_stands_for_members(value, expected):
    """Sets come in the order of the alphabet, what has an order of its own in that."""
    assert members_in(value) == expected
    assert objects_in(value) == expected


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.lists(st.sampled_from("abcdef")))
def test_members_are_those_of_the_set(names):
    """However a set is written, it has the same members, each once."""
    assert sorted(members_in(names)) == list(members_in(set(names))) == sorted(set(names))


@pytest.mark.parametrize("value", [3, None, {1}, ["a", None], {"a": 1}])
def test_other_values_stand_for_nothing(value):
    """That is a ValueError."""
    with pytest.raises(ValueError, match="expected"):
        members_in(value)


@pytest.mark.parametrize(
    ("written", "printed"),
    [("pos", "pos"), (" pos [ a,b ] ", "pos[a, b]"), ("p_1[x]", "p_1[x]")],
)
def test_a_text_may_be_a_label(written, printed):
    """Spaces mean nothing."""
    assert label_from(written).text == printed


@pytest.mark.parametrize("written", ["", "1a", "a[", "a[]", "a[b,]", "a b", "a[b[c]]", "a[b] c"])
def test_other_texts_are_no_labels(written):
    """That is a ValueError."""
    with pytest.raises(ValueError, match="expected a label such as"):
        label_from(written)


def test_a_mediator_merges_all_inputs_but_the_first():
    """It tells of new sets; the number of its inputs may change from call to call."""
    mediator, told = Mediator(), []
    mediator.on_members = told.append
    sets = Sample({"a"}, ms(1), ms(1))

    assert mediator.push(ms(1), (sets, NO_SAMPLE)) == []
    found = mediator.push(ms(2), (sets, Sample("x", ms(2), ms(2)), Sample("y", ms(0), ms(2))))

    assert told == [{"a"}]
    assert text(found) == "2:x 0:y@2+1"
