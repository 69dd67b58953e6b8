"""`crankcheck polygon` and `graph`: sheets, and the log of an engine beside them. More of what they
tell is in `test_told.py`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from analytic.kinematics import solve
from models.files import load_scene
from tests.worlds.command_line import crank, flat, refused, told


def test_the_sheet_is_written_and_told_of(tmp_path: Path) -> None:
    file = tmp_path / "sheet.svg"
    assert "at 90 deg, on 297 x 210 mm" in told("polygon fourbar-lecture-1 -o", file)
    assert b"layer-velocity-1" in file.read_bytes()


def test_a_log_is_drawn_beside_and_that_of_another_scene_refused(tmp_path: Path) -> None:
    """Rows in which C stands and moves as the reference has it, but for 1 mm/s."""
    motion = solve(load_scene("fourbar-lecture-1"), np.arange(0.0, 0.7, 0.01), bound=False)
    point = motion.points["C"]
    rows = np.column_stack([motion.time_s, point.position, point.velocity + np.array([1e-3, 0])])
    log = tmp_path / "run.csv"
    head = "time_s,C_x_m,C_y_m,C_vx_m_s,C_vy_m_s"
    np.savetxt(log, rows, delimiter=",", header=head, comments="", fmt="%.12g")
    said = told("polygon fourbar-lecture-1 --at-deg 90 --log", log)
    assert "crank at 90.9634 deg, t = 0.63 s in" in flat(said)
    assert "as the log reports them: errors" in said
    assert "by central differences of logged positions" in said
    row = next(line.split() for line in said.splitlines() if line.startswith("C "))
    assert row[5:] == ["0.001", "0.1", "0.000"]
    other = crank("polygon", "slider-crank-central", "--log", log)
    refused(other, "in its first row, t = 0 s, y of C (column 'C_y_m') is")


def test_orders_are_fitted_and_the_log_of_an_engine_ends_in_its_own_error(tmp_path: Path) -> None:
    # That an engine's log goes through: `run` writes it, and names and instants are its own.
    log, sheet = tmp_path / "run.csv", tmp_path / "orders.svg"
    told("run fourbar-lecture-1 --engine pymunk --profile as-shipped --turns 1 -o", log)
    said = told("graph fourbar-lecture-1 --of rocker --divisions 24,48,96 --log", log, "-o", sheet)
    first, *_, last, floor = (line.split() for line in said.splitlines())
    assert first[0] == f"{sheet}:"
    assert (last[0], last[1]) == ("order", "1.99")
    assert last[3:] == ["-"] * 4  # of the log, in 96 parts: its own error is most of it
    assert "down to its own" in " ".join(floor)
    assert "reference, omega: order 1.99" in sheet.read_text(encoding="utf-8")
