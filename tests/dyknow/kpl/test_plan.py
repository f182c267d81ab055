"""From a specification to a network that runs."""

import pytest

from dyknow.errors import SpecificationErrors
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, build_network
from dyknow.kpl.syntax import Number, Setting, Time
from dyknow.mtl.printer import text_from_formula
from dyknow.streams.sample import Sample
from dyknow.time import Duration, seconds
from tests.support.streams import GivenSource, ms, text

TEXT = """
parameter which = fast
parameter period = 20
source n numbers
source n others
compunit n Scale(n)
compunit n Add(state(n, n))
compunit m Mark(n)
strmgen numbers = numbers
strmgen others = others
strmgen scaled[fast] = Scale(numbers, by = 2)
strmgen scaled[slow] = Scale(numbers with sample every period, by = 10)
strmgen sums = Add(sync(numbers, others))
strmgen marked = link(numbers, Mark, true, false, always n[from] > 3, wait = 2 s, words = [a, 3])
stream scaled = scaled[which] with from 0 to 40
stream sums = sums
stream marked = marked
"""


class Each:
    """Applies a function to each value of one input."""

    def __init__(self, function):
        self.function = function

    def push(self, now, inputs):
        """Emit the value of the function."""
        yield Sample(self.function(inputs[0].value), inputs[0].valid_time, now)

    def advance(self, now):
        """Emit nothing."""
        return ()

    def due(self):
        """Return no deadline."""


def scale(*, by: float):
    """Return a unit that multiplies."""
    if by == 0:
        raise ValueError("nothing is left when scaled by 0")
    return Each(lambda value: int(value) * by)


class Recorder:
    """Implementations that note what is made."""

    def __init__(self):
        self.made = []
        self.implementations = Implementations(
            sources={
                "numbers": self._noting("numbers", lambda: GivenSource("0:1 10:2 20:3 60:4")),
                "others": self._noting("others", lambda: GivenSource("0:5 20:6@25")),
            },
            units={"Scale": scale, "Add": lambda: Each("+".join)},
            link=self._link,
        )

    def _noting(self, name, make):
        def factory():
            self.made.append(name)
            return make()

        return factory

    def _link(self, unit, establish, reestablish, maintain, settings):
        formulas = map(text_from_formula, (establish, reestablish, maintain))
        self.made.append((unit, *formulas, dict(settings)))
        return Each(lambda value: f"{unit}{value}")


def _collected(network):
    collected = {name: [] for name in network.outputs}
    for name, samples in collected.items():
        network.subscribe(name, samples.append)
    network.kernel.run()
    return {name: text(samples) for name, samples in collected.items()}


def test_a_specification_becomes_a_network():
    """Sources, units with settings, synchronisations, links and policies are all connected."""
    recorder = Recorder()

    network = build_network(parse_specification(TEXT), recorder.implementations)

    assert _collected(network) == {
        "scaled": "0:2.0 10:4.0 20:6.0",
        "sums": "0:1+5 20:3+6@25",
        "marked": "0:Mark1 10:Mark2 20:Mark3 60:Mark4",
    }
    assert recorder.made[-1] == (
        "Mark",
        "true",
        "false",
        "always n(from) > 3",
        {"wait": 2 * ms(1000), "words": ("a", 3)},
    )


def test_only_what_the_wanted_outputs_need_is_made():
    """Sources and units that no wanted output depends on do not exist."""
    recorder = Recorder()

    network = build_network(
        parse_specification(TEXT), recorder.implementations, outputs=["scaled"]
    )

    assert recorder.made == ["numbers"]
    assert network.outputs == ("scaled",)
    assert network.kernel.labels == ("numbers", "scaled[fast]")


