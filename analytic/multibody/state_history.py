"""What an integration gives: the state of an assembly over time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from analytic.multibody.singular_passage import SingularPassage
from models.array import Array


@dataclass(frozen=True)
class StateHistory:
    """The ``state`` at times [s], (2 n + 1, T); ``passages`` are the change points on the way."""

    state: Callable[[Array], Array]
    steps: int
    passages: tuple[SingularPassage, ...] = ()
