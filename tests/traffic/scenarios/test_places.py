"""Where keys stand in TOML texts."""

import tomllib

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.source_text import SourceText
from traffic.scenarios.places import places_of_keys, span_of

TEXT = '''# a comment with [brackets]
name = "x"
route = [
    "a", # ] not the end
    "b",
]
"quoted key" = 1
[camera]
look_at = "c = d"
[[flows]]
types = { car = 1, "big truck" = 2 }
[[flows]]
a.b = """
not = "a key"
"""
[flows.inner]
deep = 1
'''


def test_every_key_has_its_line() -> None:
    """Keys of tables, arrays of tables, inline tables and dotted keys are found."""
    source = SourceText("t", TEXT)

    lines = {path: source.place(span.start)[0] for path, span in places_of_keys(source).items()}

    assert lines == {
        ("name",): 2,
        ("route",): 3,
        ("quoted key",): 7,
        ("camera",): 8,
        ("camera", "look_at"): 9,
        ("flows", 0): 10,
        ("flows", 0, "types"): 11,
        ("flows", 0, "types", "car"): 11,
        ("flows", 0, "types", "big truck"): 11,
        ("flows", 1): 12,
        ("flows", 1, "a", "b"): 13,
        ("flows", 1, "inner"): 16,
        ("flows", 1, "inner", "deep"): 17,
    }


def test_what_is_not_written_has_the_place_of_what_is_around_it() -> None:
    """A missing key is reported at its table, and at the begin of the text if that is missing."""
    source = SourceText("t", TEXT)
    places = places_of_keys(source)

    assert span_of(("camera", "altitude"), places, source).place == "t:8:1"
    assert span_of(("route", 1), places, source).place == "t:3:1"
    assert span_of(("nothing",), places, source).place == "t:1:1"


VALUES = ["1", '"s"', "[1, 2]", '[\n  "a",\n]', "{ x = 1 }", '"""\nm = 1\n"""', "'#['", "1 # = ["]


@given(
    st.lists(st.tuples(st.booleans(), st.lists(st.sampled_from(VALUES), max_size=4)), max_size=4)
)
@settings(derandomize=True, deadline=None, max_examples=100)
def test_all_keys_of_any_text_are_found(tables: list[tuple[bool, list[str]]]) -> None:
    """Every key that the standard library reads has a place, and the place holds the key."""
    lines, n_array = [], 0
    for i, (is_array, values) in enumerate(tables):
        lines.append("[[many]]" if is_array else f"[table{i}]")
        n_array += is_array
        lines += [f"key{j} = {value}" for j, value in enumerate(values)]
    source = SourceText("t", "\n".join(lines))

    places = places_of_keys(source)

    for name, table in tomllib.loads(source.text).items():
        for i, one in enumerate(table if isinstance(table, list) else [table]):
            prefix = (name, i) if isinstance(table, list) else (name,)
            for key in one:
                span = places[(*prefix, key)]
                assert source.text[span.start : span.end] == key
