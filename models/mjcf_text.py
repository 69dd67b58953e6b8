"""Elements and comments of the MJCF text."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

from models.mjcf_options import Attributes, AttributeValue

AttributeRow = dict[str, AttributeValue]


def attributes(row: Attributes) -> str:
    """Attributes of an element; numbers in the shortest form that reads back as the same double."""
    return "".join(f" {name}={quoteattr(_text(value))}" for name, value in row.items())


def _text(value: AttributeValue) -> str:
    """A value as MJCF text."""
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return repr(value if isinstance(value, int) else float(value) + 0.0)
    return " ".join(_text(number) for number in value)


def commentable(text: str) -> str:
    """Text that may stand in an XML comment, where two hyphens would end it."""
    return text.replace("--", "- -").replace("--", "- -")
