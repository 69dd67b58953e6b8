"""The runs that faults of a kind are planted in, and the faults of a way."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

from models.scene import Scene
from reports.judge.cell import Cell
from reports.selftest.fault import FOURBAR, Fault, RunKind
from reports.selftest.unseen import Unseen

STEPS = 360
"""Steps of a turn, or of a run that is a turn's."""


@dataclass(frozen=True, eq=False)
class FaultRuns:
    """How the runs of a kind are made and shown.

    ``groups`` are the headings of its faults, by group. ``cell`` gives the run of a scene in an
    engine, with so many steps in a turn where that is `STEPS`, and halved steps compared or not.
    ``words`` says how long the runs of some scenes are, ``settings`` the same as numbers.
    ``unseen`` need not be seen in the scene ``unseen_in``. Faults of the kinds ``also`` are asked
    for with it.
    """

    groups: Mapping[str, str]
    cell: Callable[[Scene, str, int, bool], Cell]
    words: Callable[[Collection[str]], Sequence[str]]
    settings: Mapping[str, object]
    unseen_in: str = FOURBAR
    unseen: Sequence[Unseen] = ()
    also: Sequence[RunKind] = ()


@dataclass(frozen=True, eq=False)
class FaultSet:
    """The faults of a way, in the order of the table, and their runs by kind."""

    faults: Sequence[Fault]
    runs: Mapping[RunKind, FaultRuns]
