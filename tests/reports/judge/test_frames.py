"""Frames: one row per cell, failures included, units in the names."""

from __future__ import annotations

import pandas as pd
import pytest

from models.scene import Scene
from reports.judge.cell import Cell, check, unfinished
from reports.judge.frames import cell_frame, error_frame
from reports.judge.rows import ELASTIC_COLUMNS, ERROR_COLUMNS, FORCE_COLUMNS, FREE_COLUMNS
from reports.judge.tolerance import DEFAULTS, FORCES


@pytest.fixture(scope="module")
def frame(slider_crank: Scene) -> pd.DataFrame:
    cell = Cell(slider_crank, "pymunk", "tuned", slider_crank.driver.law.period_s / 360, 360)
    return cell_frame([check(cell), unfinished(cell, "crashed", "gone")])


def test_a_failure_is_a_row_with_its_reason_and_the_same_columns(frame: pd.DataFrame) -> None:
    assert frame["status"].tolist() == ["ok", "crashed"]
    assert frame["reason"].tolist() == ["", "gone"]
    assert frame["verdict"].tolist() == ["within", "out"]
    assert pd.isna(frame["angle_error_rad"][1])
    assert frame["failed_rules"].tolist() == ["", "CC101"]


def test_every_error_column_carries_its_unit(frame: pd.DataFrame) -> None:
    units = ("_rad", "_m", "_rad_s", "_m_s", "_rad_s2", "_m_s2", "_n", "_n_m", "_j", "_kg_m2_s")
    names = [name for name, *_ in ERROR_COLUMNS]
    assert all(name.endswith(units) for name in names)
    assert set(names) - FORCE_COLUMNS - FREE_COLUMNS - ELASTIC_COLUMNS == set(names) & set(
        frame.columns
    )
    for name in [each for each in DEFAULTS if each not in FORCES]:
        assert f"{name.replace('-', '_')}_pure" in frame.columns


def test_what_the_engine_does_not_report_is_empty_and_the_rest_is_there(
    frame: pd.DataFrame,
) -> None:
    assert pd.isna(frame["angular_acceleration_error_rad_s2"][0])
    for name in ("displacement_error_m", "slider_speed_error_m_s", "pin_gap_m", "drive_error_rad"):
        assert frame[name][0] >= 0.0


def test_the_long_frame_has_one_row_per_quantity_body_source_and_kind(slider_crank: Scene) -> None:
    cell = Cell(slider_crank, "mujoco", "tuned", slider_crank.driver.law.period_s / 360, 360)
    long = error_frame([check(cell)])
    key = ["scene", "engine", "profile", "dt_s", "quantity", "body_kind", "body", "source", "kind"]
    assert not long.duplicated(key).any()
    gated = long[long["kind"] == "total"]
    assert (gated["maximum_pure"] <= gated["limit_pure"]).all()
    assert long.loc[long["kind"] != "total", "limit_pure"].isna().all()
