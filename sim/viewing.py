"""An engine's own window, for a person to look at a model."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from models.motion import State
from models.scene import Scene
from sim.registry import capability, offering

Viewer = Callable[[Scene, State], None]
"""Opens a scene, assembled at a state, in a window; returns when that is closed."""


def viewer() -> Viewer:
    """The viewer of the first engine that has one. Raises EngineError if it is not installed."""
    return cast(Viewer, capability(offering("viewer")[0], "viewer"))
