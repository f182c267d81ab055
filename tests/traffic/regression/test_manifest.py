"""What stands beside the recordings of a suite about them."""

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.regression import piece
from traffic.errors import RegressionError
from traffic.regression.manifest import Making, read_manifest, text_from_making
from traffic.request import View

_TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
_SETTINGS = st.dictionaries(
    st.sampled_from(["view", "position_noise", "turns.file", "cars/1", "a b"]),
    st.one_of(
        st.booleans(), st.integers(), st.floats(allow_nan=False, allow_infinity=False), _TEXTS
    ),
    max_size=4,
)


def making(**values: Any) -> Making:
    """Return how a recording is made, which has these values and usual ones."""
    usual = {"name": "one", "scenario": "rural", "seed": 3, "from": "1 s", "to": "2500 ms"}
    return Making.model_validate({**usual, **values})


@settings(derandomize=True, deadline=None, max_examples=100)
@given(shows=_TEXTS, chosen=_SETTINGS)
def test_what_is_written_is_read(
    shows: str, chosen: dict[str, Any], tmp_path_factory: Any
) -> None:
    """Whatever texts and settings there are, one after another."""
    folder = tmp_path_factory.mktemp("suite")
    one = making(shows=shows, settings=chosen)
    other = making(name="other", scenario=None, seed=1)

    for each in (one, other):
        read_manifest(folder).add(each)

    assert list(read_manifest(folder).makings.values()) == [one, other]


def test_a_recording_says_of_which_run_it_is_a_piece(tmp_path: Path) -> None:
    """The settings are those of an experiment."""
    made = making(settings={"view": "truth", "position_noise": 2, "dropout": 0.1})

    request = made.request(tmp_path)

    assert made.piece == piece(1, 2.5)
    assert (request.view, request.position_noise, request.seed) == (View.TRUTH, 2, 3)
    assert request.changes == {"dropout": 0.1}
    with pytest.raises(RegressionError, match="nothing says how the run of 'one' was made"):
        making(scenario=None).request(tmp_path)


def test_a_suite_need_not_say_anything(tmp_path: Path) -> None:
    """Then nothing is known of its recordings but what they say themselves."""
    assert read_manifest(tmp_path).makings == {}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("seed = 3", "sede = 3", r":5:1: no key called 'sede' here; did you mean 'seed'\?"),
        ('name = "one"\n', "", ":1:1: the key 'name' is missing"),
        ('to = "2500 ms"', 'to = "soon"', ":7:1: "),
        ('to = "2500 ms"', 'to = "1 s"', "expected 'from' before 'to', found 1 s and 1 s"),
        ("seed = 3", "seed = -3", ":5:1: expected greater than or equal to 0"),
        ("[[recordings]]", "[recordings]", "expected an array"),
        ("[[recordings]]", "[[recording]]", r"did you mean 'recordings'\?"),
        ("seed = 3", "seed = ", ":5:"),
    ],
)
def test_faults_are_told_with_their_places(tmp_path: Path, old: str, new: str, said: str) -> None:
    """File, line and column, and what was expected there."""
    text = text_from_making(making())
    assert old in text
    (tmp_path / "suite.toml").write_text(text.replace(old, new))

    with pytest.raises(RegressionError, match=said):
        read_manifest(tmp_path)


def test_names_are_given_once(tmp_path: Path) -> None:
    """The place of the second one is told."""
    text = text_from_making(making())
    (tmp_path / "suite.toml").write_text(f"{text}\n{text}")

    with pytest.raises(RegressionError, match=r":10:1: there is another recording 'one'"):
        read_manifest(tmp_path)
