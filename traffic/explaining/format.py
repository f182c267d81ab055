"""What a run keeps to be explained: the files, their columns, and what describes them.

The folder `explanations` of a run holds `description.json` and one Parquet file for each of the
tables below. All times are nanoseconds; `docs/explaining.md` says what each column means.
"""

from typing import Any, Final

import pyarrow as pa
from pydantic import BaseModel, ConfigDict

__all__ = ["DESCRIPTION", "FOLDER", "FORMAT", "SCHEMAS", "VERSION", "Description"]

FOLDER: Final = "explanations"
DESCRIPTION: Final = "description.json"
FORMAT: Final = "traffic explanations"
VERSION: Final = 1

_NAME = pa.dictionary(pa.int32(), pa.string())
_TIME = pa.int64()
_NUMBER = pa.float32()
_INDEX = pa.int32()

SCHEMAS: Final = {
    "states": pa.schema(
        [
            ("stream", _NAME),
            ("valid_time", _TIME),
            ("id", pa.int64()),
            ("x", _NUMBER),
            ("y", _NUMBER),
            ("heading", _NUMBER),
            ("speed", _NUMBER),
            ("length", _NUMBER),
            ("width", _NUMBER),
            ("observed", pa.bool_()),
            ("observed_at", _TIME),
            ("lane", _INDEX),
            ("link", _INDEX),
            ("crossing", _INDEX),
            ("s", _NUMBER),
            ("d", _NUMBER),
        ]
    ),
    "percepts": pa.schema(
        [
            ("stream", _NAME),
            ("valid_time", _TIME),
            ("id", pa.int64()),
            ("x", _NUMBER),
            ("y", _NUMBER),
            ("length", _NUMBER),
            ("width", _NUMBER),
        ]
    ),
    "changes": pa.schema(
        [
            ("stream", _NAME),
            ("column", _NAME),
            ("valid_time", _TIME),
            ("available_time", _TIME),
            ("id", pa.int64()),
            ("first", pa.int64()),
            ("second", pa.int64()),
            ("before", _INDEX),
            ("after", _INDEX),
        ]
    ),
    "measures": pa.schema(
        [
            ("stream", _NAME),
            ("column", _NAME),
            ("valid_time", _TIME),
            ("id", pa.int64()),
            ("value", _NUMBER),
        ]
    ),
    "events": pa.schema(
        [
            ("stream", _NAME),
            ("valid_time", _TIME),
            ("available_time", _TIME),
            ("time", _TIME),
            ("attribute", _NAME),
            ("arguments", pa.list_(pa.string())),
            ("before", pa.string()),
            ("after", pa.string()),
        ]
    ),
    "recognitions": pa.schema(
        [
            ("stream", _NAME),
            ("valid_time", _TIME),
            ("available_time", _TIME),
            ("chronicle", _NAME),
            ("document", pa.string()),
        ]
    ),
    "links": pa.schema(
        [
            ("stream", _NAME),
            ("upper", pa.string()),
            ("lower", pa.string()),
            ("begin", _TIME),
            ("end", _TIME),
            ("made_by", _NAME),
            ("ended_by", _NAME),
        ]
    ),
    "images": pa.schema(
        [
            ("stream", _NAME),
            ("valid_time", _TIME),
            ("number", pa.int64()),
            ("digest", pa.uint32()),
        ]
    ),
}
"""The columns of each file, by its name without `.parquet`."""


class Description(BaseModel):
    """What the files of one run are about.

    Attributes:
        format: `FORMAT`.
        version: `VERSION`.
        network: What the network was made of (`dyknow.kpl.description.NetworkDescription`).
        sorts: The sort of the objects in each stream of tables that was kept, by its label.
        vocabularies: What the whole numbers in a column stand for, by the name of the column.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    format: str = FORMAT
    version: int = VERSION
    network: dict[str, Any]
    sorts: dict[str, str]
    vocabularies: dict[str, list[str]]
