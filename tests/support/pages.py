"""Pages of the documentation, whose examples are tested."""

import re

__all__ = ["blocks_in"]


def blocks_in(page: str, language: str) -> list[str]:
    """Return the examples in a language, in reading order."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
