"""What stream generators, and the streams between them, are called."""

from typing import NewType

__all__ = ["OUTPUT", "Label", "input_name", "output_name"]

Label = NewType("Label", str)
"""The name of a stream generator as KPL writes it, such as `cars` or `percepts[vision]`."""

OUTPUT = Label("output")
"""The receiver of a stream that leaves the network, where nobody says otherwise."""


def input_name(receiver: str, number: int) -> str:
    """Return what an input of a process is called, counted from 1, such as `cars/1`."""
    return f"{receiver}/{number}"


def output_name(name: str) -> str:
    """Return what a declared output is called among all streams, such as `output/cars`."""
    return f"{OUTPUT}/{name}"
