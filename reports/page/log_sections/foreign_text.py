"""Text of a user's file as it may stand in a page: short, and nothing in it that acts unseen."""

from __future__ import annotations

import json

from models.errors import cut, harmless

LONGEST = 80
"""Characters of a name, whatever a header holds."""
LONGEST_SENTENCE = 2_000


def name_text(text: str, most: int = LONGEST) -> str:
    """A name on one line: ``\\u202e`` and the like, which turn round what follows, as escapes."""
    return cut(" ".join(harmless(text).split()), most)


def sentence_text(text: str) -> str:
    """A sentence that such a name may stand in."""
    return name_text(text, LONGEST_SENTENCE)


def toml_text(value: object) -> str:
    """A value as TOML, to be copied: exact, and what is not seen as its number."""
    if not isinstance(value, str):
        return json.dumps(value)
    quoted = json.dumps(value, ensure_ascii=False)
    return "".join(each if each.isprintable() else _escape(each) for each in quoted)


def _escape(character: str) -> str:
    number = ord(character)
    return f"\\u{number:04x}" if number < 0x10000 else f"\\U{number:08x}"
