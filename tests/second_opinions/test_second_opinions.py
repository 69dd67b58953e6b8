"""The closed form against the second opinion, and what falls freely against its closed form."""

import ast
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

from analytic import kinematics
from analytic.dyads.parts import MovingLine
from analytic.dyads.plane import EPS
from analytic.free.exact_motions import ChainMotion
from analytic.structure.mobility import analyse
from models.array import Array
from models.files.reading import load_scene, shipped
from models.motion import Motion
from models.scene import Scene
from models.scene.hard import WindowChain
from models.scene.joints import centre_of, frames
from reports.contract.oscillators import centres
from tests.analytic.chain import coordinates
from tests.analytic.test_bounds import SIX
from tests.second_opinions import newton
from tests.second_opinions.constraints import Constraints
from tests.second_opinions.newton import Guess
from tests.worlds.strategies import FORMS, OF_EACH_KIND, Designed, examples, mechanisms, swing_times
from tests.worlds.tiers import at_length, slowly

ROUNDINGS = 30.0


def rough_guess(scene: Scene, motion: Motion) -> Guess:
    """The first position, to two decimals of the longest link and of a radian."""
    system, unit = Constraints(scene), 0.01 * scene.longest_m
    q = coordinates(scene, motion, 0)
    rounded = [round(c / u) * u for c, u in zip(q, (unit, unit, 0.01) * (len(q) // 3), strict=True)]
    return Guess({body: (*rounded[at : at + 3],) for body, at in system.at.items()})


def both(scene: Scene, time_s: Array) -> tuple[Motion, Motion]:
    closed = kinematics.solve(scene, time_s)
    return closed, newton.solve(scene, time_s, rough_guess(scene, closed))


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
        links, points = motion.links.values(), motion.points.values()
        speed = max(abs(m.omega[i]) for m in links)
        speed = max([speed, *(math.hypot(*p.velocity[i]) / unit for p in points)])
        gain = max(abs(m.alpha[i]) for m in links)
        gain = max([gain, *(math.hypot(*p.acceleration[i]) / unit for p in points)])
        position[i] = ROUNDINGS * EPS * s * size
        rate[i] = position[i] * s * speed
        second[i] = position[i] * s * (gain + s * speed**2)
    return position, rate, second


def _apart(value: Array, other: Array, *, turning: bool = False) -> Array:
    apart = value - other
    if turning:
        apart = apart - math.tau * np.round(apart / math.tau)
    return np.abs(apart) if apart.ndim == 1 else np.hypot(apart[:, 0], apart[:, 1])


def disagreement(scene: Scene, closed: Motion, second: Motion) -> float:
    """The largest difference of the two, over what the bound and Newton's rounding allow."""
    allowed, worst = newton_rounding(scene, closed), 0.0
    for kind in ("links", "points", "sliders"):
        ours, others, bounds = (getattr(one, kind) for one in (closed, second, closed.bound))
        assert ours.keys() == others.keys() == bounds.keys()
        unit = 1.0 if kind == "links" else scene.longest_m
        for name in ours:
            levels = zip(*(vars(m[name]).values() for m in (ours, others, bounds)), strict=True)
            for level, (value, other, bound) in enumerate(levels):
                apart = _apart(value, other, turning=(kind, level) == ("links", 0))
                assert np.isfinite(apart).all()
                worst = max(worst, float(np.max(apart / (bound + unit * allowed[level]))))
    return worst


@pytest.mark.parametrize(
    ("name", "samples"),
    [
        *((name, 3) for name in SIX[2:]),  # the dyads of the first two are among theirs
        *(
            slowly(name, 73, reason="shapes of the same dyads, all over the turn")
            for name in shipped()
        ),
    ],
)
def test_closed_form_and_newton_agree_over_a_period(name: str, samples: int) -> None:
    scene = load_scene(name)
    closed, second = both(scene, swing_times(scene, samples))
    assert disagreement(scene, closed, second) <= 1.0
    if {group.kind for group in analyse(scene).groups} == {"RPP"}:
        return  # linear in its coordinates: on some processors Newton's step ends on the same bits
    same = [np.array_equal(a, b) for a, b in zip(_numbers(closed), _numbers(second), strict=True)]
    assert not all(same), "bit for bit the same: is it the same computation?"


def _numbers(motion: Motion) -> list[Array]:
    tracks = [*motion.links.values(), *motion.points.values(), *motion.sliders.values()]
    return [array for track in tracks for array in vars(track).values()]


def _hold_to_newton(designed: Designed) -> None:
    """From a guess of two decimals, over a swing: same mechanism, same assembly, same motion."""
    scene = designed.scene
    closed = kinematics.solve(scene, swing_times(scene, 9))
    rough = {body: tuple(round(c, 2) for c in frame) for body, frame in designed.frames.items()}
    assert disagreement(scene, closed, newton.solve(scene, closed.time_s, Guess(rough))) <= 1.0


@pytest.mark.parametrize(
    ("form", "count"),
    [
        *((form, 1) for form in OF_EACH_KIND),
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


@pytest.mark.parametrize(
    "count",
    [
        slowly(500, reason="rare chains"),
        at_length(2_000, reason="rarer chains, a minute and a half"),
    ],
)
def test_chains_of_random_dyads_agree_with_newton(count: int) -> None:
    examples(count)(given(mechanisms())(_hold_to_newton))()


ROOT = Path(__file__).parents[2]
OURS = ("analytic", "tests.second_opinions")


def reached(module: str) -> set[str]:
    """The modules of `analytic`, and second opinions, that a module imports, so that two
    computations are shown to be two."""
    found, todo = set[str](), [module]
    while todo:
        name = todo.pop()
        path = ROOT.joinpath(*name.split(".")).with_suffix(".py")
        if name in found or not path.is_file():
            continue
        found.add(name)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith(OURS):
                todo += [str(node.module), *(f"{node.module}.{a.name}" for a in node.names)]
    return found


def test_neither_computation_imports_the_other() -> None:
    closed, second = map(reached, ("analytic.kinematics", "tests.second_opinions.newton"))
    assert {f"analytic.dyads.{kind}" for kind in ("rrr", "rrp", "rpr", "prp", "rpp")} <= closed
    assert "tests.second_opinions.newton" not in closed
    assert {"tests.second_opinions.constraints", "analytic.multibody.assembly"} <= second
    assert not closed & second


CORIOLIS, GAMMA, LEVER = MovingLine.acceleration, Constraints.gamma, "slotted-lever"


@pytest.mark.parametrize(
    ("owner", "method", "wrong", "name", "least"),
    [
        (MovingLine, "acceleration", lambda line, s, v: CORIOLIS(line, s, -v), "tangent", 1e6),
        (Constraints, "gamma", lambda s, q, v, a: GAMMA(s, q, v * (1 + 1e-6), a), LEVER, 1e3),
    ],
)
def test_a_planted_fault_makes_them_disagree(
    owner: type, method: str, wrong: object, name: str, least: float, monkeypatch
) -> None:
    scene = load_scene(name)
    monkeypatch.setattr(owner, method, wrong)
    assert disagreement(scene, *both(scene, swing_times(scene, 4))) > least


@pytest.mark.parametrize("chain", [WindowChain(1), WindowChain(3, 0.5, 2.0, 3.0, -0.7)])
def test_a_chain_of_windows_falls_as_its_closed_form(chain: WindowChain) -> None:
    free, scene = ChainMotion(chain), chain.scene()
    duration_s = 0.1 * free.period_s
    motion = free.motion(np.array([0.0, duration_s]))
    placed = frames(scene, motion.state(1))
    for name, place in centres(scene, motion.state(0), duration_s, 40).items():
        wanted = placed[name].at(centre_of(scene, name))
        assert place == pytest.approx(wanted, abs=1e-5 * chain.length_m)
