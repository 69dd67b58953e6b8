"""How docstrings are read for the references: an extension of griffe.

Several parameters told in one entry, ``scene, engine, profile``, are told each by itself: griffe
would give all of them the type and the default of the first.
"""

from __future__ import annotations

import re
from typing import Any

from griffe import Extension, Function

SEVERAL = re.compile(r"^(\w+(?:, \w+)+)\n((?:[ ]{4}.*\n?)+)", re.MULTILINE)


class OneByOne(Extension):
    """Takes entries of several names apart."""

    def on_function(self, *, func: Function, **_: Any) -> None:
        """Called for each function that is read."""
        if func.docstring is not None:
            func.docstring.value = one_by_one(func.docstring.value)


def one_by_one(text: str) -> str:
    """The docstring with an entry for each name."""
    return SEVERAL.sub(
        lambda entry: "".join(f"{name}\n{entry[2].rstrip()}\n" for name in entry[1].split(", ")),
        text,
    )
