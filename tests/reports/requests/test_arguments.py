"""Arguments of the wrong kind or shape are told at the call, in the words of the command."""

import itertools
import math
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from crankcheck.testing import assert_within
from models.files.reading import shipped
from tests.worlds.tiers import slowly

SCENE = "fourbar-lecture-1"
LOG = {"time_s": [0.0, 0.1, 0.2], "rocker_rad": [1.9, 2.0, 2.1]}
ODD: list[object] = [
    None, True, 0, -1, 1.5, math.nan, math.inf, 10**400, "", "x", "a\0b", "--dt", "x" * 5000, b"x",
    [], [1], ["a"], (), {}, {1: 2}, {"angle": "x"}, {"angle": -1}, set(), object(), object, 1j,
    Fraction(1, 2), np.float64(0.5), np.int64(3), np.array(3.0), np.array([]), np.zeros((2, 2)),
    np.array(["a"]), np.ma.masked_array([1, 2], [0, 1]), pd.DataFrame(), pd.Series([1.0, 2.0]),
    Path("/nowhere.csv"), Path(), slice(3), np.datetime64("2020"), {"time_s": [0, 1]},
    {"time_s": [0, 1], "rocker_rad": [0, None]},
]  # fmt: skip
"""Values that hardly any argument takes."""


def calls(ran: crankcheck.Simulation, folder: Path) -> Mapping[str, tuple[Callable, dict]]:
    """Each function with arguments that are right."""
    coarse = {"turns": 1, "steps_per_turn": 90}
    one = {**coarse, "scene": SCENE, "engine": "mujoco", "profile": "tuned", "settings": None}
    grid = {**coarse, "scenes": SCENE, "folder": folder / "study", "engines": "mujoco",
            "profiles": "tuned", "timing": False, "jobs": 1}  # fmt: skip
    told = {"scene": SCENE, "target": 10.0, "step_s": None, "map": None, "require": ()}
    return {
        "solve": (crankcheck.solve, {"scene": SCENE, "time_s": 0.1, "links": (), "bound": True}),
        "solve_driven": (crankcheck.solve_driven, {
            "scene": SCENE, "theta": 1.0, "omega": 1.0, "alpha": 0.0, "time_s": 0.0}),
        "run": (crankcheck.run, {**one, "every": 1, "drive": "servo"}),
        "check": (crankcheck.check, {**one, "tolerance": None, "converge": False}),
        "compare": (crankcheck.compare, {
            "scene": SCENE, "what": LOG, "step_s": None, "drive": "scene", "map": None}),
        "judge": (crankcheck.judge, {**told, "log": LOG, "drive": "scene"}),
        "judge a run": (crankcheck.judge, {**told, "log": ran, "drive": "scene"}),
        "assert_within": (assert_within, {**told, "log": LOG, "angle": 10.0}),
        "sweep": (crankcheck.sweep, {
            **grid, "settings": None, "study": None, "limit_s": 60.0, "memory_gb": 2.0}),
        "report": (crankcheck.report, {"folder": folder / "none", "output": folder / "a.md"}),
    }  # fmt: skip


