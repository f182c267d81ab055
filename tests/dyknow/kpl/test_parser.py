"""From the text of a specification to its tree: the examples of Heintz (2009), section 4.4."""

from pathlib import Path

import pytest

from dyknow.kpl import build, syntax
from dyknow.kpl.check import faults, faults_of_text
from dyknow.kpl.parser import parse_specification, parse_value
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import Name, Time
from dyknow.mtl.syntax import descendants
from tests.support.streams import ms

PROGRAMS = Path("tests/languages/kpl")

EXAMPLE_4_4_1 = """
source pos pos_car1
strmgen pos[car1] = pos_car1
compunit speed SpeedEst(pos)
strmgen speed[car1] = SpeedEst(pos[car1] with sample every 200)
stream speed_car1 = speed[car1] with from 300 to 400
source pos pos_car2
strmgen pos[car2] = pos_car2
strmgen speed[car2] = SpeedEst(pos[car2] with max delay 100,
    monotone order)
stream speed_car2 = speed[car2]
"""


def test_example_4_4_1_a_small_application():
    """The text of the thesis is the tree that its prose describes."""
    pos1, pos2 = build.label("pos", "car1"), build.label("pos", "car2")
    speed1, speed2 = build.label("speed", "car1"), build.label("speed", "car2")
    sampled = build.term(pos1, syntax.SampleEvery(Time(ms(200))))
    ordered = build.term(pos2, syntax.MaxDelay(Time(ms(100))), syntax.MonotoneOrder())
    window = syntax.FromTo(Time(ms(300)), Time(ms(400)))

    specification = parse_specification(EXAMPLE_4_4_1)

    assert specification == build.specification(
        build.source("pos", "pos_car1"),
        build.strmgen(pos1, syntax.SourceInstance(Name("pos_car1"))),
        build.compunit("speed", "SpeedEst", "pos"),
        build.strmgen(speed1, build.application("SpeedEst", [sampled])),
        build.stream("speed_car1", build.term(speed1, window)),
        build.source("pos", "pos_car2"),
        build.strmgen(pos2, syntax.SourceInstance(Name("pos_car2"))),
        build.strmgen(speed2, build.application("SpeedEst", [ordered])),
        build.stream("speed_car2", build.term(speed2)),
    )
    assert faults(specification) == []


@pytest.mark.parametrize(
    ("policy", "constraint"),
    [
        ("no approximation", syntax.NoApproximation()),
        ("use most recent", syntax.UseMostRecent()),
        ("any update", syntax.AnyUpdate()),
        ("any change", syntax.AnyChange()),
        ("sample every 100", syntax.SampleEvery(Time(ms(100)))),
        ("sample every p", syntax.SampleEvery(Name("p"))),
        (
            "sample every p deviation d up to 400 under load",
            syntax.SampleEvery(Name("p"), Name("d"), Time(ms(400))),
        ),
        ("sample every common period", syntax.SampleEveryCommonPeriod()),
        ("sample every common", syntax.SampleEvery(Name("common"))),
        ("use linear", syntax.UseLinear()),
        ("use latest", syntax.UseLatest()),
        ("all updates", syntax.AllUpdates()),
        ("delay before approximation 50", syntax.DelayBeforeApproximation(Time(ms(50)))),
        ("at max delay", syntax.AtMaxDelay()),
        ("capacity 30", syntax.Capacity(30)),
        ("max delay 0.5 s", syntax.MaxDelay(Time(ms(500)))),
        ("max delay oo", syntax.MaxDelay(syntax.Endless())),
        ("from 300 to 400", syntax.FromTo(Time(ms(300)), Time(ms(400)))),
        ("from 300 to oo", syntax.FromTo(Time(ms(300)), syntax.Endless())),
        ("from 300", syntax.FromTo(Time(ms(300)))),
        ("to 400", syntax.To(Time(ms(400)))),
        ("any order", syntax.AnyOrder()),
        ("monotone order", syntax.MonotoneOrder()),
        ("strict order", syntax.StrictOrder()),
    ],
)
def test_every_constraint_can_be_written(policy, constraint):
    """The five kinds of section 4.4.5, and those of states, in all their forms."""
    specification = parse_specification(f"stream s = f[o] with {policy}")

    (declaration,) = specification.declarations
    assert declaration.stream.constraints == (constraint,)


