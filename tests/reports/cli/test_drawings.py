"""`crankcheck polygon` and `graph`: tables, sheets, and the log of an engine beside them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from typer.testing import Result

from analytic.kinematics import solve
from models.files import load_scene
from tests.worlds.command_line import crank, flat, refused


def polygon(*arguments: object) -> Result:
    return crank("polygon", *arguments)


def test_the_vectors_are_told_in_the_order_of_drawing() -> None:
    told = polygon("fourbar-lecture-1", "--at-deg", "90").output
    vectors = [line.split()[0] for line in told.splitlines() if line.startswith(("v_", "a^"))]
    assert vectors == [
        *("v_BA", "v_CB", "v_CD"),
        *("a^n_BA", "a^n_CB", "a^t_CB", "a^n_CD", "a^t_CD"),
    ]
    assert "perpendicular to BC" in told
    assert "velocity polygon, 0.01 m/s to the mm" in told


def test_the_sheet_is_written_and_told_of(tmp_path: Path) -> None:
    file = tmp_path / "sheet.svg"
    result = polygon("fourbar-lecture-1", "-o", str(file))
    assert result.exit_code == 0
    assert "at 90 deg, on 297 x 210 mm" in result.output
    assert b"layer-velocity-1" in file.read_bytes()


def test_a_limit_position_is_drawn_as_far_as_it_is_determined() -> None:
    # coupler and rocker in line: cos phi = (0.25^2 + 0.3^2 - 0.4^2) / (2 0.25 0.3)
    told = polygon("fourbar-double-rocker-swing", "--omega", "1", "--at-deg", "92.8659829").output
    assert "v_BA" in told


def test_what_is_let_go_is_drawn_at_a_time() -> None:
    told = polygon("fourbar-swing", "--at-s", "0").output
    assert "t = 0 s, 0 rad/s, -77.2067 rad/s^2" in told
    assert "at rest: every velocity is 0" in told
    assert "one point, as omega is 0" in told


def test_at_a_change_point_the_rest_is_drawn_and_told() -> None:
    told = polygon("fourbar-chain", "--omega", "1", "--at-deg", "0").output
    assert "v_B0A0" in told
    assert "not drawn: RRR (coupler0, rocker1): both directions" in told
    assert "not drawn: RRR (coupler1, rocker2): hangs on coupler0" in told


def log_of_one(tmp_path: Path) -> Path:
    """Rows in which C stands and moves as the reference has it, but for 1 mm/s."""
    scene = load_scene("fourbar-lecture-1")
    motion = solve(scene, np.arange(0.0, 0.7, 0.01), bound=False)
    point = motion.points["C"]
    rows = np.column_stack([motion.time_s, point.position, point.velocity + np.array([1e-3, 0])])
    path = tmp_path / "run.csv"
    head = "time_s,C_x_m,C_y_m,C_vx_m_s,C_vy_m_s"
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.12g")
    return path


def test_a_log_is_drawn_beside(tmp_path: Path) -> None:
    log = log_of_one(tmp_path)
    told = polygon("fourbar-lecture-1", "--at-deg", "90", "--log", str(log)).output
    assert "crank at 90.9634 deg, t = 0.63 s in" in flat(told)
    assert "as the log reports them: errors" in told
    assert "by central differences of logged positions" in told
    point = next(line.split() for line in told.splitlines() if line.startswith("C "))
    assert point[5:] == ["0.001", "0.1", "0.000"]


def test_a_log_of_another_scene_is_refused(tmp_path: Path) -> None:
    result = polygon("slider-crank-central", "--log", log_of_one(tmp_path))
    refused(result, "in its first row, t = 0 s, y of C (column 'C_y_m') is")


def graph(*arguments: object) -> Result:
    return crank("graph", "fourbar-lecture-1", "--of", "rocker", *arguments)


def test_without_a_file_the_table_of_a_graph_is_shown() -> None:
    told = graph("--divisions", "8").output.splitlines()
    assert told[0].split() == [
        *("no.", "crank", "deg", "phi", "rad", "omega", "rad/s", "exact"),
        *("epsilon", "rad/s²", "exact"),
    ]
    assert told[2].split()[:3] == ["0.5", "112.50", "4.9897"]
    assert told[-1].endswith("in 8 parts; omega off by up to 5.4 %, epsilon off by up to 11 %")


def test_orders_are_fitted_and_the_log_of_an_engine_ends_in_its_own_error(tmp_path: Path) -> None:
    # That an engine's log goes through: `run` writes it, and names and instants are its own.
    log, sheet = tmp_path / "run.csv", tmp_path / "orders.svg"
    options = ("--engine", "pymunk", "--profile", "as-shipped", "--turns", "1", "-o", log)
    assert crank("run", "fourbar-lecture-1", *options).exit_code == 0
    result = graph("--divisions", "24,48,96", "--log", log, "-o", sheet)
    assert result.exit_code == 0
    first, *_, last, floor = (line.split() for line in result.output.splitlines())
    assert first[0] == f"{sheet}:"
    assert (last[0], last[1]) == ("order", "1.99")
    assert last[3:] == ["-"] * 4  # of the log, in 96 parts: its own error is most of it
    assert "down to its own" in " ".join(floor)
    assert "reference, omega: order 1.99" in sheet.read_text(encoding="utf-8")
