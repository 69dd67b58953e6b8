"""Columns of forces in a user's own log: their names, units and signs."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import crankcheck
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene import Scene
from reports.describe.free_motion import motion_frame, run_frame
from reports.logs import force_columns
from reports.logs.columns import columns_of
from reports.logs.meanings import understood
from tests.worlds.tiers import slow

SCENE = load_scene("slider-crank-offset")
STEP_S = SCENE.driver.law.period_s / 360


def ran(engine: str, scene: Scene = SCENE) -> pd.DataFrame:
    done = crankcheck.run(scene, engine, steps_per_turn=360, turns=1, forces=True)
    return run_frame(done)


@pytest.fixture(scope="module")
def frame() -> pd.DataFrame:
    return ran("mujoco")


@pytest.fixture(scope="module")
def bare(frame: pd.DataFrame) -> pd.DataFrame:
    """The forces, and of the motion the angles alone: each column beside takes its time."""
    angles = [name for name in frame if name.endswith("_theta_rad")]
    return frame[["time_s", *angles, *filter(force_columns.shown_names(SCENE).__contains__, frame)]]


def exact(scene: Scene, time_s: Array) -> pd.DataFrame:
    """The closed form with its forces, as we write it."""
    motion = solve(scene, time_s)
    return motion_frame(replace(motion, forces=forces(scene, motion, skip_dead_points=True)))


def _judged(log: pd.DataFrame, **options: object) -> crankcheck.LogVerdict:
    return crankcheck.judge(SCENE, log, step_s=STEP_S, forces=True, **options)  # type: ignore[call-overload, no-any-return]


def rules(verdict: crankcheck.LogVerdict) -> set[str]:
    return {finding.rule for finding in verdict.failures}


def test_a_log_that_we_write_is_within_and_holds_every_force(frame: pd.DataFrame) -> None:
    verdict = _judged(frame)
    assert verdict.verdict == "within"
    held = {(row.quantity, row.body) for row in verdict.errors.rows if row.quantity != "gap"}
    wanted = {("torque", "crank"), ("normal", "C"), ("moment", "C")}
    assert wanted | {("reaction", p) for p in "ABC"} <= held
    assert not [text for text in verdict.not_judged if "reaction" in text]


@slow("0.7 s: logs of two engines more")
def test_so_are_those_of_forces_of_steps_and_of_joints_that_are_solved_for() -> None:
    log = ran("pymunk")
    assert np.isnan(log["torque_n_m"][0])
    assert _judged(log).verdict == "within"
    log = ran("exudyn")
    assert _judged(log).verdict == "within"
    log["C_x_m"] += 1e-6 * np.sin(log["time_s"])  # as what is integrated may be, and starts
    assert rules(_judged(log)) == {"CC116"}


OTHERWISE = {
    "torque_n_m": ("crank torque [N mm]", 1e3),
    "C_slider_normal_n": ("C.normal (kN)", 1e-3),
    "C_slider_moment_n_m": ("C_moment_lbf_in", 1 / (4.4482216152605 * 0.0254)),
    "B_rod_fx_n": ("B_fx_n", 1.0),
    "B_rod_fy_n": ("B_on_rod_fy [N]", 1.0),
    "A_crank_fy_n": ("A crank fy", 1.0),
}


def test_other_names_and_units_mean_the_same(bare: pd.DataFrame) -> None:
    other = bare.rename(columns={name: called for name, (called, _) in OTHERWISE.items()})
    for called, factor in OTHERWISE.values():
        other[called] *= factor
    found = _judged(other)
    assert found.verdict == "within"
    assert len(found.errors.rows) == len(_judged(bare).errors.rows)
    for column, rule in (("C.normal (kN)", "CC121"), ("crank torque [N mm]", "CC123")):
        wrong = other.assign(**{column: -other[column]})
        assert rules(_judged(wrong)) - {"CC116"} == {rule}


def test_what_is_not_in_the_log_is_not_judged_and_can_be_required(bare: pd.DataFrame) -> None:
    less = bare.drop(columns=["torque_n_m"])
    assert "torque of crank" in _judged(less).not_judged
    assert [each.rule for each in _judged(less, require="torque").failures] == ["CC119"]


def test_instants_of_forces_of_their_own_are_taken(bare: pd.DataFrame) -> None:
    late = bare.copy()
    late["force_time_s"] = bare["time_s"] + 0.5 * STEP_S
    assert "CC120" in rules(_judged(late))


def test_without_being_asked_forces_are_named_and_not_judged(frame: pd.DataFrame) -> None:
    log = understood(columns_of(frame, "log"), SCENE)
    assert log.forces is None
    assert dict(log.unused)["torque_n_m"] == "a force, which is judged with --forces"


@pytest.mark.parametrize(
    ("log", "words"),
    [
        ({"crank_deg": 30.0}, "no column is a force of slider-crank-offset"),
        ({"torque_n_m": 1.0, "crank_torque [N m]": 1.0}, "two columns for one force"),
        ({"torque_n_m": np.inf}, "found inf"),
        ({"B_fx [mn]": 1.0}, "its unit may be milli or mega; write mN or MN"),
    ],
)
def test_bad_columns_are_refused(log: dict[str, float], words: str) -> None:
    rows = {"time_s": [0.0, 0.1, 0.2], **{name: [1.0, value, 1.0] for name, value in log.items()}}
    with pytest.raises(CrankcheckError, match=words):
        understood(columns_of(pd.DataFrame(rows), "log"), SCENE, forces=True)


@pytest.mark.parametrize("name", ["B_fz_n", "torque_deg", "normal_n", "C_fx_n_m", "time_s"])
def test_other_columns_are_none(name: str) -> None:
    assert not force_columns.names_force(name, SCENE)


def test_the_names_that_are_proposed_are_ours_and_each_stands_once(frame: pd.DataFrame) -> None:
    names = force_columns.shown_names(SCENE)
    assert len(set(names)) == len(names)
    assert set(names) <= set(frame)
    with pytest.raises(CrankcheckError, match="such as torque_n_m, A_crank_fx_n, A_crank_fy_n, "):
        understood(columns_of(frame[["time_s", "crank_theta_rad"]], "log"), SCENE, forces=True)


def test_lengths_and_friction_that_we_write_are_left_alone() -> None:
    motion = solve(SCENE, np.array([0.0, 0.01]))
    rubs = dict.fromkeys(("B", "C"), motion.time_s)
    bears = replace(forces(SCENE, motion), friction=rubs)
    columns = motion_frame(replace(motion, forces=bears))
    named = [name for name in columns if "friction" in name or name.endswith("_f_n")]
    assert any("slider_friction" in name for name in named)
    assert any("friction_n_m" in name for name in named)
    unused = dict(understood(columns_of(columns, "log"), SCENE, forces=True).unused)
    for name in named:
        why = force_columns.FRICTION if "friction" in name else force_columns.FORCE_LENGTH
        assert unused[name] == why, name


@pytest.mark.parametrize(
    ("scene", "column", "reason"),
    [
        ("slider-crank-offset", "B_ground_fx_n", "in B meet crank and rod, not ground"),
        ("slotted-lever", "E_crank_fx_n", "E is not a pin"),
        ("toggle-press", "C_fy_n", "in C meet coupler, upper and lower: name the body"),
    ],
)
def test_a_body_that_does_not_meet_there_is_told_of(scene: str, column: str, reason: str) -> None:
    log = columns_of(pd.DataFrame({"time_s": [0.0, 0.1], "crank_deg": [30.0, 30.0], column: 1.0}))
    assert dict(understood(log, load_scene(scene)).unused)[column].startswith(reason)


ONE = {"B_fx [MN]": 1e6, "B_fx_mN": 1e-3, "B_fx [KN]": 1e3, "torque [mN m]": 1e-3, "B_fx": 1.0,
       "torque_MNm": 1e6, "torque [N mm]": 1e-3, "torque_NM": 1.0}  # fmt: skip


@pytest.mark.parametrize(("column", "one"), ONE.items())
def test_milli_and_mega_are_told_by_the_size_of_the_letter(column: str, one: float) -> None:
    assert force_columns.force_meaning(column, force_columns.force_places(SCENE))[1] == one


def test_forces_at_a_logged_angle_and_of_a_part_of_a_row_are_refused(
    frame: pd.DataFrame,
) -> None:
    with pytest.raises(CrankcheckError, match="judges the geometry alone"):
        _judged(frame, drive="logged")
    some = frame.copy()
    some.loc[0, "torque_n_m"] = np.nan
    with pytest.raises(CrankcheckError, match="row 0, column 'torque_n_m': found nan; fill it"):
        _judged(some)


CRANK, PRESS = "slider-crank-offset", "toggle-press"


@pytest.mark.parametrize(
    ("scene", "point", "kept"),
    [
        (CRANK, "B", {"B_crank_fx_n": ("B_rod_fx_n", -1.0), "B_fy_n": ("B_rod_fy_n", 1.0)}),
        (PRESS, "C on upper", {"C_upper_fy_n": ("C_upper_fy_n", 1.0)}),
    ],
)
def test_one_component_of_a_force_alone_is_judged(
    scene: str, point: str, kept: dict[str, tuple[str, float]]
) -> None:
    known = load_scene(scene)
    every = exact(known, np.linspace(0.0, 0.3, 30))
    log = every[["time_s", f"{known.driver.link}_theta_rad"]].copy()
    for name, (column, sign) in kept.items():
        log[name] = sign * every[column]
    right = crankcheck.judge(known, log, target=1e-6, forces=True)
    assert right.verdict == "within"
    assert ("reaction", point) in {(row.quantity, row.body) for row in right.errors.rows}
    log[next(iter(kept))] *= -1.0
    assert rules(crankcheck.judge(known, log, target=1e-6, forces=True)) >= {"CC120"}


@pytest.mark.parametrize("asked", [{"require": "crank.torque"}, {"target": {"torque": 1e-3}}])
def test_what_is_asked_of_forces_needs_them(frame: pd.DataFrame, asked: dict[str, object]) -> None:
    with pytest.raises(
        CrankcheckError, match=r"with (--forces|forces=True) only; add it, or leave torque out"
    ):
        crankcheck.judge(SCENE, frame, step_s=STEP_S, **asked)  # type: ignore[call-overload]
    assert _judged(frame, **asked).verdict == "within"


@slow("0.4 s: rare, a pin of three links; what lacks is told above")
def test_reactions_of_a_pin_of_three_can_be_required() -> None:
    every = exact(load_scene(PRESS), np.linspace(0.0, 0.3, 10))
    asked = {"forces": True, "target": 1e-6, "require": "C.reaction"}
    assert "CC119" not in rules(crankcheck.judge(PRESS, every, **asked))  # type: ignore[call-overload]
    less = every.drop(columns=["C_upper_fx_n", "C_upper_fy_n"])
    lacks = crankcheck.judge(PRESS, less, **asked)  # type: ignore[call-overload]
    assert "reaction of C on upper" in next(f.text for f in lacks.failures if f.rule == "CC119")
