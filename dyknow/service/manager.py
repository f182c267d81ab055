"""The stream generator manager: which stream generator a label stands for.

The interface is that of Heintz (2009), section 5.4.2.
"""

from dyknow.errors import LabelAlreadyExistsError, NoSuchLabelError
from dyknow.runtime.generators import Label, StreamGenerator
from dyknow.runtime.kernel import Kernel
from dyknow.source_text import nearest_name

__all__ = ["StreamGeneratorManager"]


class StreamGeneratorManager:
    """Keeps track of stream generators and their labels.

    The generators of the network are there under their own labels without being added. A
    generator may be added under further labels, so that clients need not know which process
    provides what they ask for.
    """

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._added: dict[Label, StreamGenerator] = {}
        self._withdrawn: dict[Label, StreamGenerator] = {}

    @property
    def labels(self) -> tuple[Label, ...]:
        """All labels that stand for a stream generator."""
        own = (label for label in self._kernel.labels if not self._is_withdrawn(label))
        return (*own, *self._added)

    def add_stream_generator(self, label: Label, generator: StreamGenerator) -> None:
        """Let *label* stand for *generator*.

        Raises:
            LabelAlreadyExistsError: It stands for a generator already.
        """
        if self._find(label) is not None:
            raise LabelAlreadyExistsError(label)
        self._withdrawn.pop(label, None)
        if self._own(label) is not generator:
            self._added[label] = generator

    def remove_stream_generator(self, label: Label) -> None:
        """Let *label* stand for nothing; the generator itself goes on, and so do its streams."""
        if self._added.pop(label, None) is None and (own := self._own(label)) is not None:
            self._withdrawn[label] = own

    def get_stream_generator(self, label: Label) -> StreamGenerator:
        """Return the stream generator that *label* stands for.

        Raises:
            NoSuchLabelError: It stands for none.
        """
        generator = self._find(label)
        if generator is None:
            raise NoSuchLabelError(label, nearest_name(label, self.labels))
        return generator

    def _find(self, label: Label) -> StreamGenerator | None:
        return self._added.get(label) or (None if self._is_withdrawn(label) else self._own(label))

    def _own(self, label: Label) -> StreamGenerator | None:
        process = self._kernel.processes.get(label)
        return None if process is None else process.generator

    def _is_withdrawn(self, label: Label) -> bool:
        """Return whether the label was removed; a new process of that name is a new generator."""
        return label in self._withdrawn and self._withdrawn[label] is self._own(label)
