"""The colours of vehicles, drawn about as often as they are seen on the road."""

import numpy as np
import numpy.typing as npt

__all__ = ["random_colours"]

_PAINTS = np.array(
    [
        (236, 236, 232),  # white
        (26, 27, 30),  # black
        (108, 110, 114),  # grey
        (184, 188, 192),  # silver
        (32, 66, 140),  # blue
        (172, 28, 30),  # red
        (28, 86, 56),  # green
        (104, 72, 48),  # brown
        (226, 182, 38),  # yellow
        (212, 98, 26),  # orange
    ]
)
_SHARES = np.array([0.2, 0.18, 0.14, 0.11, 0.12, 0.11, 0.04, 0.04, 0.03, 0.03])
_SPREAD = 14


def random_colours(generator: np.random.Generator, count: int) -> npt.NDArray[np.uint8]:
    """Return *count* colours, shape (count, 3), of usual paints, as red, green, blue."""
    paints = _PAINTS[generator.choice(len(_PAINTS), size=count, p=_SHARES / _SHARES.sum())]
    varied = paints + generator.integers(-_SPREAD, _SPREAD + 1, size=(count, 3))
    return np.clip(varied, 0, 255).astype(np.uint8)
