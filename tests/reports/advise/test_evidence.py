"""What a stored study says of settings at a speed and step, and where it says nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
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


@pytest.fixture(scope="module")
def stored(store: Path) -> Stored:
    return read_store(store)


@pytest.fixture(scope="module")
def every(stored: Stored) -> tuple[Line, ...]:
    return lines(stored)


def at(speed: float, *scenes: Scene) -> Demand:
    return demanded(scenes or (FOURBAR,), speed, 1e-3 * math.tau / abs(speed), 1e-3, 2.0)


def told(
    stored: Stored, every: tuple[Line, ...], demand: Demand, texts: Mapping[str, str] = TEXTS
) -> MeasuredStudy:
    return evidence(stored, every, demand, texts, EVERY.values())


def measured(every: tuple[Line, ...], choice: Choice, scene: str, steps: float) -> float:
    """The error that stands in the store."""
    (line,) = [
        line
        for line in every
        if (line.scene, f"{line.engine} {line.variant}") == (scene, choice.label)
    ]
    cells = line.cells
    return float(cells.loc[cells["steps_per_turn"].round(6) == steps, "place_pure"].iloc[0])


def test_at_its_own_steps_and_speed_it_says_what_was_measured(
    stored: Stored, every: tuple[Line, ...]
) -> None:
    known = told(stored, every, at(10.0))
    for choice in (STIFF, SOFT, BIASED, UNBIASED):
        for steps in STEPS:
            error = known.error(FOURBAR, choice, steps)
            assert error == pytest.approx(measured(every, choice, FOURBAR.name, steps), rel=1e-6)
    assert known.turns == pytest.approx(2.0)
    assert known.refusals == ()


def test_between_its_steps_it_reads_a_straight_line_and_outside_nothing(
    stored: Stored, every: tuple[Line, ...]
) -> None:
    known = told(stored, every, at(10.0))
    ends = [measured(every, STIFF, FOURBAR.name, steps) for steps in (180, 360)]
    middle = known.error(FOURBAR, STIFF, math.sqrt(180 * 360))
    assert middle == pytest.approx(math.sqrt(ends[0] * ends[1]), rel=1e-9)
    for steps in (STEPS[0] - 1.0, STEPS[-1] + 1.0):
        assert known.error(FOURBAR, STIFF, steps) is None
    assert known.error(FOURBAR, EVERY["mujoco RK4"], 360) is None


def test_at_another_speed_settings_in_seconds_say_nothing(
    stored: Stored, every: tuple[Line, ...]
) -> None:
    known = told(stored, every, at(0.3))
    for choice in (STIFF, UNBIASED):
        assert known.error(FOURBAR, choice, 360) == pytest.approx(
            measured(every, choice, FOURBAR.name, 360)
        )
    for choice in (SOFT, BIASED):
        assert known.error(FOURBAR, choice, 360) is None
    assert any(
        "mujoco as-shipped: solref_timeconst_s in seconds" in each for each in known.refusals
    )
    assert any("pymunk as-shipped: error_bias in seconds" in each for each in known.refusals)


def test_the_other_way_round_is_another_motion(stored: Stored, every: tuple[Line, ...]) -> None:
    known = told(stored, every, at(-10.0))
    assert known.measured == {}
    assert any("turns the other way" in each for each in known.refusals)


def test_another_scene_of_the_name_and_one_that_it_lacks_are_told(
    stored: Stored, every: tuple[Line, ...]
) -> None:
    longer = {
        **TEXTS,
        FOURBAR.name: TEXTS[FOURBAR.name].replace("length_m = 0.25", "length_m = 0.26"),
    }
    known = told(stored, every, at(10.0), longer)
    assert known.measured == {}
    assert any(f"another scene {FOURBAR.name}" in each for each in known.refusals)
    other = load_scene("whitworth")
    known = told(stored, every, at(10.0, other), scene_texts(["whitworth"]))
    assert known.refusals == ("whitworth: not in the study",)


def test_with_gravity_it_serves_its_own_speed_alone(
    stored: Stored, every: tuple[Line, ...]
) -> None:
    heavy = replace(FOURBAR, gravity_m_s2=(0.0, -9.81))
    text = TEXTS[FOURBAR.name].replace("[ground]", "gravity_m_s2 = [0.0, -9.81]\n[ground]", 1)
    texts = {**TEXTS, FOURBAR.name: text}
    weighed = replace(stored, manifest=replace(stored.manifest, scenes=texts))
    assert told(weighed, every, at(10.0, heavy), texts).measured
    known = told(weighed, every, at(20.0, heavy), texts)
    assert known.measured == {}
    assert any("has gravity, and turns at 10 rad/s there" in each for each in known.refusals)


def test_with_loads_it_serves_its_own_speed_alone(stored: Stored, every: tuple[Line, ...]) -> None:
    text = f'{TEXTS[FOURBAR.name]}\n[loads.pull]\nlink = "crank"\ntorque_n_m = 1.0\n'
    texts = {**TEXTS, FOURBAR.name: text}
    pulled = replace(stored, manifest=replace(stored.manifest, scenes=texts))
    known = told(pulled, every, at(20.0, parse_scene(text, "pulled")), texts)
    assert known.measured == {}
    assert any("has loads, and turns at 10 rad/s there" in each for each in known.refusals)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"version": "0.9"}, "of mujoco 0.9; here it is"),
        ({"drive": "servo"}, "under the drive servo"),
    ],
)
def test_another_version_or_drive_does_not_serve(
    stored: Stored, every: tuple[Line, ...], change: dict[str, str], words: str
) -> None:
    changed = tuple(replace(line, **change) for line in every if line.engine == "mujoco")  # type: ignore[arg-type]
    known = told(stored, changed, at(10.0))
    assert known.measured == {}
    assert any(words in each for each in known.refusals)


def test_beside_a_run_that_failed_nothing_is_read_and_finer_misses_are_known(
    stored: Stored, every: tuple[Line, ...]
) -> None:
    """The finest cell of pymunk "no bias" on the lever is said to have diverged."""
    lever = load_scene("slotted-lever")
    known = told(stored, every, at(10.0, lever))
    assert known.error(lever, UNBIASED, 359) is not None
    assert known.error(lever, UNBIASED, 400) is None
    assert known.missed(lever, UNBIASED, 100.0, 1.0) == pytest.approx(720.0)
    assert known.missed(lever, UNBIASED, 720.0 + 1e-6, 1.0) is None
    assert known.missed(lever, STIFF, 100.0, 1.0) is None


def test_its_scenes_and_settings_are_choices(stored: Stored, every: tuple[Line, ...]) -> None:
    assert set(stored_scenes(stored)) == set(SCENES)
    found = {choice.label: choice for choice in stored_choices(every)}
    for choice in (STIFF, SOFT, BIASED, UNBIASED):
        assert found[choice.label].settings == choice.settings


def test_settings_that_an_engine_does_not_take_are_no_choice(every: tuple[Line, ...]) -> None:
    settings = resolved(engine("mujoco").profiles["tuned"], None)
    for wrong in ({"nothing": 1}, {"iterations": 0}):
        line = replace(next(x for x in every if x.engine == "mujoco"), settings=settings | wrong)
        assert stored_choices([line]) == []


def test_an_error_of_zero_is_read_as_such() -> None:
    assert MeasuredSteps(((90.0, 1e-3), (180.0, 0.0))).error(180.0) == 0.0
