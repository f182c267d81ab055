"""Tests of `dyknow.service.manager`."""

import pytest

from dyknow.errors import LabelAlreadyExistsError, NoSuchLabelError
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.service.manager import StreamGeneratorManager
from tests.support.streams import GivenSource

POS, ALIAS = Label("pos[car1]"), Label("position[target]")


@pytest.fixture
def kernel() -> Kernel:
    """Return a kernel with one source."""
    made = Kernel()
    made.add_source(POS, GivenSource([]))
    return made


def test_generators_of_the_network_are_known(kernel: Kernel) -> None:
    """A process that joins later is found as well."""
    manager = StreamGeneratorManager(kernel)
    assert manager.get_stream_generator(POS) is kernel.generator(POS)
    kernel.add_source(Label("late"), GivenSource([]))
    assert manager.labels == (POS, "late")


def test_a_generator_may_have_further_labels(kernel: Kernel) -> None:
    """A label that is added stands for the same generator, until it is removed."""
    manager = StreamGeneratorManager(kernel)
    manager.add_stream_generator(ALIAS, kernel.generator(POS))
    assert manager.get_stream_generator(ALIAS) is kernel.generator(POS)
    manager.remove_stream_generator(ALIAS)
    with pytest.raises(NoSuchLabelError, match="position"):
        manager.get_stream_generator(ALIAS)


def test_a_label_stands_for_one_generator(kernel: Kernel) -> None:
    """A label that is taken, by the network or by addition, is refused."""
    manager = StreamGeneratorManager(kernel)
    manager.add_stream_generator(ALIAS, kernel.generator(POS))
    for label in (POS, ALIAS):
        with pytest.raises(LabelAlreadyExistsError):
            manager.add_stream_generator(label, kernel.generator(POS))


def test_removing_destroys_nothing(kernel: Kernel) -> None:
    """A generator whose label was removed can be added again; unknown labels are let pass."""
    manager = StreamGeneratorManager(kernel)
    generator = kernel.generator(POS)
    manager.remove_stream_generator(POS)
    manager.remove_stream_generator(POS)
    manager.remove_stream_generator(Label("nothing"))
    assert manager.labels == ()
    assert kernel.generator(POS) is generator
    manager.add_stream_generator(POS, generator)
    assert manager.get_stream_generator(POS) is generator


def test_a_new_process_of_a_removed_label_is_found(kernel: Kernel) -> None:
    """What was removed was the old generator, not the name for ever."""
    manager = StreamGeneratorManager(kernel)
    manager.remove_stream_generator(POS)
    kernel.remove(POS)
    kernel.add_source(POS, GivenSource([]))
    assert manager.get_stream_generator(POS) is kernel.generator(POS)
