"""The integration of driven elastic links, against a library's method and by its energy."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

from analytic.elastic import vibration
from analytic.elastic.discretisation import Elements, Modes, Polynomials, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.reduced import ReducedForm
from analytic.elastic.tangent import SlopesOverWindows, tangent
from analytic.elastic.vibration import vibrate
from analytic.free.gauss import gauss
from models.elastic import Shape
from models.errors import CrankcheckError
from models.files import load_scene
from models.laws import FromRest
from models.scene import Scene
from tests.analytic.elastic.driven import FEW as TURNING
from tests.analytic.elastic.driven import form_of as turning_form
from tests.analytic.elastic.driven import fourbar, with_elastic
from tests.analytic.elastic.driven import turning as turning_fourbar
from tests.worlds.tiers import slowly

STEPS = "many steps of the library: the equations are the same"


def form_of(scene: Scene, by: Polynomials | Modes | Segments) -> ReducedForm:
    return DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True).form


def by_a_library(form: ReducedForm, until_s: float) -> np.ndarray:
    """The coefficients and rates at the end, from a straight start."""
    m = form.size

    def slope(time_s: float, state: np.ndarray) -> np.ndarray:
        at = np.array([time_s])
        now = form.at(at, state[None, :m], state[None, m:], form.near(at))
        return np.concatenate([state[m:], now.seconds[0]])

    run = solve_ivp(slope, (0.0, until_s), np.zeros(2 * m), method="DOP853", rtol=1e-9, atol=1e-12)
    return np.asarray(run.y[:, -1])


@pytest.mark.parametrize(
    ("scene", "by", "until"),
    [
        (fourbar(damping_s=1e-3), Polynomials(2), 0.015),
        slowly(fourbar(damping_s=1e-3), Polynomials(2), 0.03, reason=STEPS),
        slowly(load_scene("slider-crank-elastic"), Modes(2), 0.03, reason=STEPS),
        slowly(fourbar(), Segments(3), 0.03, reason=STEPS),
    ],
)
def test_a_straight_start_rings_as_a_library_integrates_it(
    scene: Scene, by: Polynomials | Modes | Segments, until: float
) -> None:
    form = form_of(scene, by)
    expected = by_a_library(form, until)
    still = np.zeros(form.size)
    history = vibrate(form, still, still, until, 6)
    z, rates, _ = (own[0] for own in history.at(np.array([until])))
    assert z == pytest.approx(expected[: form.size], abs=1e-7 * np.abs(z).max())
    assert rates == pytest.approx(expected[form.size :], abs=1e-7 * np.abs(rates).max())


@pytest.mark.parametrize("count", [5, slowly(6, reason="shapes that ring faster")])
def test_windows_end_at_kinks_and_in_between_the_motion_is_smooth(count: int) -> None:
    scene = fourbar()
    rise = 0.31
    law = FromRest(scene.driver.law.offset_rad, 8.0, rise)
    scene = replace(scene, driver=replace(scene.driver, law=law))
    motion = DrivenElasticMotion(scene, 0.6, Polynomials(count), "straight", stiffened=True)
    edges = motion.history.edges_s
    assert rise in edges
    assert len(edges) >= 16
    time_s = np.linspace(0.0, 0.6, 41)
    assert (
        motion.doubt(time_s).middle_m["coupler"].max()
        < 1e-5 * np.abs(motion.at(time_s).elastic["coupler"].middle).max()
    )


ENERGY = {
    "four-bar": fourbar(),
    "both, damped": fourbar(axial_n=3e4, damping_s=2e-4),
    "slider-crank, damped": with_elastic(load_scene("slider-crank-elastic"), damping_s=1e-3),
}
STARTS: tuple[Shape, ...] = ("straight", "quasi-static", "periodic")


@pytest.mark.parametrize(
    ("name", "start"),
    [
        case
        if case in (("both, damped", "straight"), ("slider-crank, damped", "periodic"))
        else slowly(*case, reason="a third of a second each: any start of any scene does")
        for case in itertools.product(ENERGY, STARTS)
    ],
)
def test_the_drive_gives_what_energy_and_damping_take(name: str, start: Shape) -> None:
    scene = ENERGY[name]
    until = 0.3
    motion = DrivenElasticMotion(scene, until, Polynomials(3, 1), start, stiffened=True, halved=2)
    rule, edges = gauss(10), np.linspace(0.0, until, 129)
    span = edges[1] - edges[0]
    time_s = (edges[:-1, None] + span * rule.places).ravel()
    form = motion.form

    def energy(at: float) -> float:
        now, _ = motion.instant(np.array([at]))
        q, rates = now.now.q, now.now.rates
        kinetic = 0.5 * rates[0] @ form.assembly.mass(q)[0] @ rates[0]
        return float(kinetic + form.assembly.height_energy(q)[0])

    now, seconds = motion.instant(time_s)
    _, torque = form.reactions(time_s, now, seconds)
    lost = sum(body.lost(now.now.rates[:, own]) for body, own in form.assembly.elastic.values())
    power = torque * form.law.at(time_s)[1] - lost
    given = span * np.sum(power.reshape(-1, 10) @ rule.end_once)
    flow = span * np.sum(np.abs(power).reshape(-1, 10) @ rule.end_once)
    assert energy(until) - energy(0.0) == pytest.approx(given, abs=1e-9 * flow)


def test_what_bends_too_far_is_refused_with_words() -> None:
    soft = with_elastic(fourbar(), flexural_n_m2=1e-2)
    motion = DrivenElasticMotion(soft, 0.1, Polynomials(3), "quasi-static", stiffened=True)
    with pytest.raises(CrankcheckError, match=r"coupler bends by 0\.\d+ of its length.*stiffer"):
        motion.at(np.linspace(0.0, 0.1, 5))


def test_a_link_that_hardly_bends_takes_no_more_windows_than_it_needs() -> None:
    stiff = with_elastic(fourbar(), flexural_n_m2=1e12)
    motion = DrivenElasticMotion(stiff, 0.01, Polynomials(3), "quasi-static", stiffened=True)
    middle = motion.at(np.linspace(0.0, 0.01, 5)).elastic["coupler"].middle
    assert 0.0 < np.abs(middle).max() < 1e-13
    assert len(motion.history.z) < 30


@pytest.mark.parametrize(
    "by", [Modes(1, 0), slowly(TURNING, reason="a link that rings along itself as well")]
)
def test_a_window_that_is_too_long_is_halved(by: Modes) -> None:
    form = turning_form(turning_fourbar(1.3), by)
    still = np.zeros(form.size)
    long, short = (vibrate(form, still, still, form.period_s, count) for count in (2, 30))
    middle = np.array([0.5 * form.period_s])
    assert len(long.edges_s) > 3
    assert long.at(middle)[0][0, 0] == pytest.approx(short.at(middle)[0][0, 0], rel=1e-3)


def test_what_is_stiff_is_met_as_well_as_rounding_lets_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Elements whose highest frequencies are a thousand times the first: what rounding leaves of
    the accelerations may be large, next to them."""
    taken = []

    def counted(*own: object) -> SlopesOverWindows:
        taken.append(own)
        return tangent(*own)  # type: ignore[arg-type]

    monkeypatch.setattr(vibration, "tangent", counted)
    motion = DrivenElasticMotion(fourbar(), 0.2, Elements(8), "quasi-static", stiffened=True)
    blocks = len(motion.history.z) / vibration.BLOCK
    assert len(taken) <= 2 * math.ceil(blocks)
