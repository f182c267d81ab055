"""Tests of `dyknow.service.factory`."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import (
    LabelAlreadyExistsError,
    LabelInUseError,
    NoSuchLabelError,
    NoSuchPrototypeError,
    PolicyNotSupportedError,
    PrototypeAlreadyExistsError,
    WrongNumberOfInputsError,
)
from dyknow.runtime.generators import ANYTHING, Label
from dyknow.runtime.kernel import Kernel
from dyknow.service.factory import KnowledgeProcessFactory
from dyknow.service.prototypes import SourcePrototype, UnitPrototype
from dyknow.streams.policy import Policy, SampleEvery
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from tests.support.streams import GivenSource, ms

POS, SPEED = Label("pos[car1]"), Label("speed[car1]")


class Copy(Reactive):
    """Copies its first input."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Emit the first sample again, available now."""
        return [Sample(inputs[0].value, inputs[0].valid_time, now)]


def counting(policy: Policy) -> GivenSource:
    """Return a source of ten samples, as far apart as *policy* says."""
    period = policy.period or ms(100)
    if period < ms(10):
        raise ValueError("the sensor needs 10 ms for a measurement")
    times = [TimePoint(n * period) for n in range(10)]
    return GivenSource([Sample(n, time, time) for n, time in enumerate(times)])


@pytest.fixture
def factory() -> KnowledgeProcessFactory:
    """Return a factory with one source and one unit."""
    made = KnowledgeProcessFactory(Kernel())
    made.add_prototype(SourcePrototype(counting), "pos_car1", (), "pos")
    made.add_prototype(UnitPrototype(lambda _: Copy(), 2), "Sum", ("pos", "pos"), "pos")
    return made


def test_a_prototype_name_is_taken_once(factory: KnowledgeProcessFactory) -> None:
    """A second prototype of a name is refused, until the first is removed."""
    prototype = SourcePrototype(counting)
    with pytest.raises(PrototypeAlreadyExistsError, match="pos_car1"):
        factory.add_prototype(prototype, "pos_car1", (), "pos")
    factory.remove_prototype("pos_car1")
    factory.add_prototype(prototype, "pos_car1", (), "pos")
    assert factory.prototypes["pos_car1"].output_sort == "pos"


def test_sorts_must_be_as_many_as_inputs(factory: KnowledgeProcessFactory) -> None:
    """A prototype of two inputs is registered with two sorts."""
    with pytest.raises(WrongNumberOfInputsError, match="takes 2 input"):
        factory.add_prototype(UnitPrototype(lambda _: Copy(), 2), "Other", ("pos",), "pos")


def test_an_unknown_prototype_is_named_with_the_nearest(factory: KnowledgeProcessFactory) -> None:
    """The error says what may have been meant."""
    with pytest.raises(NoSuchPrototypeError, match="did you mean 'pos_car1'"):
        factory.create_knowledge_process(POS, "pos_car2")
    with pytest.raises(NoSuchPrototypeError):
        factory.remove_prototype("nothing")


def test_a_process_works_under_its_label() -> None:
    """What is created is part of the network, and its generator answers queries."""
    kernel = Kernel()
    factory = KnowledgeProcessFactory(kernel)
    factory.add_prototype(SourcePrototype(counting), "pos_car1", (), "pos")
    factory.add_prototype(UnitPrototype(lambda _: Copy(), 1), "Sum", ("pos",), "pos")
    factory.create_knowledge_process(POS, "pos_car1")
    made = factory.create_knowledge_process(SPEED, "Sum", [(POS, ANYTHING)])
    received: list[Sample[Any]] = []
    kernel.subscribe(SPEED, received.append)
    kernel.run()
    assert [sample.value for sample in received] == list(range(10))
    assert made.latest() == received[-1]


def test_a_label_is_taken_once(factory: KnowledgeProcessFactory) -> None:
    """A second process of a label is refused."""
    factory.create_knowledge_process(POS, "pos_car1")
    with pytest.raises(LabelAlreadyExistsError, match="pos"):
        factory.create_knowledge_process(POS, "pos_car1")


def test_the_number_of_inputs_must_fit(factory: KnowledgeProcessFactory) -> None:
    """Too few input streams are refused, and nothing is left of the attempt."""
    factory.create_knowledge_process(POS, "pos_car1")
    with pytest.raises(WrongNumberOfInputsError, match="'Sum' takes 2 input"):
        factory.create_knowledge_process(SPEED, "Sum", [(POS, ANYTHING)])
    assert SPEED not in factory.created


def test_an_output_policy_that_a_process_cannot_keep_is_refused(
    factory: KnowledgeProcessFactory,
) -> None:
    """What the maker objects to is passed on as the reason."""
    with pytest.raises(PolicyNotSupportedError, match="needs 10 ms for a measurement"):
        factory.create_knowledge_process(POS, "pos_car1", (), Policy(change=SampleEvery(ms(5))))


def test_an_input_policy_is_held_against_the_output_policy(
    factory: KnowledgeProcessFactory,
) -> None:
    """Out of a sample every 40 ms none every 100 ms can be picked, and nothing is left behind."""
    forty, hundred = Policy(change=SampleEvery(ms(40))), Policy(change=SampleEvery(ms(100)))
    factory.create_knowledge_process(POS, "pos_car1", (), forty)
    with pytest.raises(PolicyNotSupportedError):
        factory.create_knowledge_process(SPEED, "Sum", [(POS, hundred), (POS, ANYTHING)])
    factory.create_knowledge_process(SPEED, "Sum", [(POS, forty), (POS, ANYTHING)])


def test_only_what_was_made_here_is_destroyed_and_only_unused(
    factory: KnowledgeProcessFactory,
) -> None:
    """A process in use stays; what the factory has not made is not known to it."""
    factory.create_knowledge_process(POS, "pos_car1")
    factory.create_knowledge_process(SPEED, "Sum", [(POS, ANYTHING), (POS, ANYTHING)])
    with pytest.raises(LabelInUseError, match="speed"):
        factory.destroy_knowledge_process(POS)
    factory.destroy_knowledge_process(SPEED)
    factory.destroy_knowledge_process(POS)
    with pytest.raises(NoSuchLabelError):
        factory.destroy_knowledge_process(POS)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(st.tuples(st.booleans(), st.integers(0, 4)), max_size=25))
def test_labels_come_and_go_as_in_a_set(steps: list[tuple[bool, int]]) -> None:
    """Creating and destroying at random keeps to what a plain set of labels would do."""
    factory = KnowledgeProcessFactory(Kernel())
    factory.add_prototype(SourcePrototype(counting), "pos", (), "pos")
    there: set[Label] = set()
    for creates, number in steps:
        label = Label(f"pos[car{number}]")
        if creates and label not in there:
            factory.create_knowledge_process(label, "pos")
            there.add(label)
        elif creates:
            with pytest.raises(LabelAlreadyExistsError):
                factory.create_knowledge_process(label, "pos")
        elif label in there:
            factory.destroy_knowledge_process(label)
            there.remove(label)
        else:
            with pytest.raises(NoSuchLabelError):
                factory.destroy_knowledge_process(label)
        assert set(factory.created) == there
