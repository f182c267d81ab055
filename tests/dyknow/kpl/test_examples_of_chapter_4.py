"""The examples of Heintz (2009), section 4.4, in KPL.

Those of sections 4.3 and 4.5, which are about streams, stand in `tests/dyknow/streams`.
"""

import pytest

from dyknow.kpl.check import faults
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.policies import policy_from_constraints
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    GeneratorDeclaration,
    SourceDeclaration,
    SourceInstance,
    StreamDeclaration,
    UnitDeclaration,
    UnitInstance,
)
from dyknow.streams.conformance import satisfies
from dyknow.streams.policy import (
    ANY_CHANGE,
    ANY_UPDATE,
    Approximation,
    Order,
    Policy,
    SampleEvery,
)
from tests.support.streams import ms, stream

EXAMPLE_4_4_1 = """
source pos pos_car1
strmgen pos[car1] = pos_car1

compunit speed SpeedEst(pos)
strmgen speed[car1] = SpeedEst(pos[car1] with sample every 200)
stream speed_car1 = speed[car1] with from 300 to 400

source pos pos_car2
strmgen pos[car2] = pos_car2
strmgen speed[car2] = SpeedEst(pos[car2] with max delay 100, monotone order)
stream speed_car2 = speed[car2]
"""


def _policy(text):
    specification = parse_specification(f"stream out = label with {text}")
    (declaration,) = specification.declarations
    assert isinstance(declaration, StreamDeclaration)
    return policy_from_constraints(declaration.stream.constraints)


def _declarations(kind):
    declared = parse_specification(EXAMPLE_4_4_1).declarations
    return [declaration for declaration in declared if isinstance(declaration, kind)]


def test_example_4_4_1_an_application_without_faults():
    """Two positions, one way to estimate a speed, two speeds, and two outputs."""
    specification = parse_specification(EXAMPLE_4_4_1)

    assert faults(specification) == []
    assert parse_specification(text_from(specification)) == specification


def test_example_4_4_2_the_symbols_of_the_application():
    """Sources, units with their arity, generators with their arguments, and output streams."""
    sources = _declarations(SourceDeclaration)
    units = _declarations(UnitDeclaration)
    generators = _declarations(GeneratorDeclaration)
    outputs = _declarations(StreamDeclaration)

    assert {one.name.text for one in sources} == {"pos_car1", "pos_car2"}
    assert {(one.name.text, len(one.inputs)) for one in units} == {("SpeedEst", 1)}
    assert {text_from(one.label) for one in generators} == {
        "pos[car1]",
        "pos[car2]",
        "speed[car1]",
        "speed[car2]",
    }
    assert {one.name.text for one in outputs} == {"speed_car1", "speed_car2"}


def test_example_4_4_3_a_source_declaration():
    """The source `pos_car1` provides samples of the sort `pos`."""
    assert text_from(_declarations(SourceDeclaration)[0]) == "source pos pos_car1"


def test_example_4_4_4_a_declaration_of_a_computational_unit():
    """The unit takes samples of the sort `pos` and computes samples of the sort `speed`."""
    assert text_from(_declarations(UnitDeclaration)[0]) == "compunit speed SpeedEst(pos)"


def test_example_4_4_5_label_terms():
    """A label is a feature and the objects it is about."""
    label = _declarations(GeneratorDeclaration)[0].label

    assert (label.feature.text, [one.text for one in label.objects]) == ("pos", ["car1"])


def test_example_4_4_6_a_primitive_process():
    """A generator can be that of a source."""
    declaration = _declarations(GeneratorDeclaration)[0]

    assert isinstance(declaration.process, SourceInstance)
    assert text_from(declaration) == "strmgen pos[car1] = pos_car1"


def test_example_4_4_7_a_refinement_process():
    """A generator can be that of a unit which is applied to streams."""
    declaration = _declarations(GeneratorDeclaration)[1]

    assert isinstance(declaration.process, UnitInstance)
    assert text_from(declaration) == (
        "strmgen speed[car1] = SpeedEst(pos[car1] with sample every 200)"
    )


def test_example_4_4_8_a_change_constraint():
    """Samples are added every 100 time units."""
    policy = _policy("sample every 100")

    assert policy == Policy(change=SampleEvery(ms(100)))
    assert satisfies(stream("50:a 150:b 250:c"), policy)
    assert not satisfies(stream("50:a 250:c"), policy)


def test_example_4_4_9_a_delay_constraint():
    """The largest delay that will do is 100 time units."""
    policy = _policy("max delay 100")

    assert policy == Policy(max_delay=ms(100))
    assert satisfies(stream("50:a@150"), policy)
    assert not satisfies(stream("50:a@151"), policy)


def test_example_4_4_10_a_duration_constraint():
    """The valid times of interest lie between 300 and 400."""
    policy = _policy("from 300 to 400")

    assert policy == Policy(start=ms(300), end=ms(400))
    assert satisfies(stream("300:a 400:b@500"), policy)
    assert not satisfies(stream("299:a"), policy)
    assert not satisfies(stream("401:a"), policy)


def test_example_4_4_11_an_order_constraint():
    """Samples come in order of valid time, and several may have the same."""
    policy = _policy("monotone order")

    assert policy == Policy(order=Order.MONOTONE)
    assert satisfies(stream("10:a 10:b@11 20:c"), policy)
    assert not satisfies(stream("10:a 20:c 10:b@21"), policy)


def test_example_4_4_12_an_approximation_constraint():
    """Where a sample is missing, the most recent value is used, with what that needs."""
    policy = _policy("use most recent, sample every 100, max delay 50, from 0 to oo")

    assert policy.approximation is Approximation.MOST_RECENT
    for text in ("use most recent", "use most recent, sample every 100, max delay 50"):
        with pytest.raises(ValueError, match="'use most recent' needs"):
            _policy(text)


def test_example_4_4_13_a_fluent_stream_term():
    """A stream of positions, sampled every 200 time units."""
    process = _declarations(GeneratorDeclaration)[1].process

    assert isinstance(process, UnitInstance)
    assert text_from(process.streams[0]) == "pos[car1] with sample every 200"


def test_example_4_4_14_a_fluent_stream_declaration():
    """An output is a stream with a name."""
    declaration = _declarations(StreamDeclaration)[0]

    assert text_from(declaration) == "stream speed_car1 = speed[car1] with from 300 to 400"


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("any update", Policy(change=ANY_UPDATE)),
        ("any change", Policy(change=ANY_CHANGE)),
        ("max delay oo", Policy()),
        ("from 300 to oo", Policy(start=ms(300))),
        ("from 300", Policy(start=ms(300))),
        ("to 400", Policy(end=ms(400))),
        ("to oo", Policy()),
        ("any order", Policy()),
        ("strict order", Policy(order=Order.STRICT)),
        ("no approximation", Policy()),
    ],
)
def test_section_4_4_5_what_is_left_out_restricts_nothing(text, meaning):
    """Each constraint has the default that the thesis gives it."""
    assert _policy(text) == meaning
