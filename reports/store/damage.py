"""What is wrong with a store, in words: which file, what it costs, and what mends it."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from models.errors import harmless
from reports.output.numbers import count

Cure = Literal["sweep", "wait", "nothing"]
BUSY = "a sweep is writing here: what it has finished is shown"
MOST = 20
"""Lines of a notice; more of them are counted."""
COMMANDS = 3


@dataclass(frozen=True)
class Damage:
    """One thing that is wrong with a store.

    ``path`` is that of the file or folder in the store. ``lost`` is how many cells are not to be
    read for it. ``cure`` is what mends it: the same sweep again, waiting for the sweep that writes
    it now, or nothing, since nothing is lost. ``aside`` is whether it stands in the way of the
    cure.
    """

    path: str
    what: str
    cure: Cure = "sweep"
    lost: int = 0
    aside: bool = False

    @property
    def line(self) -> str:
        """In a line: what is wrong with what, and how many cells that costs."""
        said = in_line(f"{self.path}: {self.what}")
        return f"{said}; {count(self.lost, 'cell')} missing" if self.lost else said


def in_line(text: str) -> str:
    """A text without characters that a terminal would obey, in one line."""
    return harmless(text).replace("\n", "\\n").replace("\t", "\\t")


def notice(
    folder: object, damage: Sequence[Damage], safe: int, runs: Sequence[object]
) -> list[str]:
    """The lines that name every damage of a store once; none where there is none. ``safe`` is how
    many cells can be read, of ``runs`` the commands mend it (see `command`)."""
    if not damage:
        return []
    bad = [each.line for each in damage if each.cure == "sweep"]
    other = [each.line for each in damage if each.cure == "nothing"]
    busy = f"{BUSY}; " * any(each.cure == "wait" for each in damage)
    lost = sum(each.lost for each in damage) or "none"
    whole = "not whole; " * bool(bad)
    head = f"{folder}: {busy}{whole}{count(safe, 'cell')} can be read, {lost} missing"
    if not bad:
        return [f"{head}; there is also", *indented(other)] if other else [head]
    cure = (
        f"what mends it: {command(folder, runs)}",
        f"(moves what is damaged to {folder}/damaged, and runs what is missing)",
    )
    return [head, *indented([*bad, *other]), *indented(cure)]


def command(folder: object, runs: Sequence[object]) -> str:
    """What was typed to fill a store, the last first, as far as its runs tell."""
    typed = [run.get("command") for run in reversed(runs) if isinstance(run, Mapping)]
    sweeps = dict.fromkeys(
        shlex.join(map(str, words))
        for words in typed
        if isinstance(words, list) and words[1:2] == ["sweep"]
    )
    usual = f"crankcheck sweep -o {shlex.quote(str(folder))}, with the options it was made with"
    return in_line("; ".join(list(sweeps)[:COMMANDS])) or usual


def indented(lines: Sequence[str]) -> list[str]:
    """Lines below a head, no more than anyone reads."""
    more = [f"  and {len(lines) - MOST} more"] if len(lines) > MOST else []
    return [*(f"  {line}" for line in lines[:MOST]), *more]
