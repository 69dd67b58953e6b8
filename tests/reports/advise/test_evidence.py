"""What a stored study says of settings at a speed and step, and where it says nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from models.files import load_scene, parse_scene, scene_texts
from models.scene import Scene
from reports.advise.choices import Choice, choices
from reports.advise.demand import Demand, demanded
from reports.advise.evidence import (
    MeasuredSteps,
    MeasuredStudy,
    evidence,
    stored_choices,
    stored_scenes,
)
from reports.results.lines import Line, lines
from reports.store.reader import Stored, read_store
from sim.registry import engine
from sim.settings import resolved
from tests.worlds.small_store import SCENES, STEPS

TEXTS = scene_texts(SCENES)
EVERY = {choice.label: choice for choice in choices(["mujoco", "pymunk"], ())}
STIFF, SOFT, BIASED, UNBIASED = (
    EVERY[label]
    for label in ("mujoco tuned", "mujoco as-shipped", "pymunk as-shipped", "pymunk no bias")
)
FOURBAR = load_scene(SCENES[0])


@dataclass(frozen=True)
class Study:
    """A store, and what is read of it."""

    stored: Stored
    lines: tuple[Line, ...]

    def told(self, demand: Demand, texts: Mapping[str, str] = TEXTS) -> MeasuredStudy:
        return evidence(self.stored, self.lines, demand, texts, EVERY.values())

    def error(self, choice: Choice, steps: float) -> float:
        """That of the four-bar, as it stands in the store."""
        named = (FOURBAR.name, choice.label)
        (line,) = [x for x in self.lines if (x.scene, f"{x.engine} {x.variant}") == named]
        cells = line.cells
        return float(cells.loc[cells["steps_per_turn"].round(6) == steps, "place_pure"].iloc[0])


@pytest.fixture(scope="module")
def study(store: Path) -> Study:
    stored = read_store(store)
    return Study(stored, lines(stored))


def at(speed: float, *scenes: Scene) -> Demand:
    return demanded(scenes or (FOURBAR,), speed, 1e-3 * math.tau / abs(speed), 1e-3, 2.0)


def refused(known: MeasuredStudy, words: str) -> bool:
    """It has nothing, and says so."""
    return known.measured == {} and any(words in each for each in known.refusals)


def test_at_its_own_steps_and_speed_it_says_what_was_measured(study: Study) -> None:
    known = study.told(at(10.0))
    for choice in (STIFF, SOFT, BIASED, UNBIASED):
        for steps in STEPS:
            wanted = pytest.approx(study.error(choice, steps), rel=1e-6)
            assert known.error(FOURBAR, choice, steps) == wanted
    assert known.turns == pytest.approx(2.0)
    assert known.refusals == ()


def test_between_its_steps_it_reads_a_straight_line_and_outside_nothing(study: Study) -> None:
    known = study.told(at(10.0))
    middle = known.error(FOURBAR, STIFF, math.sqrt(180 * 360))
    wanted = math.sqrt(study.error(STIFF, 180) * study.error(STIFF, 360))
    assert middle == pytest.approx(wanted, rel=1e-9)
    for steps in (STEPS[0] - 1.0, STEPS[-1] + 1.0):
        assert known.error(FOURBAR, STIFF, steps) is None
    assert known.error(FOURBAR, EVERY["mujoco RK4"], 360) is None
    assert MeasuredSteps(((90.0, 1e-3), (180.0, 0.0))).error(180.0) == 0.0


def test_at_another_speed_settings_in_seconds_say_nothing(study: Study) -> None:
    known = study.told(at(0.3))
    for choice in (STIFF, UNBIASED):
        assert known.error(FOURBAR, choice, 360) == pytest.approx(study.error(choice, 360))
    for choice, setting in ((SOFT, "solref_timeconst_s"), (BIASED, "error_bias")):
        assert known.error(FOURBAR, choice, 360) is None
        words = f"{choice.label}: {setting} in seconds"
        assert any(words in each for each in known.refusals)


def test_another_motion_or_scene_of_the_name_and_one_that_it_lacks_are_told(study: Study) -> None:
    assert refused(study.told(at(-10.0)), "turns the other way")
    longer = TEXTS[FOURBAR.name].replace("length_m = 0.25", "length_m = 0.26")
    known = study.told(at(10.0), {**TEXTS, FOURBAR.name: longer})
    assert refused(known, f"another scene {FOURBAR.name}")
    known = study.told(at(10.0, load_scene("whitworth")), scene_texts(["whitworth"]))
    assert known.refusals == ("whitworth: not in the study",)


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("gravity", f"gravity_m_s2 = [0.0, -9.81]\n{TEXTS[FOURBAR.name]}"),
        ("loads", f'{TEXTS[FOURBAR.name]}\n[loads.pull]\nlink = "crank"\ntorque_n_m = 1.0\n'),
    ],
)
def test_with_gravity_or_loads_it_serves_its_own_speed_alone(
    study: Study, kind: str, text: str
) -> None:
    scene, texts = parse_scene(text, kind), {**TEXTS, FOURBAR.name: text}
    manifest = replace(study.stored.manifest, scenes=texts)
    pulled = replace(study, stored=replace(study.stored, manifest=manifest))
    assert pulled.told(at(10.0, scene), texts).measured
    known = pulled.told(at(20.0, scene), texts)
    assert refused(known, f"has {kind}, and turns at 10 rad/s there")


def test_another_version_or_drive_does_not_serve(study: Study) -> None:
    for change, words in (
        ({"version": "0.9"}, "of mujoco 0.9; here it is"),
        ({"drive": "servo"}, "under the drive servo"),
    ):
        mujoco = [line for line in study.lines if line.engine == "mujoco"]
        changed = tuple(replace(line, **change) for line in mujoco)  # type: ignore[arg-type]
        assert refused(replace(study, lines=changed).told(at(10.0)), words)


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
    assert set(stored_scenes(study.stored)) == set(SCENES)
    found = {choice.label: choice for choice in stored_choices(study.lines)}
    for choice in (STIFF, SOFT, BIASED, UNBIASED):
        assert found[choice.label].settings == choice.settings
    settings = resolved(engine("mujoco").profiles["tuned"], None)
    line = next(line for line in study.lines if line.engine == "mujoco")
    for wrong in ({"nothing": 1}, {"iterations": 0}):
        assert stored_choices([replace(line, settings=settings | wrong)]) == []
