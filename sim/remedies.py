"""What is worth a try where an engine is out of tolerance, at the step that it has."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import cast

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.registry import capability, declaration

Remedies = Callable[[Scene, State, Settings], Sequence[Settings]]
"""Settings to put in the place of some of a complete set that failed, for a scene that is assembled
at a state; those that cost least first."""


def remedies(engine: str, scene: Scene, state: State, settings: Settings) -> Sequence[Settings]:
    """Those of an engine; none where it offers none. Raises EngineError as `capability` does."""
    if "remedies" not in declaration(engine).offers:
        return ()
    return cast(Remedies, capability(engine, "remedies"))(scene, state, settings)
