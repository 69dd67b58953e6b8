"""Engines on elastic links that are let go, or driven by a controller."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from models.files import load_scene
from models.loads import Load
from models.scene import Scene
from models.springs import PinSpring
from models.waves import Pulse
from reports.judge.cell import Cell, CellRunner, Checked, check, examined
from reports.judge.rows import cell_row
from reports.plan.elastic import counted_released, shortened_note, under_control
from sim.engine import Run
from sim.run import run

SEGMENTS = 4
LASTS_S = 0.3


@cache
def scene(name: str) -> Scene:
    return under_control(load_scene(name))


def cell(name: str = "fourbar-elastic-pulse", engine: str = "mujoco", **changes: object) -> Cell:
    dt_s, steps = counted_released(scene(name), None, LASTS_S, SEGMENTS, "plain")
    asked = Cell(
        scene(name), engine, "tuned", dt_s, steps, drive="free", converge=False, segments=SEGMENTS
    )
    return replace(asked, **changes)  # type: ignore[arg-type]


def worst(checked: Checked, quantity: str) -> float:
    assert checked.errors is not None
    error = checked.errors.worst(quantity)
    assert error is not None, quantity
    return error.pure


@pytest.mark.parametrize(
    ("engine", "most"), [("mujoco", 1e-5), ("pymunk", 3e-4), ("exudyn", 1e-3)]
)
@pytest.mark.parametrize("name", ["fourbar-elastic-pulse", "fourbar-elastic-controlled"])
def test_an_engine_follows_its_exact_chain_with_the_second_order(
    name: str, engine: str, most: float
) -> None:
    found = check(cell(name, engine, converge=True))
    assert found.verdict == "within", [finding.text for finding in found.failures]
    assert worst(found, "segments") < most
    assert found.convergence is not None
    assert found.convergence.order == pytest.approx(2.0, abs=0.25)
