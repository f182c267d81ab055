"""What the streams of the application hold besides numbers, texts and tables."""

from chronicles.events import Event, Recognition
from dyknow.recordings.codecs import Codec, DataclassCodec
from perception.camera import Calibration, Camera

__all__ = ["CODECS"]

CODECS: tuple[Codec, ...] = tuple(
    DataclassCodec(kind) for kind in (Event, Recognition, Camera, Calibration)
)
"""For every class of values in `data/specifications/monitoring.kpl`."""
