"""crankcheck: which physics engine, with which settings, can you trust with a closed loop?

The public face, the same in a checkout and where the wheel is installed. Importing it costs next to
nothing: what stands behind a name is loaded when the name is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from analytic.kinematics import solve, solve_driven
    from models.errors import (
        CrankcheckError,
        EngineError,
        ReachError,
        SceneError,
        StructureError,
    )
    from models.files import load_scene
    from models.motion import Motion, State
    from models.scene import Scene
    from reports.judge.cell import Cell, Checked, check
    from sim.engine import Run
    from sim.run import run

    __version__: str

__all__ = [
    "Cell",
    "Checked",
    "CrankcheckError",
    "EngineError",
    "Motion",
    "ReachError",
    "Run",
    "Scene",
    "SceneError",
    "State",
    "StructureError",
    "__version__",
    "check",
    "load_scene",
    "run",
    "solve",
    "solve_driven",
]


if not TYPE_CHECKING:  # a type checker refuses every other name

    def __getattr__(name: str) -> object:
        """What stands behind a name, imported now."""
        match name:
            case "solve" | "solve_driven":
                from analytic import kinematics as home
            case "CrankcheckError" | "EngineError" | "ReachError" | "SceneError" | "StructureError":
                from models import errors as home
            case "load_scene":
                from models import files as home
            case "Motion" | "State":
                from models import motion as home
            case "Scene":
                from models import scene as home
            case "Cell" | "Checked" | "check":
                from reports.judge import cell as home
            case "Run":
                from sim import engine as home
            case "run":
                from sim import run as home
            case "__version__":
                from reports.output.provenance import crankcheck_version

                return crankcheck_version()
            case _:
                raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(home, name)


def __dir__() -> list[str]:
    return __all__
