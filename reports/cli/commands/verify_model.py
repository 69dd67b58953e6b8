"""`crankcheck verify --mjcf`: read a model of the user's own, run it in its lines, show, write."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from models.errors import CrankcheckError
from models.scene_text import scene_text
from reports.cli.checking import PRESCRIBED, VerifyRequest
from reports.judge.cell import Checked
from reports.judge.frames import cell_frame, error_frame
from reports.judge.rows import cell_row
from reports.judge.tolerance import parse
from reports.output.frame_file import csv, parquet
from reports.output.junit import junit
from reports.output.numbers import finite
from reports.output.provenance import provenance
from reports.output.write import check_outputs, write
from reports.own_model.account import Account, read, run_lines
from reports.own_model.request import ModelRequest
from reports.own_model.table import show
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
)


def verify_model(request: VerifyRequest, console: Console, progress: Console) -> int:
    """Do it; returns the exit code: 0 within as written, 1 out. Raises CrankcheckError for what can
    not be read, or is no planar linkage with one driver, before anything is written."""
    asked = _asked(request)
    limits = checked_limits(request.limit_s, request.memory_gb)
    files = {
        "--junit": request.junit,
        "--csv": request.csv,
        "--json": request.json,
        "--write-scene": request.write_scene,
    }
    check_outputs(files, request.folder, IN_FOLDER, inputs=[asked.path])
    account = read(asked, limits)
    with Progress(console=progress, transient=True, disable=not progress.is_terminal) as bar:
        task = bar.add_task("running", total=len(account.profiles))
        checked = run_lines(account, limits, lambda _: bar.advance(task))
    name = reading_engine()
    facts = provenance({name: engine(name).version()})
    try:
        _write(request, account, checked, facts)
    finally:  # a full disk costs the file, and not the verdict with it
        show(console, account, checked, facts)
    return int(checked[0].verdict != "within")


def _asked(request: VerifyRequest) -> ModelRequest:
    """What the model is asked for. Raises CrankcheckError for what does not go with it."""
    assert request.mjcf is not None
    others = {
        "SCENE": request.scenes,
        "--engine": request.engines,
        "--profile": request.profiles,
        "--baseline": request.baseline,
    }
    for name, given in others.items():
        if given:
            raise CrankcheckError(
                f"--mjcf and {name}: a model of your own runs as it is; leave one"
            )
    if request.speed_rad_s is None or not abs(request.speed_rad_s) > 0.0:
        raise CrankcheckError("--mjcf: --speed is missing; give the crank's in rad/s, such as 10")
    return ModelRequest(
        path=request.mjcf,
        joint="" if request.drive == PRESCRIBED else request.drive,
        speed_rad_s=request.speed_rad_s,
        key=request.key,
        start_deg=request.start_deg,
        branch=_branch(request.branch),
        dt_s=request.dt_s,
        turns=request.turns,
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


def _write(
    request: VerifyRequest,
    account: Account,
    checked: Sequence[Checked],
    facts: Mapping[str, str],
) -> None:
    """Every output that was asked for, each whole or not at all."""
    contents: dict[str, str | bytes] = {
        "verify.csv": csv(cell_frame(checked)),
        "verify.json": _json(account, checked, facts),
        "verify.junit.xml": junit(suite(checked, facts)),
        "errors.parquet": parquet(error_frame(checked)),
        "scene.toml": scene_text(account.scene),
        "recommended.diff": account.patch,
    }
    named: dict[str, Path | None] = {
        "verify.csv": request.csv,
        "verify.json": request.json,
        "verify.junit.xml": request.junit,
        "scene.toml": request.write_scene,
    }
    for name, content in contents.items():
        for target in filter(None, (named.get(name), request.folder and request.folder / name)):
            write(target, content)


def _json(account: Account, checked: Sequence[Checked], facts: Mapping[str, str]) -> str:
    """Facts, what was read, and the lines with their findings; what is not finite is null."""
    document = {
        "provenance": dict(facts),
        "model": {
            "file": str(account.request.path),
            "driven": account.request.joint,
            "scene": scene_text(account.scene),
            "open_m": dict(account.open_m),
            "notes": list(account.notes),
            "disturbances": list(account.disturbances),
            "recommended": account.patch,
        },
        "cells": [
            cell_row(one)
            | {
                "settings": dict(one.settings),
                "notes": list(one.errors.notes) if one.errors else [],
                "findings": [vars(finding) for finding in one.findings],
            }
            for one in checked
        ],
    }
    return json.dumps(finite(document), indent=1) + "\n"
