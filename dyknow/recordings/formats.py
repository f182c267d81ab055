"""What a file says about itself: that it is a recording, of which format, and the texts in it."""

import json
import zlib
from collections.abc import Mapping

__all__ = [
    "FORMAT",
    "FORMAT_RECORD",
    "LOSSES_RECORD",
    "PROFILE",
    "TEXTS_RECORD",
    "checked_texts",
    "sealed_texts",
]

PROFILE = "dyknow"
"""What the header of a recording says it is."""

FORMAT = "1"
"""The format that is written and read."""

FORMAT_RECORD = "dyknow"
"""The name of the metadata record that tells the format, as `format`."""

TEXTS_RECORD = "recording"
"""The name of the metadata records with texts about the whole recording."""

LOSSES_RECORD = "recovered"
"""The name of the metadata record of a recording that was recovered, without what was lost."""

_CHECKSUM = "dyknow.crc32"


def sealed_texts(texts: Mapping[str, str]) -> dict[str, str]:
    """Return *texts* with a checksum, which MCAP has for chunks but not for metadata."""
    return {**texts, _CHECKSUM: _checksum(texts)}


def checked_texts(texts: Mapping[str, str]) -> dict[str, str]:
    """Return *texts* without their checksum.

    Raises:
        ValueError: They are not what was written.
    """
    own = {name: text for name, text in texts.items() if name != _CHECKSUM}
    if texts.get(_CHECKSUM) != _checksum(own):
        raise ValueError("its checksum is wrong")
    return own


def _checksum(texts: Mapping[str, str]) -> str:
    return f"{zlib.crc32(json.dumps(dict(texts), sort_keys=True).encode()):08x}"
