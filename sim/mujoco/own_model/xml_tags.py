"""The start tags of an XML text, and where they stand in it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from xml.parsers import expat

NESTED = 300
"""Elements within each other; MuJoCo's own reader calls itself for each."""
TAG = re.compile(rb"""<(?:[^<>"']|"[^"]*"|'[^']*')*>""")


class XmlError(Exception):
    """A text that is no XML, or more than is read of it; its text says why."""


@dataclass(frozen=True)
class Tag:
    """A start tag: the names of the elements around it and its own, outermost first, its
    attributes, and where it stands in the text [byte]."""

    path: tuple[str, ...]
    attributes: Mapping[str, str]
    start: int
    end: int


def tags(raw: bytes) -> list[Tag]:
    """The start tags in the order of the text; comments and the like have none.

    Raises
    ------
    XmlError
        No XML; entities, or elements that are nested deeper than `NESTED`.
    """
    parser, path, found = expat.ParserCreate(), [], []

    def begin(name: str, attributes: dict[str, str]) -> None:
        path.append(name)
        if len(path) > NESTED:
            raise XmlError(f"more than {NESTED} elements within each other")
        at = parser.CurrentByteIndex
        tag = TAG.match(raw, at)
        found.append(Tag(tuple(path), attributes, at, tag.end() if tag else at))

    def entity(*_: object) -> None:
        raise XmlError("it declares entities, which MJCF has none of")

    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda _: path.pop()
    parser.EntityDeclHandler = entity
    try:
        parser.Parse(raw, True)
    except (expat.ExpatError, ValueError, LookupError) as error:
        raise XmlError(f"no XML: {error}") from None
    return found
