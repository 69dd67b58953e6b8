"""`assert_within`: what it lets pass, and what it says of the rest."""

from __future__ import annotations

from pathlib import Path
from traceback import walk_tb

import numpy as np
import pytest

import crankcheck
from crankcheck.testing import assert_within

SCENE = "fourbar-lecture-1"


@pytest.fixture(scope="module")
def log() -> dict[str, np.ndarray]:
    """The angle of the rocker, off by half a degree from 0.3 s on."""
    time_s = np.linspace(0.0, 0.6, 301)
    theta = np.degrees(crankcheck.solve(SCENE, time_s).links["rocker"].theta)
    return {"time_s": time_s, "rocker_deg": theta + 0.5 * (time_s > 0.3)}


def test_what_is_within_is_handed_back(
    ran: crankcheck.Simulation, log: dict[str, np.ndarray], tmp_path: Path
) -> None:
    assert isinstance(assert_within(SCENE, ran), crankcheck.CellVerdict)
    path = tmp_path / "log.csv"
    ran.frame().to_csv(path, index=False)
    assert assert_within(ran.mechanism, path, step_s=ran.dt_s).verdict == "within"
    assert isinstance(assert_within(SCENE, log, angle=1e-2), crankcheck.LogVerdict)
    assert_within(SCENE, crankcheck.solve(SCENE), target=1e-12, velocity=1e-9)


def test_what_is_out_is_told_as_the_command_tells_it(log: dict[str, np.ndarray]) -> None:
    with pytest.raises(AssertionError) as told:
        assert_within(SCENE, log, angle=1e-3)
    hidden = [frame.f_locals.get("__tracebackhide__") for frame, _ in walk_tb(told.tb)]
    assert hidden == [None, True, True]  # pytest shows the line that asserts, and nothing below it
    text = str(told.value)
    assert text.startswith("\nOUT  the log, scene fourbar-lecture-1\n  CC103 angle: link rocker: ")
    assert "OUT rocker_deg   angle of rocker" in text
    assert "OUT OF TOLERANCE: 1 of 1 error over 301 samples" in text


def test_of_a_run_it_is_the_table_of_verify(ran: crankcheck.Simulation) -> None:
    with pytest.raises(AssertionError, match="CC107 velocity, differenced: link") as told:
        assert_within(SCENE, ran, velocity_differenced=1e-9)
    assert "\nOUT fourbar-lecture-1      mujoco " in str(told.value)
    with pytest.raises(AssertionError, match="1e-08 rad") as told:
        assert_within(SCENE, ran, target=1e-8, position=1.0)
    assert "CC113" not in str(told.value)


def test_what_moves_the_truth_is_said_as_of_judge(log: dict[str, np.ndarray]) -> None:
    time_s = log["time_s"]
    truth = crankcheck.solve(SCENE, 1.1 * time_s)
    quicker = {"time_s": time_s, **{f"{name}_rad": truth.links[name].theta
                                    for name in ("crank", "rocker")}}  # fmt: skip
    for drive in ("fitted", "logged"):
        assert_within(SCENE, quicker, drive=drive, angle=1e-9, target={"drive": 1e-9})
    with pytest.raises(AssertionError, match="CC102 drive"):
        assert_within(SCENE, quicker, target=1e-3)
    with pytest.raises(crankcheck.CrankcheckError, match=r"drive: found 1e-09; give scene, fitted"):
        assert_within(SCENE, quicker, target=1e-3, drive=1e-9)  # type: ignore[arg-type]


def test_a_quantity_without_a_tolerance_is_asked_for(log: dict[str, np.ndarray]) -> None:
    with pytest.raises(crankcheck.CrankcheckError, match=r"no limit for angle: .* give target"):
        assert_within(SCENE, log, velocity=1e-3)
    with pytest.raises(TypeError):
        assert_within(SCENE)  # type: ignore[call-arg]


def test_what_is_required_and_not_there_is_out(log: dict[str, np.ndarray]) -> None:
    with pytest.raises(AssertionError, match="not in the log: velocity of rocker"):
        assert_within(SCENE, log, angle=1e-2, require="rocker.velocity")
