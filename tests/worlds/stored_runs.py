"""Runs that were really made, stored, and read again; and cells made up for what is rare."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path

import pandas as pd
import pytest

from models.files.reading import shipped
from models.scene import Scene
from reports.judge.cell import Cell
from reports.judge.rows import cell_frame, error_frame
from reports.output.write import provenance
from reports.plan.grid import digest
from reports.results.runs import CellName, StoredCell, StoredRun
from reports.store.manifest import Manifest
from reports.store.writer import Writer
from reports.sweep.measured import measured
from reports.verify.advised import check_all
from sim.registry import engine

Plant = Callable[[pd.DataFrame], None]
Copy = Callable[..., Path]
STEPS = (90, 180)


@pytest.fixture(scope="session")
def verified(fourbar: Scene) -> tuple[pd.DataFrame, Mapping[str, str]]:
    """The cells of a verification of two engines and two profiles, and its facts."""
    dt_s = fourbar.driver.law.period_s / 90
    cells = [
        Cell(fourbar, name, profile, dt_s, 90, converge=False)
        for name in ("mujoco", "pymunk")
        for profile in ("tuned", "as-shipped")
    ]
    checked = check_all(cells, 1, lambda _: None)
    assert not error_frame(checked).empty
    facts = provenance({name: engine(name).version() for name in ("mujoco", "pymunk")})
    return cell_frame(checked), facts


@pytest.fixture
def stored(verified: tuple[pd.DataFrame, Mapping[str, str]], tmp_path: Path) -> Copy:
    """Write the verification to a folder, as `verify -o` does, with a change planted
    in it, or without some of its cells."""

    def make(
        name: str, plant: Plant = lambda _: None, text: str = "", drop: tuple[int, ...] = ()
    ) -> Path:
        frame, facts = verified[0].drop(index=list(drop)), verified[1]
        plant(frame)
        folder = tmp_path / name
        folder.mkdir()
        frame.to_csv(folder / "verify.csv", index=False)
        content = {"provenance": facts, "scenes": {"fourbar-lecture-1": digest(text)}, "cells": []}
        (folder / "verify.json").write_text(json.dumps(content), encoding="utf-8")
        return folder

    return make


@pytest.fixture(scope="session")
def swept(fourbar: Scene) -> list[tuple[dict[str, object], dict[str, object]]]:
    """The rows of cells and of timings of a sweep over two steps."""
    found = []
    for steps in STEPS:
        dt_s = fourbar.driver.law.period_s / steps
        one = measured(Cell(fourbar, "mujoco", "tuned", dt_s, steps, converge=False), False)
        times = dict.fromkeys(("us_per_step", "us_per_step_a", "us_per_step_b"), 2.0)
        names = {"key": f"k{steps}", "line": "l", "variant": "tuned", "asked": {}}
        found.append((names | dict(one.row), {"key": f"k{steps}", **times}))
    return found


@pytest.fixture
def store(swept: list[tuple[dict[str, object], dict[str, object]]], tmp_path: Path) -> Copy:
    """Write, or add to, the store of a sweep: columns of cells and of timings may be replaced;
    ``gaps`` are growths of the gap by steps per turn."""
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")

    def make(
        name: str,
        text: str = text,
        us: float = 2.0,
        cpu: str = "one",
        gaps: Mapping[float, float] | None = None,
        **other: str,
    ) -> Path:
        version = other.get("version", "4.0.0")
        run = {"command": [], "provenance": {"mujoco": version, "processor": cpu}}
        manifest = Manifest({"fourbar-lecture-1": text}, (run,))
        with Writer(tmp_path / name, manifest) as writer:
            for row, timing in swept:
                key = f"{row['key']}-{version}"
                changed = {**row, "scene_digest": digest(text), **other, "key": key}
                changed["gap_pure"] *= (gaps or {}).get(row["steps_per_turn"], 1.0)
                writer.cell(changed, (), {})
                costs = {k: us for k in timing if k.startswith("us_")}
                writer.timing({**costs, "key": key, "processor": cpu, "made": "now"})
        return tmp_path / name

    return make


def cell(
    scene: str = "a",
    variant: str = "tuned",
    steps: float = 720.0,
    status: str = "ok",
    reason: str = "",
    version: str = "1",
    digest: str = "",
    **errors: float,
) -> StoredCell:
    """A cell made up, with errors by quantity (``_`` for ``-``)."""
    name = CellName(scene, "mujoco", variant, "prescribed", steps, 2.0)
    named = {key.replace("_", "-"): value for key, value in errors.items()}
    return StoredCell(name, version, status, reason, named, scene_digest=digest)


def run(*cells: StoredCell, label: str = "x") -> StoredRun:
    return StoredRun(label, {one.name: one for one in cells})


@pytest.fixture(scope="session", name="cell")
def made_cell() -> Callable[..., StoredCell]:
    return cell


@pytest.fixture(scope="session", name="run")
def made_run() -> Callable[..., StoredRun]:
    return run
