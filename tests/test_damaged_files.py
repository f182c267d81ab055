"""Files that come with the program, damaged: each is read or refused, never a crash."""

import gzip
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.kpl.check import faults_of_text
from dyknow.mtl import check as formula_check
from dyknow.mtl.parser import parse_formula
from networks.errors import NetworkFileError
from networks.reading import read_road_map
from networks.roads import RoadMap
from traffic.bundled import data_folder
from traffic.errors import ScenarioError
from traffic.scenarios import Scenario, read_scenario

DATA = data_folder()
SCENARIOS = sorted((DATA / "scenarios").glob("*.toml"))
SPECIFICATION = DATA / "specifications" / "monitoring.kpl"
CHRONICLES = sorted((DATA / "chronicles").glob("*.chronicle"))
NETWORK = DATA / "networks" / "rural" / "rural.net.xml"
FORMULA = "always [0, 10 s] (speed[x] > 3 -> eventually [0, 500] not on_road(x) until p = 'q')"
SNIPPETS = st.one_of(
    st.text(max_size=3),
    st.sampled_from(["[", "]", "(", ")", "{", '"', "=", ",", "\n", "0", "-1", "1e999", "9" * 25]),
    st.sampled_from(["oo", "nan", "?x", "<", "/>", "&", "#", "\0", "\ud7ff", "id", "\t"]),
)


@st.composite
def damaged(draw, text):
    """Return *text* with up to three stretches lost, doubled, or written over, maybe cut off."""
    for _ in range(draw(st.integers(0, 3))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 40)))
        middle = draw(st.one_of(st.just(""), st.just(text[start:end] * 2), SNIPPETS))
        text = text[:start] + middle + text[end:]
    return text[: draw(st.one_of(st.just(len(text)), st.integers(0, len(text))))]


def fuzz(n_examples):
    """Return the settings of a test with so many examples, always the same ones."""
    return settings(derandomize=True, deadline=None, max_examples=n_examples, database=None)


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
@fuzz(120)
@given(data=st.data())
def test_a_damaged_scenario_is_read_or_refused(path, data, tmp_path_factory):
    """Nothing but a scenario or a ScenarioError comes of it."""
    file = tmp_path_factory.mktemp("damaged") / "s.toml"
    file.write_text(data.draw(damaged(path.read_text("utf-8"))), encoding="utf-8", newline="")

    with suppress(ScenarioError):
        assert isinstance(read_scenario(file), Scenario)


@fuzz(60)
@given(raw=st.binary(max_size=60))
def test_any_bytes_are_a_scenario_or_refused(raw, tmp_path_factory):
    """A file need not even be text."""
    file = tmp_path_factory.mktemp("damaged") / "s.toml"
    file.write_bytes(raw)

    with pytest.raises(ScenarioError):
        read_scenario(file)


@fuzz(60)
@given(data=st.data())
def test_a_damaged_specification_is_read_or_refused(data):
    """Nothing but a specification, or faults with places, comes of it."""
    text = data.draw(damaged(SPECIFICATION.read_text("utf-8")))

    faults = faults_of_text(text, "s.kpl")

    assert all(fault.report().startswith("s.kpl:") for fault in faults)


def test_a_parenthesis_that_is_never_closed_is_told_at_once():
    """How long that takes does not grow with the comments behind it."""
    text = "strmgen a = link(b, C, establish = (\n" + "# ---- # a long remark\n" * 40

    fault, *_ = faults_of_text(text, "s.kpl")

    assert fault.report().startswith("s.kpl:")


@pytest.mark.parametrize("path", CHRONICLES, ids=lambda path: path.stem)
@fuzz(60)
@given(data=st.data())
def test_damaged_chronicles_are_read_or_refused(path, data):
    """Nothing but models, or faults with places, comes of them."""
    text = data.draw(damaged(path.read_text("utf-8")))

    faults = []
    try:
        models_from_chronicles(parse_chronicles(text, "s.chronicle"))
    except SpecificationErrors as errors:
        faults = list(errors.exceptions)
    except SpecificationError as error:
        faults = [error]
    assert all(fault.report().startswith("s.chronicle:") for fault in faults)


@fuzz(200)
@given(text=damaged(FORMULA))
def test_a_damaged_formula_is_read_or_refused(text):
    """Nothing but a formula, or faults with places, comes of it."""
    try:
        faults = formula_check.faults(parse_formula(text, "f.mtl"))
    except SpecificationError as error:
        faults = [error]
    assert all(fault.report().startswith("f.mtl:") for fault in faults)


@fuzz(60)
@given(data=st.data())
def test_a_damaged_network_is_read_or_refused(data, tmp_path_factory):
    """Nothing but a road map or a NetworkFileError comes of it."""
    text = data.draw(damaged(NETWORK.read_text("utf-8")))

    assert_read_or_refused(text.encode("utf-8"), tmp_path_factory.mktemp("damaged"))


@fuzz(60)
@given(data=st.data())
def test_a_network_with_other_values_is_read_or_refused(data, tmp_path_factory):
    """The same holds where the XML is whole and only a value is wrong."""
    parts = NETWORK.read_text("utf-8").split('"')
    at = data.draw(st.integers(0, len(parts) // 2 - 1)) * 2 + 1
    parts[at] = data.draw(st.sampled_from(["", "x", "-1", "1e999", "nan", "0,0", "3 4", "0"]))

    assert_read_or_refused('"'.join(parts).encode("utf-8"), tmp_path_factory.mktemp("damaged"))


@fuzz(20)
@given(data=st.data())
def test_a_damaged_packed_network_is_refused(data, tmp_path_factory):
    """A packed network that was cut off, or of which a byte has changed, is refused."""
    packed = bytearray(gzip.compress(NETWORK.read_bytes()))
    end = data.draw(st.integers(2, len(packed) - 1))

    assert_read_or_refused(bytes(packed[:end]), tmp_path_factory.mktemp("damaged"))
    packed[end] ^= 1
    assert_read_or_refused(bytes(packed), tmp_path_factory.mktemp("damaged"))


def assert_read_or_refused(network: bytes, folder: Path) -> None:
    """Assert that only a road map or a NetworkFileError comes of a network file."""
    file = folder / "n.net.xml"
    file.write_bytes(network)
    with suppress(NetworkFileError):
        assert isinstance(read_road_map(file), RoadMap)
