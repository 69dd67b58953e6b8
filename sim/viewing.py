"""An engine's own window, for a person to look at a model."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.registry import capability, offering

Viewer = Callable[[Scene, State], None]
"""Opens a scene, assembled at a state, in a window; returns when that is closed."""


def viewer() -> Viewer:
    """The viewer of the first engine that has one and is installed. Raises EngineError where
    there is none: the message is that of the last one."""
    missing = EngineError("no engine has a window of its own")
    for name in offering("viewer"):
        try:
            return cast(Viewer, capability(name, "viewer"))
        except EngineError as error:
            missing = error
    raise missing
