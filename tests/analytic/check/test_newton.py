"""The closed form against the second opinion: two computations, one mechanism."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest
from hypothesis import given

import analytic
from analytic import kinematics
from analytic.check.constraints import Constraints
from analytic.check.newton import Guess
from analytic.dyads.parts import MovingLine
from analytic.dyads.plane import EPS, Real, Vec
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene, shipped
from models.motion import Motion
from models.scene import Scene
from tests.analytic.chain import coordinates
from tests.analytic.imported import reached
from tests.analytic.test_bounds import SIX
from tests.worlds.strategies import FORMS, OF_EACH_KIND, Designed, examples, mechanisms, swing_times
from tests.worlds.tiers import at_length, slowly

ROUNDINGS = 30.0


def rough_guess(scene: Scene, motion: Motion) -> Guess:
    """The first position, to two decimals of the longest link and of a radian."""
    system, unit = Constraints(scene), 0.01 * scene.longest_m
    q = coordinates(scene, motion, 0)
    rounded = [round(c / u) * u for c, u in zip(q, (unit, unit, 0.01) * (len(q) // 3), strict=True)]
    return Guess({body: (*rounded[at : at + 3],) for body, at in system.at.items()})  # type: ignore[misc]


def both(scene: Scene, time_s: Array, guess: Guess | None = None) -> tuple[Motion, Motion]:
    closed = kinematics.solve(scene, time_s)
    return closed, analytic.check.newton.solve(scene, time_s, guess or rough_guess(scene, closed))


def newton_rounding(scene: Scene, motion: Motion) -> tuple[Array, Array, Array]:
    """What Newton's own rounding may come to at each level, over lengths and radians (T,).

    With lengths over the longest link, and S the norm of the inverse Jacobian: rounding of the
    constraints is eps times the largest coordinate; positions lose S, rates S again on the error of
    the Jacobian, accelerations S once more.
    """
    system, unit = Constraints(scene), scene.longest_m
    columns = np.tile([unit, unit, 1.0], system.size // 3)
    position, rate, second = (np.empty(len(motion.time_s)) for _ in range(3))
    for i in range(len(motion.time_s)):
        q = np.array(coordinates(scene, motion, i))
        jacobian = system.jacobian(q) * columns
        jacobian /= np.abs(jacobian).max(axis=1, keepdims=True)
        s = 1.0 + float(np.linalg.norm(np.linalg.inv(jacobian), np.inf))
        size = 1.0 + float(np.abs(q / columns).max())
        speed = max(float(np.abs(m.omega[i])) for m in motion.links.values())
        speed = max([speed, *(_fast(p.velocity[i]) / unit for p in motion.points.values())])
        gain = max(float(np.abs(m.alpha[i])) for m in motion.links.values())
        gain = max([gain, *(_fast(p.acceleration[i]) / unit for p in motion.points.values())])
        position[i] = ROUNDINGS * EPS * s * size
        rate[i] = position[i] * s * speed
        second[i] = position[i] * s * (gain + s * speed**2)
    return position, rate, second


def _fast(vector: Array) -> float:
    return math.hypot(float(vector[0]), float(vector[1]))


def _apart(value: Array, other: Array, *, turning: bool = False) -> Array:
    apart = value - other
    if turning:
        apart = apart - math.tau * np.round(apart / math.tau)
    return np.abs(apart) if apart.ndim == 1 else np.hypot(apart[:, 0], apart[:, 1])


def disagreement(scene: Scene, closed: Motion, newton: Motion) -> float:
    """The largest difference of the two, over what the bound and Newton's rounding allow."""
    allowed, worst = newton_rounding(scene, closed), 0.0
    kinds: tuple[tuple[Mapping[str, object], ...], ...] = (
        (closed.links, newton.links, closed.bound.links),
        (closed.points, newton.points, closed.bound.points),
        (closed.sliders, newton.sliders, closed.bound.sliders),
    )
    for kind, (ours, others, bounds) in enumerate(kinds):
        assert ours.keys() == others.keys() == bounds.keys()
        unit = 1.0 if kind == 0 else scene.longest_m
        for name in ours:
            levels = zip(*(vars(m[name]).values() for m in (ours, others, bounds)), strict=True)
            for level, (value, other, bound) in enumerate(levels):
                apart = _apart(value, other, turning=kind == 0 and level == 0)
                assert np.isfinite(apart).all()
                worst = max(worst, float(np.max(apart / (bound + unit * allowed[level]))))
    return worst