def test_commas_separate_constraints_streams_and_settings():
    """What follows a comma says what it separates."""
    text = "strmgen a = U(b with max delay 3, strict order, c with any change, max = 4, d = e)"

    (declaration,) = parse_specification(text).declarations

    process = declaration.process
    assert [len(stream.constraints) for stream in process.streams] == [2, 1]
    assert [setting.name for setting in process.settings] == ["max", "d"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("3", syntax.Number(3)),
        ("-2.5e3", syntax.Number(-2500.0)),
        ("100 ms", Time(ms(100))),
        ("1.5 s", Time(ms(1500))),
        ("vision", Name("vision")),
        ("true", syntax.Truth(value=True)),
        ('"a \\"b\\""', syntax.Text('a "b"')),
        ("[1, x]", syntax.Values((syntax.Number(1), Name("x")))),
        ("a/b c.kpl", syntax.Text("a/b c.kpl")),
        ("from", syntax.Text("from")),
    ],
)
def test_a_value_is_read_as_kpl_writes_it(text, expected):
    """What is no value of KPL is taken as a string."""
    assert parse_value(text) == expected


def test_the_places_of_formulas_are_places_of_the_specification():
    """Every node of a condition points into the text it was written in."""
    text = "strmgen b = link(a, U,\n  establish = p(from) and not q(from), reestablish = x,\n y)"

    (declaration,) = parse_specification(text, "f.kpl").declarations

    link = declaration.process
    for formula, _ in descendants(link.establish):
        assert formula.span.source.text == text
    q = link.establish.bodies[1].body
    assert text[q.span.start : q.span.end] == "q(from)"
    assert q.span.excerpt().startswith("  establish = p(from) and not q(from)")


@pytest.mark.parametrize("path", sorted(PROGRAMS.glob("*.ok")), ids=lambda path: path.stem)
def test_good_programs_have_no_faults(path):
    """Every program that is good parses and passes the checks."""
    assert faults(parse_specification(path.read_text(), path.name)) == []


@pytest.mark.parametrize("path", sorted(PROGRAMS.glob("*.bad")), ids=lambda path: path.stem)
def test_bad_programs_give_exactly_these_messages(path):
    """Every fault is reported with its place, in the words of the file beside it."""
    found = faults_of_text(path.read_text(), path.name)

    reports = "\n".join(fault.report() for fault in found)
    assert f"{reports}\n" == path.with_suffix(".err").read_text()


WORDS = """
all and as at before capacity common deviation each end failure for in latest linear load object on
period select stop under up updates where
"""


@pytest.mark.parametrize("word", WORDS.split())
def test_words_of_the_language_are_names_where_a_name_can_stand(word):
    """Of all words only those of the list of reserved ones are not."""
    text = f"""
    parameter {word} = {word}
    source {word} {word}
    compunit {word} {word}({word}, {word}, ...)
    strmgen {word} = {word} with sample every {word} on failure end
    strmgen {word}[{word}] = {word}({word}, {word} with any change, {word}, {word} = {word})
    strmgen f = select {word}, {word}.{word} as {word}%{word}% from {word} where {word} = {word}
    for each {word} in {word} {{ stream {word}[{word}] = merge({word} for each {word} in {word}) }}
    stream {word} = {word}
    stream g = sync({word} with max delay {word}, {word}, {word})
    """

    specification = parse_specification(text)

    assert len(specification.declarations) == 9
    assert parse_specification(text_from(specification)) == specification


def test_the_places_of_all_pieces_are_their_own():
    """Each piece of a block knows where it was written."""
    text = "for each m in ids {\n  strmgen a[m] = merge(b[m] for each k in ids)\n}"

    (block,) = parse_specification(text, "f").declarations

    assert block.span.place == "f:1:1"
    (generator,) = block.declarations
    assert generator.span.place == "f:2:3"
    assert generator.process.span.place == "f:2:18"
    assert generator.process.member.span.place == "f:2:38"
