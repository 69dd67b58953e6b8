"""crankcheck: which physics engine, with which settings, can you trust with a closed loop?

    verdict = crankcheck.check("fourbar-lecture-1", "mujoco")
    print(verdict)

The public face is ``__all__``, and `crankcheck.testing`: docs/python.md shows all of it; and
`crankcheck.engine`, for engines of your own: docs/how-to/add-an-engine.md. Every other module,
class and function is private, and may change from one version to the next without a word in
CHANGELOG.md.

It is the same in a checkout and where the wheel is installed. Importing it costs next to nothing: a
name is loaded when it is first used. Where the command begins, Ctrl-C is handled from here on.
"""

import sys


def _interrupted(*_: object) -> None:
    """End the process as the command does for Ctrl-C; there is nothing to undo yet."""
    import os

    os.write(2, b"crankcheck: interrupted\n")
    os._exit(130)


def _end_on_ctrl_c() -> None:
    """Let Ctrl-C end the process with one line, until `reports.workers.signals` takes it over."""
    try:
        import signal

        # One that is ignored stays ignored (nohup).
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, _interrupted)
    except KeyboardInterrupt:
        _interrupted()


def _is_command(program: str) -> bool:
    """True if the program is `crankcheck`, or `python -m crankcheck` is being looked up."""
    if program == "-m":
        return not {"crankcheck", "-mcrankcheck"}.isdisjoint(sys.orig_argv)
    return program.replace("\\", "/").rpartition("/")[2].removesuffix(".exe") == "crankcheck"


if _is_command((getattr(sys, "argv", None) or [""])[0]):
    _end_on_ctrl_c()
TYPE_CHECKING = False
"""The constant of `typing`, whose import would take longer than all else here."""

if TYPE_CHECKING:
    from models.errors import (
        CrankcheckError,
        EngineError,
        ReachError,
        SceneError,
        StructureError,
    )
    from models.files.reading import load_scene
    from models.motion import Forces, Motion, State
    from models.scene import Scene
    from reports.causes.cause import Cause
    from reports.compare.errors import Error, Errors
    from reports.judge.cell import Cell
    from reports.judge.rules.rule import Finding
    from reports.lectures.design.synth import Synthesis, synth
    from reports.lectures.machine.regulation import MachineCycle, MachineFlywheel, cycle, flywheel
    from reports.lectures.machine.sensitivity import SceneGradient, gradient
    from reports.requests.compare import CellVerdict, Comparison, check, compare
    from reports.requests.free_solution import ElasticSolution, FreeSolution
    from reports.requests.judge import LogVerdict, judge
    from reports.requests.report import report
    from reports.requests.run import Simulation, run
    from reports.requests.solution import Solution
    from reports.requests.solve import solve, solve_driven
    from reports.requests.sweep import Sweep, sweep
    from reports.requests.verify_model import ModelVerdict, check_model
    from sim.engine import Run

    __version__: str

__all__ = [
    "Cause",
    "Cell",
    "CellVerdict",
    "Comparison",
    "CrankcheckError",
    "ElasticSolution",
    "EngineError",
    "Error",
    "Errors",
    "Finding",
    "Forces",
    "FreeSolution",
    "LogVerdict",
    "MachineCycle",
    "MachineFlywheel",
    "ModelVerdict",
    "Motion",
    "ReachError",
    "Run",
    "Scene",
    "SceneError",
    "SceneGradient",
    "Simulation",
    "Solution",
    "State",
    "StructureError",
    "Sweep",
    "Synthesis",
    "__version__",
    "check",
    "check_model",
    "compare",
    "cycle",
    "flywheel",
    "gradient",
    "judge",
    "load_scene",
    "report",
    "run",
    "solve",
    "solve_driven",
    "sweep",
    "synth",
]


if not TYPE_CHECKING:  # a type checker refuses every other name

    def __getattr__(name: str) -> object:
        """Import and return the object of a public name."""
        match name:
            case "CrankcheckError" | "EngineError" | "ReachError" | "SceneError" | "StructureError":
                from models import errors as home
            case "load_scene":
                from models.files import reading as home
            case "Forces" | "Motion" | "State":
                from models import motion as home
            case "Scene":
                from models import scene as home
            case "Cause":
                from reports.causes import cause as home
            case "Error" | "Errors":
                from reports.compare import errors as home
            case "CellVerdict" | "check":
                from reports.requests import compare as home
            case "Comparison" | "compare":
                from reports.requests import compare as home
            case "ElasticSolution":
                from reports.requests import free_solution as home
            case "FreeSolution":
                from reports.requests import free_solution as home
            case "LogVerdict" | "judge":
                from reports.requests import judge as home
            case "ModelVerdict" | "check_model":
                from reports.requests import verify_model as home
            case "MachineCycle" | "MachineFlywheel" | "cycle" | "flywheel":
                from reports.lectures.machine import regulation as home
            case "SceneGradient" | "gradient":
                from reports.lectures.machine import sensitivity as home
            case "report":
                from reports.requests import report as home
            case "Simulation" | "run":
                from reports.requests import run as home
            case "Solution":
                from reports.requests import solution as home
            case "solve" | "solve_driven":
                from reports.requests import solve as home
            case "Sweep" | "sweep":
                from reports.requests import sweep as home
            case "Synthesis" | "synth":
                from reports.lectures.design import synth as home
            case "Cell":
                from reports.judge import cell as home
            case "Finding":
                from reports.judge.rules import rule as home
            case "Run":
                from sim import engine as home
            case "__version__":
                from reports.output.write import crankcheck_version

                return crankcheck_version()
            case _:
                raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(home, name)


def __dir__() -> list[str]:
    return __all__
