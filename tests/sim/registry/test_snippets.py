"""Snippets leave alone what they are pasted beside."""

import math
import re
from collections.abc import Iterator
from typing import get_args

import pytest

from sim.engine import Drive, Settings, SettingValue
from sim.engine.settings import resolved
from sim.registry import engine, offering
from sim.registry.offers import Stepping, frame_snippet, search_space, snippet
from tests.worlds.bare import BARE, measured_as_we_did, measured_in_exudyn
from tests.worlds.tiers import slowly
from tests.worlds.workshop import DISTURBANCE, mujoco_disturbance

SAME = 1e-9
"""m, rad: what a solver leaves that stops at 1e-12."""
COARSEST = 1.0
"""rad, above which no target is."""
STEPS = (
    (90.0, 6),
    slowly(90.0, 1, reason="each of some forty texts of an engine: 1 s"),
)
"""Steps per turn, and of how many texts one is tried."""
ENGINES = offering("snippet")
OTHER: dict[str, SettingValue] = {
    "integrator": "RK4", "solver": "CG", "islands": "disable", "contact": "disable", "close": "C",
    "servo_integrator": "implicit", "lines": "exact", "springs": "forces", "free_paths": "arcs",
    "jacobian": "each-step", "adaptive_step": "disable", "linear_solver": "EigenDense",
    "ignore_singular": "enable", "residual": "increments",
}  # fmt: skip
"""Other words than the engines' defaults; for numbers half of them and one more."""


def other(name: str, value: SettingValue) -> SettingValue:
    if isinstance(value, str):
        words = OTHER[name]
        return "TrapezoidalIndex2" if value == "GeneralizedAlpha" else words
    return type(value)(value / 2 + 1)


def settings_of(name: str) -> Iterator[Settings]:
    """Every profile; every setting of another value; every knob of a search turned as far as it
    goes, from all starts."""
    for profile in engine(name).profiles.values():
        yield resolved(profile, None)
    shipped = resolved(engine(name).profiles["as-shipped"], None)
    for setting, value in shipped.items():
        yield shipped | {setting: other(setting, value)}
    tuned = resolved(engine(name).profiles["tuned"], None)
    space = search_space(name).around(tuned)
    for start in space.starts:
        yield space.settings(tuned, start)
        for knob in space.knobs:
            for value in (knob.values[0], knob.values[-1]) if knob.ordered else knob.values:
                yield space.settings(tuned, {**start, knob.name: value})


@pytest.mark.parametrize(("steps", "every"), STEPS)
@pytest.mark.parametrize("name", ENGINES)
def test_box_and_free_body_do_beside_a_snippet_what_they_did(
    name: str, steps: float, every: int
) -> None:
    assert set(DISTURBANCE) == set(ENGINES)
    texts = {
        snippet(name, settings, steps, drive=drive)
        for settings in settings_of(name)
        for drive in get_args(Drive)
    }
    assert len(texts) > 20
    for text in sorted(texts)[::every]:
        disturbed = DISTURBANCE[name](text).worst
        # Settings with which the mechanism alone comes apart are what nothing advises.
        assert disturbed < SAME or BARE[name](text, round(steps), 10.0) > COARSEST, text


HARMS = {
    "contacts off": (
        "mujoco", {}, lambda text: text + '<option><flag contact="disable"/></option>'),
    "few iterations for all": ("mujoco", {"iterations": 1}, measured_as_we_did),
    "all that we measure with": ("mujoco", None, measured_as_we_did),
    "bias for all joints": (
        "pymunk", {"error_bias": 0.0},
        lambda text: text.replace("in joints", "in space.constraints")),
    "damping for all": ("pymunk", {"damping": 0.9}, measured_as_we_did),
    "an early end for all": ("exudyn", {"relative_tolerance": 1e-3}, measured_in_exudyn),
}  # fmt: skip


@pytest.mark.parametrize("harm", HARMS)
def test_what_would_change_them_is_seen(harm: str) -> None:
    name, settings, change = HARMS[harm]
    if settings is None:
        settings = resolved(engine(name).profiles["tuned"], None)
    text = snippet(name, settings, 360.0)
    assert change(text) != text
    assert DISTURBANCE[name](change(text)).worst > 1e2 * SAME


@pytest.mark.parametrize("name", ENGINES)
def test_for_a_program_with_frames_the_settings_are_the_same(name: str) -> None:
    """All but the comments and the loop over the steps of a frame."""
    substeps, period_s = 3, 2.0 * math.pi / 7.0
    dt_s = 0.0166667 / substeps
    for settings in settings_of(name):
        plain = in_force(snippet(name, settings, period_s / dt_s, period_s))
        frames = frame_snippet(name, settings, Stepping(period_s, dt_s, substeps))
        kept = [line for line in in_force(frames) if not line.startswith("for _ in range(")]
        assert len(kept) == len(plain)
        assert all(same(*lines) for lines in zip(kept, plain, strict=True))
        assert repr(dt_s) in frames
        steps = (f"range({substeps})", f"nstep={substeps})", f"numberOfSteps = {substeps}.")
        assert any(each in frames for each in steps)


def in_force(text: str) -> list[str]:
    """The lines without comments."""
    bare = re.sub(r"<!--.*?-->|#.*", "", text, flags=re.DOTALL if "<!--" in text else 0)
    return [line.strip() for line in bare.splitlines() if line.strip()]


def same(line: str, other: str) -> bool:
    """The same words, and numbers that are rounded otherwise at most."""
    number = r"\d+\.?\d*(?:e[-+]?\d+)?"
    if re.split(number, line) != re.split(number, other):
        return False
    pairs = zip(re.findall(number, line), re.findall(number, other), strict=True)
    return all(math.isclose(float(a), float(b), rel_tol=1e-12) for a, b in pairs)


def test_what_redundant_joints_need_is_said_where_the_solver_is_chosen_by_need() -> None:
    words = "Where joints are redundant"
    tuned = resolved(engine("exudyn").profiles["tuned"], None)
    assert tuned["linear_solver"] == "by-need"
    for solver, said in (("by-need", True), ("EigenDense", False)):
        text = snippet("exudyn", {**tuned, "linear_solver": solver}, 360.0)
        assert (words in text) == said


def test_a_snippet_says_what_softens_contacts_and_takes_no_passes_away() -> None:
    """MuJoCo takes two steps at least for the time constant of any constraint (refsafe)."""
    assert "softer" in snippet("mujoco", {}, 62.0)
    assert "softer" not in snippet("mujoco", {}, 63.0)
    assert mujoco_disturbance(snippet("mujoco", {}, 50.0)).lasting > SAME
    text = snippet("pymunk", {"iterations": 20}, 360.0)
    assert "max(space.iterations, 20)" in text
    assert "space.iterations" not in snippet("pymunk", {"iterations": 10}, 360.0)
