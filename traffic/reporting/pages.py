"""Web pages of one file: style, scripts and data are part of it."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from pydantic_core import to_json

from traffic.errors import ResultError

__all__ = ["embedded", "render", "write_page"]

_TEMPLATES = Path(__file__).with_name("templates")


def render(template: str, values: Mapping[str, Any]) -> str:
    """Return the page that a template makes of *values*; what is not marked safe is escaped."""
    return _environment().get_template(template).render(values)


def embedded(data: object) -> Markup:
    """Return *data* as JSON that may stand inside of a script element, whatever texts it has."""
    text = to_json(data, inf_nan_mode="null").decode()
    for sign, code in (("<", "\\u003c"), (">", "\\u003e"), ("&", "\\u0026")):
        text = text.replace(sign, code)
    return Markup(text)


def write_page(page: str, path: Path) -> None:
    """Write a page to a new file, whole or not at all.

    Raises:
        ResultError: It cannot be written.
    """
    partial = path.with_name(f"{path.name}.partial")
    try:
        partial.write_text(page, encoding="utf-8")
        partial.replace(path)
    except OSError as error:
        raise ResultError(f"cannot write '{path}': {error.strerror}") from error
    finally:
        partial.unlink(missing_ok=True)


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals["asset"] = _asset
    return environment


def _asset(name: str) -> Markup:
    """Return a style sheet or a script, to be put into a page as it is."""
    return Markup((_TEMPLATES / name).read_text(encoding="utf-8"))
