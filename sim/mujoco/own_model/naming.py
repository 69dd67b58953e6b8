"""Names of a scene from names of a model, which may hold anything."""

from __future__ import annotations

import re
from collections.abc import Container

MOST = 40
SEPARATORS = "./:"
"""What stands between the name of a body and that of a thing on it."""
REMARK = ": "


def scene_name(name: str, otherwise: str, taken: Container[str]) -> str:
    """A name that a scene may have, and that is not taken: the model's own as far as that goes."""
    plain = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-_")[:MOST]
    if not plain or not plain[0].isalpha():
        plain = f"{otherwise}{'-' if plain else ''}{plain}"[:MOST]
    unused, count = plain, 1
    while unused in taken:
        count += 1
        tail = f"-{count}"
        unused = plain[: MOST - len(tail)] + tail
    return unused


def point_of(name: str, bodies: Container[str]) -> str:
    """What a name says of a point: ``crank.B`` on body ``crank`` is ``B``, and a remark after a
    colon is left out."""
    point = name.partition(REMARK)[0] or name
    for at, sign in enumerate(point):
        if sign in SEPARATORS and point[:at] in bodies and point[at + 1 :]:
            return point[at + 1 :]
    return point
