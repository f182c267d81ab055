"""Where vehicles truly are, for tests that mind only some of it."""

from typing import Any

import numpy as np

from traffic.truth.places import TruePlaces


def true_places(n: int, **columns: Any) -> TruePlaces:
    """Return places of *n* vehicles: nowhere, but for what the columns say."""
    nowhere = {name: np.full(n, -1, dtype=np.int32) for name in ("link", "crossing", "road")}
    unknown = {name: np.full(n, np.nan) for name in ("progress", "s", "d")}
    return TruePlaces(**{"direction": np.ones(n), **nowhere, **unknown, **columns})
