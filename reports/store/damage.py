"""What is wrong with a store, in words: which file, what it costs, and what mends it."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from models.errors import harmless
from reports.store.manifest import Manifest

Cure = Literal["sweep", "version", "wait", "nothing"]
BUSY = "a sweep is writing here: what it has finished is shown"
MOST = 20
"""Lines of a notice; more of them are counted."""
COMMANDS = 3


@dataclass(frozen=True)
class Damage:
    """One thing that is wrong with a store.

    ``path`` is that of the file or folder in the store. ``lost`` is how many cells are not to be
    read for it, None where that can not be told; with ``hides`` a cell may be among them that one
    asks for, or be called otherwise. ``cure`` is what mends it: the same sweep again, a version of
    crankcheck that reads it, waiting for the sweep that writes it now, or nothing, since nothing is
    lost. ``aside`` are the files that stand in the way of the cure.
    """

    path: str
    what: str
    cure: Cure = "sweep"
    lost: int | None = 0
    hides: bool = False
    aside: tuple[str, ...] = ()

    @property
    def line(self) -> str:
        """In a line: what is wrong with what, and how many cells that costs."""
        said = in_line(f"{self.path}: {self.what}")
        if not self.hides or self.lost == 0:
            return said
        many = "an unknown number of cells" if self.lost is None else counted(self.lost)
        return f"{said}; {many} missing"


def in_line(text: str) -> str:
    """A text without characters that a terminal would obey, in one line."""
    return harmless(text).replace("\n", "\\n").replace("\t", "\\t")


def counted(number: int) -> str:
    """A number of cells."""
    return f"{number} cell{'s' * (number != 1)}"


def safe_and_lost(damage: Sequence[Damage], safe: int) -> str:
    """How many cells can be read, and how many can not, as far as that is known."""
    known = sum(each.lost or 0 for each in damage)
    unknown = any(each.lost is None for each in damage)
    lost = f"at least {known}" if unknown and known else "an unknown number" if unknown else known
    return f"{counted(safe)} can be read, {lost or 'none'} missing"


def notice(folder: object, damage: Sequence[Damage], safe: int, manifest: Manifest) -> list[str]:
    """The lines that name every damage of a store once; none where there is none."""
    if not damage:
        return []
    bad = [each for each in damage if each.cure not in ("wait", "nothing")]
    named = [each.line for each in (*bad, *(one for one in damage if one.cure == "nothing"))]
    busy = f"{BUSY}; " * any(each.cure == "wait" for each in damage)
    head = f"{folder}: {busy}{'not whole; ' * bool(bad)}{safe_and_lost(damage, safe)}"
    if not bad:
        return [f"{head}; there is also", *indented(named)] if named else [head]
    lines = [head, *indented(named)]
    return [*lines, *indented(cures(folder, bad, manifest))]


def cures(folder: object, damage: Sequence[Damage], manifest: Manifest) -> list[str]:
    """What to do about it."""
    if any(each.cure == "version" for each in damage):
        return [
            "what works: the crankcheck that wrote it, or `crankcheck sweep` into a new folder; "
            "a sweep into this one is refused"
        ]
    typed = [run.get("command") for run in reversed(manifest.runs)]
    found = dict.fromkeys(
        shlex.join(map(str, words))
        for words in typed
        if isinstance(words, list) and words[1:2] == ["sweep"]
    )
    usual = f"crankcheck sweep -o {shlex.quote(str(folder))}, with the options it was made with"
    again = in_line("; ".join(list(found)[:COMMANDS])) or usual
    return [
        f"what mends it: {again}",
        f"(moves what is damaged to {folder}/damaged, and runs what is missing)",
    ]


def indented(lines: Sequence[str]) -> list[str]:
    """Lines below a head, no more than anyone reads."""
    more = [f"  and {len(lines) - MOST} more"] if len(lines) > MOST else []
    return [*(f"  {line}" for line in lines[:MOST]), *more]
