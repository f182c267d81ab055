"""What performances draw."""

from collections.abc import Mapping

import numpy as np

__all__ = ["drawn_type_name"]


def drawn_type_name(weights: Mapping[str, float], generator: np.random.Generator) -> str:
    """Return the name of one of the vehicle types."""
    shares = np.array(list(weights.values()))
    return str(generator.choice(list(weights), p=shares / shares.sum()))