@pytest.mark.parametrize("period", [20, "20 ms", "0.02 s"])
def test_the_caller_chooses_the_values_of_parameters(period):
    """A number is in milliseconds where a time is meant; a string is read as KPL."""
    recorder = Recorder()
    parameters = {"which": "slow", "period": period}

    network = build_network(
        parse_specification(TEXT), recorder.implementations, parameters, outputs=["scaled"]
    )

    assert _collected(network) == {"scaled": "0:10.0 20:30.0"}


def test_a_generator_that_many_use_is_made_once():
    """Two streams of one generator, or of one synchronisation, share its process."""
    recorder = Recorder()
    extra = "strmgen more = Add(sync(numbers, others)) stream more = more"

    network = build_network(
        parse_specification(TEXT + extra), recorder.implementations, outputs=["sums", "more"]
    )

    assert recorder.made == ["numbers", "others"]
    assert list(network.kernel.labels).count("sync(numbers, others)") == 1


def _messages(text=TEXT, parameters=None, outputs=None, implementations=None):
    with pytest.raises(SpecificationErrors) as caught:
        build_network(
            parse_specification(text),
            implementations or Recorder().implementations,
            parameters,
            outputs,
        )
    return [fault.message for fault in caught.value.exceptions]


def test_all_that_is_wrong_is_said_at_once():
    """Faults of the caller and of the text are specification errors with places."""
    assert _messages(parameters={"witch": "fast"}) == [
        "no parameter called 'witch'; did you mean 'which'?"
    ]
    assert _messages(parameters={"which": "fats"}) == [
        "no stream generator called 'scaled[fats]'; did you mean 'scaled[fast]'?"
    ]
    assert _messages(outputs=["sum"]) == ["no output stream called 'sum'; did you mean 'sums'?"]
    assert _messages(TEXT.replace("by = 2", "bye = 2")) == [
        "'Scale' needs the setting 'by'",
        "no setting of 'Scale' called 'bye'; did you mean 'by'?",
    ]
    assert _messages(TEXT.replace("by = 2", "by = 0")) == ["nothing is left when scaled by 0"]
    assert _messages(implementations=Implementations()) == [
        "no implementation of a source called 'numbers'",
        "no implementation of a source called 'others'",
        "no implementation of a computational unit called 'Scale'",
        "no implementation of a computational unit called 'Add'",
        "nothing is there to make link processes",
    ]


def test_a_parameter_must_be_something_that_can_be_written():
    """An object of Python is no value of KPL."""
    with pytest.raises(TypeError, match="expected a number, a truth value or a string"):
        build_network(parse_specification(TEXT), Implementations(), {"which": object()})


def test_a_number_is_milliseconds_where_the_unit_wants_a_time():
    """The annotation of the factory decides."""
    given = []

    def make(*, wait: Duration, factor: float | None = None):
        given.append((wait, factor))
        return scale(by=1)

    text = "source n s compunit n U(n) strmgen a = s strmgen b = U(a, wait = 500, factor = 3)"
    implementations = Implementations({"s": lambda: GivenSource("")}, {"U": make})

    build_network(parse_specification(f"{text} stream b = b"), implementations)

    assert given == [(ms(500), 3)]


def test_a_unit_may_take_settings_as_they_are_written():
    """With their places: those that it does not name itself, whatever they are called."""
    found = {}

    def make(*, by: float, **others: Setting):
        found.update(others, by=by)
        return Each("".join)

    text = TEXT.replace("by = 2", "by = 2, wait = 3 s, others = 4")
    sources = Recorder().implementations.sources
    build_network(
        parse_specification(text), Implementations(sources, {"Scale": make}), outputs=["scaled"]
    )

    assert found["by"] == 2.0
    assert found["wait"].value == Time(seconds(3))
    assert found["others"].value == Number(4)
    assert found["wait"].span.place.startswith("<specification>:")


def test_an_output_must_be_declared():
    """Subscribing to what is no output is a mistake of the caller."""
    network = build_network(parse_specification(TEXT), Recorder().implementations)

    with pytest.raises(ValueError, match="no output stream called 'x'"):
        network.subscribe("x", print)
