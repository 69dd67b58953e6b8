"""A clause of the contract: what an engine has to do, why, how to mend it, and how to see it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from reports.contract.subject import Subject

Check = Callable[[Subject], Iterator[str]]
"""Yields what is wrong, in words and numbers: nothing where the clause is held. Raises
NotTriedError where there is nothing to look at."""


@dataclass(frozen=True)
class Clause:
    """One thing that every engine has to do.

    ``title`` says what, ``why`` what goes wrong otherwise, ``cure`` what to look at. A clause that
    is not ``of_scenes`` is put to the first scene alone that it can be put to.
    """

    id: str
    title: str
    why: str
    cure: str
    check: Check
    of_scenes: bool = True
