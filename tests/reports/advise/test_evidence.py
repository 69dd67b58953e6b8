"""What may be asked for, the steps that follow from it, what advice chooses from, and what a stored
study says of settings at a speed and step."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from models.errors import CrankcheckError
from models.files.reading import load_scene, parse_scene, scene_texts
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.advise import demand
from reports.plan.steps import LEAST_STEPS_PER_TURN, MOST_SEARCHED
from reports.plan.study import load_study
from reports.results.lines import Line, lines
from reports.store.reader import Stored, read_store
from sim.engine.settings import resolved
from sim.registry import engine, usual
from tests.worlds.small_store import SCENES, STEPS

TEXTS = scene_texts(SCENES)
EVERY = {choice.label: choice for choice in demand.choices(["mujoco", "pymunk"], ())}
STIFF, SOFT = EVERY["mujoco tuned"], EVERY["mujoco as-shipped"]
BIASED, UNBIASED = EVERY["pymunk as-shipped"], EVERY["pymunk no bias"]
FOURBAR = load_scene(SCENES[0])


@dataclass(frozen=True)
class Study:
    stored: Stored
    lines: tuple[Line, ...]

    def told(self, wanted: demand.Demand, texts: Mapping[str, str] = TEXTS) -> demand.MeasuredStudy:
        return demand.evidence(self.stored, self.lines, wanted, texts, EVERY.values())

    def error(self, choice: demand.Choice, steps: float) -> float:
        named = (FOURBAR.name, choice.label)
        (line,) = [x for x in self.lines if (x.scene, f"{x.engine} {x.variant}") == named]
        cells = line.cells
        return float(cells.loc[cells["steps_per_turn"].round(6) == steps, "place_pure"].iloc[0])


@pytest.fixture(scope="module")
def study(store: Path) -> Study:
    stored = read_store(store)
    return Study(stored, lines(stored))


def at(speed: float, *scenes: Scene) -> demand.Demand:
    return demand.demanded(scenes or (FOURBAR,), speed, 1e-3 * math.tau / abs(speed), 1e-3, 2.0)


def refused(known: demand.MeasuredStudy, words: str) -> bool:
    """It has nothing, and says so."""
    return known.measured == {} and any(words in each for each in known.refusals)


def test_at_its_speed_it_says_what_was_measured_or_is_between(study: Study) -> None:
    known = study.told(at(10.0))
    for choice in (STIFF, SOFT, BIASED, UNBIASED):
        for steps in STEPS:
            wanted = pytest.approx(study.error(choice, steps), rel=1e-6)
            assert known.error(FOURBAR, choice, steps) == wanted
    assert known.turns == pytest.approx(1.0)
    assert known.refusals == ()
    middle = known.error(FOURBAR, STIFF, math.sqrt(180 * 360))
    wanted = math.sqrt(study.error(STIFF, 180) * study.error(STIFF, 360))
    assert middle == pytest.approx(wanted, rel=1e-9)
    for steps in (STEPS[0] - 1.0, STEPS[-1] + 1.0):
        assert known.error(FOURBAR, STIFF, steps) is None
    assert known.error(FOURBAR, EVERY["mujoco RK4"], 360) is None
    assert demand.MeasuredSteps(((90.0, 1e-3), (180.0, 0.0))).error(180.0) == 0.0


def test_at_another_speed_settings_in_seconds_say_nothing(study: Study) -> None:
    known = study.told(at(0.3))
    for choice in (STIFF, UNBIASED):
        assert known.error(FOURBAR, choice, 360) == pytest.approx(study.error(choice, 360))
    for choice, setting in ((SOFT, "solref_timeconst_s"), (BIASED, "error_bias")):
        assert known.error(FOURBAR, choice, 360) is None
        words = f"{choice.label}: {setting} in seconds"
        assert any(words in each for each in known.refusals)


def test_another_motion_scene_version_or_drive_does_not_serve_and_is_told(study: Study) -> None:
    assert refused(study.told(at(-10.0)), "turns the other way")
    longer = TEXTS[FOURBAR.name].replace("length_m = 0.25", "length_m = 0.26")
    known = study.told(at(10.0), {**TEXTS, FOURBAR.name: longer})
    assert refused(known, f"another scene {FOURBAR.name}")
    known = study.told(at(10.0, load_scene("whitworth")), scene_texts(["whitworth"]))
    assert known.refusals == ("whitworth: not in the study",)
    mujoco = [line for line in study.lines if line.engine == "mujoco"]
    for change, words in (
        ({"version": "0.9"}, "of mujoco 0.9; here it is"),
        ({"drive": "servo"}, "under the drive servo"),
    ):
        changed = tuple(replace(line, **change) for line in mujoco)  # type: ignore[arg-type]
        assert refused(replace(study, lines=changed).told(at(10.0)), words)


def test_with_gravity_or_loads_only_its_speed_serves(study: Study) -> None:
    own = TEXTS[FOURBAR.name]
    for kind, text in (
        ("gravity", f"gravity_m_s2 = [0.0, -9.81]\n{own}"),
        ("loads", f'{own}\n[loads.pull]\nlink = "crank"\ntorque_n_m = 1.0\n'),
    ):
        scene, texts = parse_scene(text, kind), {**TEXTS, FOURBAR.name: text}
        manifest = replace(study.stored.manifest, scenes=texts)
        pulled = replace(study, stored=replace(study.stored, manifest=manifest))
        assert pulled.told(at(10.0, scene), texts).measured
        known = pulled.told(at(20.0, scene), texts)
        assert refused(known, f"has {kind}, and turns at 10 rad/s there")


def test_beside_a_run_that_failed_nothing_is_read_and_finer_misses_are_known(study: Study) -> None:
    """The finest cell of pymunk "no bias" on the lever is said to have diverged."""
    lever = load_scene("slotted-lever")
    known = study.told(at(10.0, lever))
    assert known.error(lever, UNBIASED, 359) is not None
    assert known.error(lever, UNBIASED, 400) is None
    assert known.missed(lever, UNBIASED, 100.0, 1.0) == pytest.approx(720.0)
    assert known.missed(lever, UNBIASED, 720.0 + 1e-6, 1.0) is None
    assert known.missed(lever, STIFF, 100.0, 1.0) is None


def test_its_scenes_are_choices_and_its_settings_that_an_engine_takes(study: Study) -> None:
    assert set(demand.stored_scenes(study.stored)) == set(SCENES)
    found = {choice.label: choice for choice in demand.stored_choices(study.lines)}
    for choice in (STIFF, SOFT, BIASED, UNBIASED):
        assert found[choice.label].settings == choice.settings
    settings = resolved(engine("mujoco").profiles["tuned"], None)
    line = next(line for line in study.lines if line.engine == "mujoco")
    for wrong in ({"nothing": 1}, {"iterations": 0}):
        assert demand.stored_choices([replace(line, settings=settings | wrong)]) == []


CHOICE = demand.Choice("fake", "tuned", "tuned", {})


def asked(*scenes: Scene, **changes: Any) -> demand.Demand:
    numbers = {"speed_rad_s": 10.0, "frame_s": 1 / 60, "target": 1e-3, "turns": 10.0}
    return demand.demanded(scenes or (FOURBAR,), **(numbers | changes))


def test_a_speed_takes_the_place_of_the_scenes_own_and_frames_are_counted_in_its_turns() -> None:
    moved = demand.at_speed(FOURBAR, -3.0)
    law = moved.driver.law
    assert isinstance(law, ConstantSpeed)
    assert (law.speed_rad_s, law.start_rad) == (-3.0, FOURBAR.driver.law.at(0.0)[0])  # type: ignore[arg-type]
    assert replace(moved, driver=FOURBAR.driver) == FOURBAR
    wanted = asked()
    assert wanted.frames_per_turn == pytest.approx(37.699, rel=1e-4)
    cell = wanted.cell(wanted.scenes[0], CHOICE, 4)
    assert cell.dt_s == wanted.frame_s / 4
    assert cell.steps == math.ceil(10 * 4 * wanted.frames_per_turn)
    assert cell.turns >= 10.0
    longer = wanted.cell(wanted.scenes[0], CHOICE, 4, longer=8.0)
    assert longer.steps == 8 * cell.steps
    assert wanted.cell(wanted.scenes[0], CHOICE, 200, longer=8.0).steps == MOST_SEARCHED


@pytest.mark.parametrize(
    ("frame_s", "least"), [(1e-5, 1), (math.tau / 80, 1), (math.tau / 79, 2), (1.0, 13)]
)
def test_least_sub_steps_do_for_a_turn_and_twice_the_most_run(frame_s: float, least: int) -> None:
    wanted = asked(frame_s=frame_s, turns=1.0)
    assert wanted.least == least
    assert wanted.steps_per_turn(least) > LEAST_STEPS_PER_TURN * (1 - 1e-9)
    assert wanted.least <= wanted.most <= demand.MOST_SUBSTEPS
    assert wanted.cell(wanted.scenes[0], CHOICE, 2 * wanted.most).steps <= MOST_SEARCHED


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frame_s": 0.0}, "--dt 0: give a number above 0, in seconds for a frame"),
        ({"speed_rad_s": 0.0}, "--speed 0: .* clockwise it is negative"),
        ({"speed_rad_s": -math.inf}, "--speed -inf: "),
        ({"target": 1.0}, "--target 1: .* to under 1"),
        ({"turns": 0.5}, "--turns 0.5: give 1 turn"),
        ({"frame_s": 1e4}, "--dt 10000: .* even in 4096 sub-steps; give at most 322 s"),
        ({"turns": 1e4}, "--turns 10000: 376991 frames, 37.7 in .*: use --turns 2.65e.03, or"),
        ({"frame_s": 1e-9}, "at most 100000 steps are run: give a longer frame"),
    ],
)
def test_what_can_not_be_asked_for_is_told(changes: dict[str, float], words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        asked(**changes)


def test_the_longest_frame_that_a_message_names_is_taken_and_no_driver_of_another_law() -> None:
    assert asked(frame_s=321.0, turns=2.0).least <= demand.MOST_SUBSTEPS
    assert asked(turns=2650.0).least == 1
    with pytest.raises(CrankcheckError, match=r'fourbar-double-rocker.*law = "constant"'):
        asked(FOURBAR, load_scene("fourbar-double-rocker"))


def test_profiles_and_variants_are_choices_but_for_one_like_another() -> None:
    every = demand.choices(usual(), ())
    labels = sorted(choice.label for choice in every)
    for name in usual():
        assert {f"{name} {profile}" for profile in engine(name).profiles} <= {*labels}
    variants = [one for each in load_study(None).variants for one in each.each()]
    assert labels == sorted(f"{one.engine} {one.name}" for one in variants)
    for choice in every:
        assert choice.settings.keys() == engine(choice.engine).profiles["tuned"].settings.keys()
    assert EVERY["pymunk as-shipped"].words == demand.OWN
    assert EVERY["pymunk no bias"].words == "error_bias 0"
    settings = resolved(engine("pymunk").profiles["tuned"], {"iterations": 77})
    same = demand.Choice(
        "pymunk", "alias", "tuned", resolved(engine("pymunk").profiles["tuned"], None)
    )
    mine = demand.Choice("pymunk", "no bias", "tuned", settings)
    plain = demand.choices(["pymunk"], ())
    every = demand.choices(["pymunk"], (same, mine, replace(mine, name="twice")))
    (added,) = [choice for choice in every if choice not in plain]
    assert (added.name, added.settings) == ("no bias (study)", settings)
