"""Columns become the Arrow arrays that pyarrow itself would make."""

import subprocess
import sys

import numpy as np
import pyarrow as pa
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.explaining.arrays import array_of

texts = st.text(max_size=5)
kinds = st.one_of(
    st.tuples(st.just(pa.string()), st.lists(st.none() | texts)),
    st.tuples(st.just(pa.list_(pa.string())), st.lists(st.lists(texts, max_size=3))),
    st.tuples(st.just(pa.int64()), st.lists(st.none() | st.integers(-(1 << 62), 1 << 62))),
    st.tuples(st.just(pa.bool_()), st.lists(st.none() | st.booleans())),
    st.tuples(st.just(pa.float32()), st.lists(st.floats(width=32, allow_nan=False))),
    st.tuples(st.just(pa.dictionary(pa.int32(), pa.string())), st.lists(st.sampled_from("abä"))),
)


@given(kinds)
@settings(derandomize=True, deadline=None, max_examples=300)
def test_lists_become_arrays(given_column):
    """Of every kind that is kept, with and without gaps."""
    kind, values = given_column

    found = array_of(values, kind, len(values))

    found.validate(full=True)
    assert found.type == kind
    assert found.to_pylist() == values


def test_arrays_and_single_texts_become_columns():
    """A text stands in all rows, nothing becomes nulls, and an array is taken as it is."""
    name = pa.dictionary(pa.int32(), pa.string())

    assert array_of("cars", name, 3).to_pylist() == ["cars"] * 3
    assert array_of(None, pa.int32(), 2).to_pylist() == [None, None]
    assert array_of(np.arange(6)[::2], pa.int64(), 3).to_pylist() == [0, 2, 4]
    assert array_of(np.array([True, False]), pa.bool_(), 2).to_pylist() == [True, False]


def test_keeping_does_not_import_pandas():
    """It would cost a short run more than all that is kept of it."""
    code = (
        "import sys, pyarrow as pa; from traffic.explaining.arrays import array_of; "
        "array_of(['a'], pa.string(), 1); array_of([1], pa.int64(), 1); "
        "print('pandas' in sys.modules)"
    )

    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert said.stdout.strip() == "False"
