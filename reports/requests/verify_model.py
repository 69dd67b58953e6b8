"""`crankcheck verify --mjcf`: read a model of the user's own, run it in its lines, show, write."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from models.errors import CrankcheckError
from models.scene_text import scene_text
from reports.judge.frames import cell_frame, error_frame
from reports.judge.tolerance import parse
from reports.output.frame_file import csv, parquet
from reports.output.junit import junit
from reports.output.provenance import provenance
from reports.output.write import check_file, check_outputs, write
from reports.own_model.account import read
from reports.own_model.document import document
from reports.own_model.judged import JudgedModel
from reports.own_model.request import ModelRequest
from reports.own_model.running import run_lines
from reports.own_model.sentences import is_diff, recommended_head
from reports.own_model.table import show
from reports.plan.steps import TURNS
from reports.requests.verify_options import PRESCRIBED, VerifyOptions
from reports.verify.junit import suite
from reports.workers.isolated import checked_limits
from sim.own_models import reading_engine
from sim.registry import engine

IN_FOLDER = (
    "verify.csv",
    "verify.json",
    "verify.junit.xml",
    "errors.parquet",
    "scene.toml",
    "recommended.diff",
    "recommended.txt",
    "page.html",
)
NOT_OF_MODELS = {
    "scenes": "SCENE",
    "engines": "--engine",
    "profiles": "--profile",
    "jobs": "--jobs",
    "baseline": "--baseline",
    "factor": "--factor",
    "forces": "--forces",
    "free": "--free",
    "duration_s": "--duration",
}
"""What is asked of scenes alone, by the field of the request."""


def verify_model(request: VerifyOptions, console: Console, progress: Console) -> int:
    """Do it; returns the exit code: 0 within as written, 1 out, 2 not to be run. Raises
    CrankcheckError for what can not be read, or is no planar linkage with one driver, before
    anything is written."""
    asked = _asked(request)
    limits = checked_limits(request.limit_s, request.memory_gb)
    _check_outputs(request, [asked.path])
    account = read(asked, limits)
    _check_outputs(request, account.files)
    with Progress(console=progress, transient=True, disable=not progress.is_terminal) as bar:
        task = bar.add_task("running", total=len(account.profiles))
        judged = run_lines(account, limits, lambda _: bar.advance(task))
    name = reading_engine()
    facts = provenance({name: engine(name).version()})
    try:
        _write(request, judged, facts)
    finally:  # a full disk costs the file, and not the verdict with it
        show(console, judged, facts)
    return {"within": 0, "out": 1}.get(judged.verdict, 2)


def _check_outputs(request: VerifyOptions, inputs: Sequence[Path]) -> None:
    """Refuse outputs that can not be written, or that are read. Raises CrankcheckError."""
    files = {
        "--junit": request.junit,
        "--csv": request.csv,
        "--json": request.json,
        "--write-scene": request.write_scene,
    }
    if request.write_scene is not None:
        check_file(request.write_scene, "--write-scene", (".toml",))
    check_outputs(files, request.folder, IN_FOLDER, inputs=inputs)


def _asked(request: VerifyOptions) -> ModelRequest:
    """What the model is asked for. Raises CrankcheckError for what does not go with it."""
    assert request.mjcf is not None
    for name, option in NOT_OF_MODELS.items():
        if getattr(request, name) != getattr(VerifyOptions(), name):
            raise CrankcheckError(
                f"--mjcf and {option}: a model of your own runs by itself, as it is; leave out one"
            )
    if request.speed_rad_s is None:
        raise CrankcheckError("--speed is missing: give that of the crank in rad/s, such as 10")
    return ModelRequest(
        path=request.mjcf,
        joint="" if request.drive == PRESCRIBED else request.drive,
        speed_rad_s=request.speed_rad_s,
        key=request.key,
        start_deg=request.start_deg,
        branch=_branch(request.branch),
        dt_s=request.dt_s,
        steps_per_turn=request.steps_per_turn,
        turns=TURNS if request.turns is None else request.turns,
        tolerance=parse(request.tolerance),
        converge=request.converge,
    )


def _branch(texts: Sequence[str]) -> dict[str, int]:
    """NAME=1 or NAME=-1, each."""
    branch = {}
    for text in texts:
        name, equals, sign = text.partition("=")
        if not equals or sign not in ("1", "+1", "-1"):
            raise CrankcheckError(f"--branch {text!r}: give NAME=1 or NAME=-1")
        branch[name] = int(sign)
    return branch


def _write(request: VerifyOptions, judged: JudgedModel, facts: Mapping[str, str]) -> None:
    """Every output that was asked for, each whole or not at all."""
    named: dict[str, Path | None] = {
        "verify.csv": request.csv,
        "verify.json": request.json,
        "verify.junit.xml": request.junit,
        "scene.toml": request.write_scene,
    }
    for name in IN_FOLDER:
        targets = [*filter(None, (named.get(name), request.folder and request.folder / name))]
        content = _content(name, judged, facts) if targets else ""
        for target in targets:
            write(target, content)


def _content(name: str, judged: JudgedModel, facts: Mapping[str, str]) -> str | bytes:
    """What stands in one output."""
    match name:
        case "verify.csv":
            return csv(cell_frame(judged.lines))
        case "verify.json":
            return document(judged, facts)
        case "verify.junit.xml":
            return junit(suite(judged.lines, facts))
        case "errors.parquet":
            return parquet(error_frame(judged.lines))
        case "scene.toml":
            return scene_text(judged.scene)
        case "recommended.diff":  # empty where there is none: one of an earlier run must not stay
            return judged.patch if is_diff(judged.patch) else ""
        case "recommended.txt":
            return f"{recommended_head(judged)}\n{judged.patch}"
        case _:
            # It brings the drawings, which nothing else here needs.
            from reports.page.model_page import model_page

            return model_page(judged, facts)
