"""What could have stood at the place of a syntax fault, in the words of a reader."""

from collections.abc import Collection, Mapping

__all__ = ["wording_of"]

_PHRASES = {
    "$END": "the end of the text",
    "AND_MORE": "', ...'",
    "COUNT": "a whole number",
    "EACH": "'each'",
    "FAILURE": "'end' or 'stop'",
    "FIELD": "a field",
    "FOR": "'for each'",
    "FORMULA": "a formula",
    "NAME": "a name",
    "NUMBER": "a number",
    "OBJECT": "'object'",
    "PATTERN": "a pattern",
    "SETTING": "a setting",
    "STRING": "a string",
    "TIME": "a time",
    "TIME_WITH_UNIT": "a time",
    "TRUTH": "'true' or 'false'",
    "ON": "'on failure'",
    "_COMMON_PERIOD": "'common period'",
    "_ESTABLISH": "'establish ='",
    "_MAINTAIN": "'maintain ='",
    "_REESTABLISH": "'reestablish ='",
    "_SELECT": "'select'",
    "_THEN_CONSTRAINT": "','",
    "_THEN_SETTING": "','",
}
"""What to call a terminal; others are called by their text."""

_GROUPS = {
    "a declaration": {"COMPUNIT", "FOR", "PARAMETER", "SOURCE", "STREAM", "STRMGEN"},
    "a declaration of a block": {"FOR", "STREAM", "STRMGEN"},
    "a constraint": {
        *("ALL", "ANY", "AT", "CAPACITY", "DELAY", "FROM", "MAX", "MONOTONE", "NO", "SAMPLE"),
        *("STRICT", "TO", "USE"),
    },
    "a value": {"LSQB", "NAME", "NUMBER", "STRING", "TIME_WITH_UNIT", "TRUTH"},
}
"""What to call terminals that can all stand at a place."""


def wording_of(terminals: Collection[str], texts: Mapping[str, str]) -> str:
    """Return the terminals as alternatives; *texts* has those that are always the same text."""
    left = set(terminals)
    phrases: set[str] = set()
    for phrase, group in _GROUPS.items():
        if group <= left:
            phrases.add(phrase)
            left -= group
    phrases |= {_PHRASES.get(name) or f"'{texts.get(name, name.lower())}'" for name in left}
    *others, last = sorted(phrases) or ["something else"]
    return f"{', '.join(others)} or {last}" if others else last
