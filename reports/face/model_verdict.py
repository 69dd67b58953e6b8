"""`check_model`: a model of your own, read, run as it is, and judged."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real
from os import PathLike
from typing import TYPE_CHECKING

from models.errors import CrankcheckError
from reports.face.arguments import is_true, kind_of, path_of, text_of, tolerances_of
from reports.face.shown import Shown
from reports.face.told import told_at_the_call
from reports.output.provenance import provenance
from reports.own_model.account import read, run_lines
from reports.own_model.judged import JudgedModel, judged_model
from reports.own_model.request import ModelRequest
from reports.plan.steps import positive
from reports.workers.isolated import LIMIT_S, MEMORY_GB, checked_limits

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ModelVerdict(Shown, JudgedModel):
    """A model of your own with what came of it.

    ``verdict`` is that on the model as written, "within", "out" or "unsupported", ``findings`` is
    what every rule says of that, and those of ``failures`` make the verdict; ``lines`` are as
    written, without each of what can disturb it, and recommended; ``scene`` is what it was read as,
    and ``patch`` the recommended settings as a diff of the file. ``facts`` says where the numbers
    come from.
    """

    facts: Mapping[str, str]

    def frame(self) -> pd.DataFrame:
        """One row per line (``profile``), quantity, body, source and kind of error; ``unit`` is
        that of ``maximum``, ``rms`` and ``final``."""
        from reports.judge.frames import error_frame

        return error_frame(self.lines)

    def show(self, console: Console) -> None:
        from reports.own_model.table import show

        show(console, self, self.facts)

    def _drawn(self) -> str:
        """Over what was run, as it may have no whole turn."""
        from reports.drawing.svg import svg

        return svg(self.scene, most_s=self.account.dt_s * self.account.steps)


@told_at_the_call
def check_model(
    model: str | PathLike[str],
    drive: str,
    speed_rad_s: float,
    *,
    key: str | None = None,
    start_rad: float | None = None,
    branch: Mapping[str, int] | None = None,
    dt_s: float | None = None,
    steps_per_turn: float | None = None,
    turns: float = 2.0,
    tolerance: Mapping[str, float] | None = None,
    converge: bool = True,
    limit_s: float = LIMIT_S,
    memory_gb: float = MEMORY_GB,
) -> ModelVerdict:
    """Run a MuJoCo model of your own as it is, and hold it to the closed form of the linkage in it,
    as `crankcheck verify --mjcf` does.

    Parameters
    ----------
    model : str or path
        An MJCF file.
    drive : str
        The hinge that drives it; it turns against the ground.
    speed_rad_s : float
        Its speed [rad/s]; below 0 it turns the other way.
    key : str or None
        The keyframe to start from; the pose as drawn for None.
    start_rad : float or None
        What the driven joint reads at the start [rad], in place of that.
    branch : Mapping or None
        The assembly, 1 or -1 by name, where the pose does not say it.
    dt_s, steps_per_turn : float or None
        The step; the model's own where neither is given.
    turns, tolerance, converge
        As of `check`.
    limit_s, memory_gb : float
        What reading it, and each line, may take, in a process apart.

    Raises
    ------
    CrankcheckError
        A file that can not be read, or is no planar linkage with one driver and a closed form; an
        argument that is none.
    """
    request = ModelRequest(
        path=path_of(model, "model"),
        joint=text_of(drive, "--drive", "crank"),
        speed_rad_s=_number(speed_rad_s, "--speed", "rad/s, such as 10"),
        key=None if key is None else text_of(key, "--key", "home"),
        start_deg=None if start_rad is None else math.degrees(_number(start_rad, "--start", "rad")),
        branch=_branch(branch),
        dt_s=dt_s,
        steps_per_turn=steps_per_turn,
        turns=turns,
        tolerance=tolerances_of(tolerance, "tolerance"),
        converge=is_true(converge, "converge"),
    )
    limits = checked_limits(
        positive("--limit-s", limit_s, "seconds"), positive("--memory-gb", memory_gb, "GB")
    )
    account = read(request, limits)
    judged = judged_model(account, run_lines(account, limits))
    version = judged.own.version
    engines = {judged.own.cell.engine: version} if version else {}
    return ModelVerdict(account=account, lines=judged.lines, facts=provenance(engines))


def _number(value: object, name: str, unit: str) -> float:
    """A number. Raises CrankcheckError that names its unit for anything else."""
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    raise CrankcheckError(f"{name}: found {kind_of(value)}; give a number, in {unit}")


def _branch(branch: object) -> dict[str, int]:
    """Assemblies by name. Raises CrankcheckError for no mapping of names."""
    if branch is None:
        return {}
    if not isinstance(branch, Mapping):
        raise CrankcheckError(
            f"--branch: found {kind_of(branch)}; give a dict of names and 1 or -1, such as "
            "{'C': -1}"
        )
    return {text_of(name, "--branch", "C"): sign for name, sign in branch.items()}