@pytest.mark.parametrize(
    ("name", "samples"),
    [
        *((name, 11) for name in SIX),
        *(
            slowly(name, 73, reason="shapes of the same dyads, all over the turn")
            for name in shipped()
        ),
    ],
)
def test_closed_form_and_newton_agree_over_a_period(name: str, samples: int) -> None:
    scene = load_scene(name)
    closed, newton = both(scene, swing_times(scene, samples))
    assert disagreement(scene, closed, newton) <= 1.0
    if {group.kind for group in analyse(scene).groups} == {"RPP"}:
        return  # linear in its coordinates: on some processors Newton's step ends on the same bits
    same = [np.array_equal(a, b) for a, b in zip(_numbers(closed), _numbers(newton), strict=True)]
    assert not all(same), "bit for bit the same: is it the same computation?"


def _numbers(motion: Motion) -> list[Array]:
    """Every array of a motion."""
    tracks = [*motion.links.values(), *motion.points.values(), *motion.sliders.values()]
    return [array for track in tracks for array in vars(track).values()]


def _hold_to_newton(designed: Designed) -> None:
    """From a guess of two decimals, over a swing: same mechanism, same assembly, same motion."""
    scene = designed.scene
    closed = kinematics.solve(scene, swing_times(scene, 9))
    rough = {
        body: (round(x, 2), round(y, 2), round(a, 2)) for body, (x, y, a) in designed.frames.items()
    }
    newton = analytic.check.newton.solve(scene, closed.time_s, Guess(rough))
    assert disagreement(scene, closed, newton) <= 1.0


@pytest.mark.parametrize(
    ("form", "count"),
    [
        *((form, 2) for form in OF_EACH_KIND),
        *(slowly(form, 4, reason="every role of a link, a block and a guide") for form in FORMS),
    ],
)
def test_every_form_of_dyad_agrees_with_newton(form: str, count: int) -> None:
    @examples(count)
    @given(mechanisms([form]))
    def hold(designed: Designed) -> None:
        assert analyse(designed.scene).groups[-1].kind == form[:3]
        _hold_to_newton(designed)

    hold()


MORE = slowly(500, reason="rare chains")
MOST = at_length(2_000, reason="rarer chains, a minute and a half")


@pytest.mark.parametrize("count", [5, MORE, MOST])
def test_chains_of_random_dyads_agree_with_newton(count: int) -> None:
    examples(count)(given(mechanisms())(_hold_to_newton))()


def test_forms_cover_every_kind_and_role() -> None:
    """Blocks, sliding links, and guides that are themselves unknown, for each kind that slides."""
    assert {form[:3] for form in FORMS} == {"RRR", "RRP", "RPR", "PRP", "RPP"}
    for kind in ("RRP", "RPR", "PRP", "RPP"):
        said = " ".join(form for form in FORMS if form.startswith(kind))
        assert all(role in said for role in ("block", "link", "guide"))


def test_neither_computation_imports_the_other() -> None:
    closed, newton = (reached(f"analytic.{m}") for m in ("kinematics", "check.newton"))
    assert {f"analytic.dyads.{kind}" for kind in ("rrr", "rrp", "rpr", "prp", "rpp")} <= closed
    assert "analytic.check.newton" not in closed
    assert {"analytic.check.constraints", "analytic.multibody.assembly"} <= newton
    assert not closed & newton


def test_fault_planted_in_the_closed_form_makes_them_disagree(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    right = MovingLine.acceleration

    def wrong(line: MovingLine, s: Real, speed: Real) -> Vec:
        return right(line, s, -speed)  # Coriolis with the wrong sign

    scene = load_scene("tangent")
    monkeypatch.setattr(MovingLine, "acceleration", wrong)
    assert disagreement(scene, *both(scene, swing_times(scene, 9))) > 1e6


def test_fault_planted_in_newton_makes_them_disagree(monkeypatch: pytest.MonkeyPatch) -> None:
    right = Constraints.gamma

    def wrong(system: Constraints, q: Array, rates: Array, alpha: float) -> Array:
        return right(system, q, rates * (1.0 + 1e-6), alpha)

    scene = load_scene("slotted-lever")
    monkeypatch.setattr(Constraints, "gamma", wrong)
    assert disagreement(scene, *both(scene, swing_times(scene, 9))) > 1e3


def test_newton_says_when_a_guess_leads_nowhere() -> None:
    scene = load_scene("fourbar-lecture-1")
    nowhere = Guess(dict.fromkeys(scene.links, (0.0, 0.0, 0.0)))
    with pytest.raises(CrankcheckError, match=r"fourbar-lecture-1: .*deg"):
        analytic.check.newton.solve(scene, np.zeros(1), nowhere)