@pytest.mark.parametrize(
    "odds",
    [ODD[::9], slowly(ODD, reason="eight seconds for values of the same kinds")],
)
def test_odd_arguments_are_errors_of_ours_told_at_the_call(
    odds: Sequence[object],
    ran: crankcheck.Simulation,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """None of them is another error, comes from deep inside, or speaks of options.

    The frames of its traceback are that of this test, and the one where it is told.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("reports.sweep.running.swept", lambda *_: pytest.fail("it would run"))
    for name, (call, right) in calls(ran, tmp_path).items():
        errors = {}
        for argument, (at, odd) in itertools.product(right, enumerate(odds)):
            try:
                call(**{**right, argument: odd})
            except crankcheck.CrankcheckError as error:
                errors[argument, at] = error
            except (AssertionError, pytest.fail.Exception):  # it was judged, or would run
                pass
        assert len(errors) > len(odds) * len(right) / 3, name
        for (argument, at), error in errors.items():
            assert len(traceback.extract_tb(error.__traceback__)) == 2, (name, argument, odds[at])
            if not isinstance(odds[at], str | np.ma.MaskedArray):
                assert "--" not in str(error).replace("judge --write-map", ""), (name, argument)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: crankcheck.load_scene(None), "scene: found None; give a shipped name"),
        (lambda: crankcheck.run(SCENE, settings={"iterations": [1]}), "iterations: found a list"),
        (
            lambda: crankcheck.run(SCENE, dt_s=1e-3, steps_per_turn=720),
            "^dt_s and steps_per_turn: both set the step; give one of them$",
        ),
        (lambda: crankcheck.run(SCENE, every=0), "every: found 0; give a whole number, at least 1"),
        (lambda: crankcheck.check(SCENE, drive="free"), "^drive 'free': unknown; use prescribed"),
        (lambda: crankcheck.check(SCENE, tolerance=1e-3), "tolerance: found 0.001; give a dict"),
        (lambda: crankcheck.judge(SCENE, LOG, target=1, map={"time": 1}), "^map: time: found 1"),
        (lambda: assert_within(SCENE, LOG, angel=1e-3), "^angel: not a quantity; did you mean"),
        (lambda: crankcheck.judge(SCENE, {}, target=1), "^the log: found no columns; give times"),
        (lambda: crankcheck.sweep(SCENE, __file__), "^folder .*.py is a file; name a folder"),
        (lambda: crankcheck.check_model(3, "A", 1.0), "^model: found 3; give a path$"),
        (lambda: crankcheck.check_model("a", "A", "x"), "^speed_rad_s: found 'x'; give a number"),
        (lambda: crankcheck.check_model("a", "A", 1.0, converge=1), "found 1; give True or False$"),
    ],
)
def test_messages_say_what_was_found_and_what_would_work(call: Callable, told: str) -> None:
    with pytest.raises(crankcheck.CrankcheckError, match=told):
        call()


def test_numbers_of_numpy_and_paths_are_taken(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_bytes(shipped()[SCENE].read_bytes())
    options = {"turns": np.float32(0.5), "steps_per_turn": np.int64(90), "every": np.uint8(2)}
    settings = {"iterations": np.int32(50), "tolerance": np.float64(1e-10)}
    done = crankcheck.run(path, settings=settings, **options)
    assert (done.status, done.steps, done.every) == ("ok", 45, 2)
    assert done.asked["iterations"] == 50
    assert crankcheck.compare(crankcheck.load_scene(path), done).worst("angle") is not None


def test_what_is_of_another_scene_and_of_a_run_what_only_a_log_has_to_be_told_is_refused(
    ran: crankcheck.Simulation, lagging: crankcheck.Simulation
) -> None:
    for call in (crankcheck.compare, crankcheck.judge, assert_within):
        with pytest.raises(crankcheck.CrankcheckError, match="is of slotted-lever, the scene"):
            call(SCENE, lagging)
    driver = ran.mechanism.driver
    other = replace(ran.mechanism, driver=replace(driver, law=driver.law.turned(0.1)))
    with pytest.raises(crankcheck.CrankcheckError, match=f"is of another {SCENE}, the scene"):
        crankcheck.judge(other, ran)
    with pytest.raises(crankcheck.CrankcheckError, match=f"motion is of {SCENE}, the scene is"):
        crankcheck.judge("shaper", crankcheck.solve(SCENE), target=1)
    for option, value in {"step_s": 1e-3, "drive": "fitted", "map": {}, "require": "angle"}.items():
        with pytest.raises(
            crankcheck.CrankcheckError, match=f"^{option}: this option is for logs, and this"
        ):
            crankcheck.judge(SCENE, ran, **{option: value})


@pytest.mark.parametrize(
    ("theta", "told"),
    [
        (np.zeros(3), r"rocker, theta of shape \(3,\), time_s of \(361,\)"),
        (np.zeros((361, 2)), r"of shape \(361, 2\), time_s of \(361,\); give \(361,\)"),
        (np.r_[np.nan, np.ones(360)], "row 0, column 'rocker_theta_rad': found nan"),
    ],
)
def test_a_motion_of_other_shapes_is_refused(theta: np.ndarray, told: str) -> None:
    own = crankcheck.solve(SCENE)
    for name, fault in (("rocker", told), ("rockr", f"'rockr' is not in {SCENE}; did you mean")):
        links = {**own.links, name: replace(own.links["rocker"], theta=theta)}
        with pytest.raises(crankcheck.CrankcheckError, match=fault):
            crankcheck.judge(
                SCENE, crankcheck.Motion(own.time_s, links, own.points, own.sliders), target=1e-3
            )
