"""`verify --mjcf`, and `check_model`: a model of the user's own, read, run as it is, and judged."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from numbers import Real
from os import PathLike
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import Progress

from models.errors import CrankcheckError
from models.files.assemble import scene_text
from reports.judge.known import known_file, known_of, marked, written_before
from reports.judge.rows import cell_frame, error_frame
from reports.judge.tolerance import parse
from reports.output.formats import csv, junit, parquet
from reports.output.printed import present
from reports.output.write import Outputs, check_file, provenance
from reports.own_model.account import read
from reports.own_model.assembly import ModelRequest
from reports.own_model.judged import JudgedModel, run_lines
from reports.own_model.table import document, is_diff, recommended_head, show, verdict_text
from reports.plan.steps import TURNS, positive
from reports.requests import arguments
from reports.requests.options import PRESCRIBED, VerifyOptions, given
from reports.requests.shown import Shown
from reports.verify.table import suite
from reports.workers.isolated import LIMIT_S, MEMORY_GB, checked_limits
from sim.registry import engine
from sim.registry.own_models import reading_engine

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ModelVerdict(Shown, JudgedModel):
    """Verdict on a model of your own.

    ``verdict`` is that on the model as written, "within", "out" or "unsupported"; ``findings`` are
    the answers of all rules on it, ``failures`` those that make the verdict; ``lines`` are as
    written, without each possible disturbance, and recommended; ``scene`` is the scene read from
    the model, and ``patch`` the recommended settings as a diff of the file. ``facts`` says where
    the numbers come from.
    """

    facts: Mapping[str, str]

    def frame(self) -> pd.DataFrame:
        """Table of errors: a row per line (``profile``), quantity, body, source and kind; ``unit``
        is that of ``maximum``, ``rms`` and ``final``."""
        return error_frame(self.lines)

    def show(self, console: Console) -> None:
        show(console, self, self.facts)

    def _drawn(self) -> str:
        """The mechanism over the time of the run, which may be less than a turn."""
        from reports.drawing.svg import svg

        return svg(self.scene, most_s=self.account.dt_s * self.account.steps)


@arguments.told_at_the_call
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
    """Run a MuJoCo model of your own as it is, and compare it with the closed form of its linkage,
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
        Reading of the driven joint at the start [rad], in place of ``key``.
    branch : Mapping or None
        The assembly, 1 or -1 by name, where the pose does not say it.
    dt_s, steps_per_turn : float or None
        The step; the model's own where neither is given.
    turns, tolerance, converge
        As in `check`.
    limit_s, memory_gb : float
        Limits of reading the model, and of each line, in a separate process.

    Raises
    ------
    CrankcheckError
        A file that can not be read, or is no planar linkage with one driver and a closed form; an
        invalid argument.
    """
    request = ModelRequest(
        path=arguments.path_of(model, "model"),
        joint=arguments.text_of(drive, "--drive", "crank"),
        speed_rad_s=_number(speed_rad_s, "--speed", "rad/s, such as 10"),
        key=None if key is None else arguments.text_of(key, "--key", "home"),
        start_deg=None if start_rad is None else math.degrees(_number(start_rad, "--start", "rad")),
        branch=_branch(branch),
        dt_s=dt_s,
        steps_per_turn=steps_per_turn,
        turns=turns,
        tolerance=arguments.tolerances_of(tolerance, "tolerance"),
        converge=arguments.is_true(converge, "converge"),
    )
    limits = checked_limits(
        positive("--limit-s", limit_s, "seconds"), positive("--memory-gb", memory_gb, "GB")
    )
    judged = run_lines(read(request, limits), limits)
    version = judged.own.version
    engines = {judged.own.cell.engine: version} if version else {}
    return ModelVerdict(account=judged.account, lines=judged.lines, facts=provenance(engines))


def _number(value: object, name: str, unit: str) -> float:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    raise arguments.wrong_kind(name, value, f"give a number, in {unit}")


def _branch(branch: object) -> dict[str, int]:
    """Assemblies by name. Raises CrankcheckError for anything but a mapping of names."""
    if branch is None:
        return {}
    if not isinstance(branch, Mapping):
        cure = "give a dict of names and 1 or -1, such as {'C': -1}"
        raise arguments.wrong_kind("--branch", branch, cure)
    return {arguments.text_of(name, "--branch", "C"): sign for name, sign in branch.items()}


IN_FOLDER = {
    "verify.csv": "--csv",
    "verify.json": "--json",
    "verify.junit.xml": "--junit",
    "errors.parquet": "",
    "scene.toml": "--write-scene",
    "recommended.diff": "",
    "recommended.txt": "",
    "page.html": "-o",
}
NOT_OF_MODELS = [
    *("scenes", "engines", "profiles", "jobs", "baseline"),
    *("factor", "forces", "free", "duration_s", "worlds"),
]
"""Fields that apply to scenes alone."""


def verify_model(request: VerifyOptions, console: Console, progress: Console) -> int:
    """Answer, and return the exit code: 0 within as written, 1 out, 2 not to be run. Raises
    CrankcheckError for a file that can not be read, or is no planar linkage with one driver, before
    anything is written."""
    asked = _asked(request)
    limits = checked_limits(request.limit_s, request.memory_gb)
    check_file(request.write_scene, "--write-scene", (".toml",))
    files = request.files | {"--write-scene": request.write_scene}
    outputs = Outputs(files, request.folder, IN_FOLDER)
    outputs.check([asked.path, request.known])
    failing, before = known_of(request.known), written_before(request.write_known)
    account = read(asked, limits)
    outputs.check(account.files)
    with Progress(console=progress, transient=True, disable=not progress.is_terminal) as bar:
        task = bar.add_task("running", total=len(account.profiles))
        judged = run_lines(account, limits, lambda _: bar.advance(task))
    judged = replace(judged, lines=marked(judged.lines, failing))
    name = reading_engine()
    facts = provenance({name: engine(name).version()})
    known = {"--write-known": lambda: known_file([judged.own], before)}
    with outputs.written(_contents(judged, facts) | known):
        title = f"verify: {verdict_text(judged)}"
        present(console, request.format, title, partial(show, judged=judged, facts=facts))
    mended = int(request.strict_known and bool(judged.own.mended))
    return {"within": mended, "known": mended, "out": 1}.get(judged.verdict, 2)


def _asked(request: VerifyOptions) -> ModelRequest:
    """The request for the model. Raises CrankcheckError for options that do not apply to it."""
    assert request.mjcf is not None
    for option in given(request, *NOT_OF_MODELS):
        raise CrankcheckError(f"--mjcf and {option}: a model of your own runs alone; leave out one")
    if request.speed_rad_s is None:
        raise CrankcheckError("--speed is missing: give that of the crank in rad/s, such as 10")
    return ModelRequest(
        path=request.mjcf,
        joint="" if request.drive == PRESCRIBED else request.drive,
        speed_rad_s=request.speed_rad_s,
        key=request.key,
        start_deg=request.start_deg,
        branch=_branch_of(request.branch),
        dt_s=request.dt_s,
        steps_per_turn=request.steps_per_turn,
        turns=TURNS if request.turns is None else request.turns,
        tolerance=parse(request.tolerance),
        converge=request.converge,
    )


def _branch_of(texts: Sequence[str]) -> dict[str, int]:
    branch = {}
    for text in texts:
        name, equals, sign = text.partition("=")
        if not equals or sign not in ("1", "+1", "-1"):
            raise CrankcheckError(f"--branch {text!r}: give NAME=1 or NAME=-1")
        branch[name] = int(sign)
    return branch


def _contents(
    judged: JudgedModel, facts: Mapping[str, str]
) -> dict[str, Callable[[], bytes | str]]:

    def page() -> str:
        from reports.page.model_page import model_page  # the drawings, which all else does without

        return model_page(judged, facts)

    return {
        "verify.csv": lambda: csv(cell_frame(judged.lines)),
        "verify.json": lambda: document(judged, facts),
        "verify.junit.xml": lambda: junit(suite(judged.lines, facts)),
        "errors.parquet": lambda: parquet(error_frame(judged.lines)),
        "scene.toml": lambda: scene_text(judged.scene),
        # Empty where there is none: one of an earlier run must not stay.
        "recommended.diff": lambda: judged.patch if is_diff(judged.patch) else "",
        "recommended.txt": lambda: f"{recommended_head(judged)}\n{judged.patch}",
        "page.html": page,
    }
