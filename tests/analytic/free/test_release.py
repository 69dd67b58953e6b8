"""Free motion against a second method, by its energy, of the mechanism turned, moved, mirrored,
larger or faster; and of several freedoms, by all bodies."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.free.free_motion import FreeMotion
from analytic.free.machine import Machine
from analytic.free.release import release
from analytic.free.solved_motion import BodiesMotion, MachineMotion
from analytic.multibody.multibody_motion import Projection
from models.errors import CrankcheckError, StructureError
from models.files.reading import load_scene, parse_scene
from models.scene import Scene, Start
from models.scene.characteristics import Constant, Pulse, Staircase
from models.scene.loads import ConstantFriction, CoulombFriction, LineSpring, Load, PinSpring
from models.scene.tabulated import Tabulated
from tests.analytic.free.mechanisms import fourbar, past_limits, released, slider_crank
from tests.analytic.multibody.scenes import DOUBLE_PENDULUM, by_bodies
from tests.analytic.multibody.scenes import scene as parsed
from tests.worlds.let_go import EVERYTHING
from tests.worlds.loading import massless
from tests.worlds.other_way import MOVES, faster
from tests.worlds.tiers import slow, slowly


def torque(characteristic: object, over: str = "time") -> dict[str, Load]:
    return {"motor": Load("motor", "crank", None, characteristic, over)}  # type: ignore[arg-type]


SPRINGS = {
    "line": LineSpring("line", 200.0, 1.0, 0.1, ("A", "C")),
    "pin": PinSpring("pin", 0.5, 0.01, 0.0, "A", ("ground", "crank")),
}
RUBBING = {"C": ConstantFriction("C", 0.02)}
TABLE = Tabulated((0.0, 1.0, 2.5, 4.0), (0.1, 0.6, 0.3, 0.1), "linear", math.tau)
KINKED = {
    "pulse": (replace(fourbar(), loads=torque(Pulse(0.5, 0.1, 0.05))), 2),
    "steps": (replace(fourbar(), loads=torque(Staircase((0.1, 0.2), (0.2, -0.4)))), 2),
    "table over the angle": (replace(fourbar(), loads=torque(TABLE, "angle")), 1),
}


@pytest.mark.parametrize("name", KINKED)
def test_loads_with_kinks_are_integrated_from_kink_to_kink(name: str) -> None:
    scene, least = KINKED[name]
    free = released(scene, 0.4)
    assert len(free.edges_s) >= least
    assert {*free.edges_s} <= {window.end_s for window in free.history.windows}
    if name == "table over the angle":
        at = np.remainder(free.law.at(np.array(free.edges_s))[0], math.tau)
        places = np.array(TABLE.places)
        assert np.abs(at[:, None] - places).min(axis=1).max() < 1e-12
    assert_balanced(free)


def assert_balanced(free: FreeMotion) -> None:
    energy = free.energy(np.linspace(0.0, free.until_s, 101))
    off = np.abs(energy.balance - energy.balance[0])
    assert off.max() <= 1e-11 * energy.kinetic.max()


@pytest.mark.parametrize(
    "scene",
    [past_limits(), replace(fourbar(), springs=SPRINGS), replace(fourbar(), friction=RUBBING)],
    ids=["limits", "springs", "friction"],
)
def test_energy_balances(scene: Scene) -> None:
    assert_balanced(released(scene, 0.4))


@slow("rare: a spring that is led through the length of 0")
def test_a_spring_whose_ends_meet_turns_over() -> None:
    """The slider comes through the other end of its spring twice a turn; the pull jumps there."""
    across = LineSpring("across", 40.0, 0.1, 0.05, ("E", "C"))
    scene = slider_crank(offset=0.0, start_deg=30.0, speed_rad_s=12.0)
    ground = {**scene.ground, "E": (0.3, 0.0)}
    free = release(replace(scene, ground=ground, springs={"across": across}), 1.0)
    points = free.at(np.array(free.edges_s)).points
    apart = np.abs(points["C"].position - points["E"].position).max(axis=1)
    assert np.count_nonzero(apart < 1e-13) >= 3
    time_s = np.linspace(0.0, 1.0, 401)
    energy = free.energy(time_s)
    assert np.ptp(energy.balance) <= 1e-12 * energy.kinetic.max()
    assert free.error_rad(time_s).max() <= 1e-12


@slow("ten seconds of motion, twice: only so long a nudge grows by as much")
@pytest.mark.parametrize(("start_deg", "growth"), [(0.0, 82.3), (90.0, 365.0)])
def test_the_sensitivity_is_what_a_nudge_grows_by(start_deg: float, growth: float) -> None:
    scene, time_s = fourbar(start_deg=start_deg), np.linspace(0.0, 10.0, 20001)
    free = release(scene, 10.0)
    nudged = release(fourbar(start_deg=start_deg + math.degrees(1e-7)), 10.0)
    grown = np.abs(nudged.law.at(time_s)[0] - free.law.at(time_s)[0]).max() / 1e-7
    assert grown == pytest.approx(growth, rel=0.01)
    assert free.sensitivity(time_s[-1:])[0] == pytest.approx(grown, rel=0.03)


def test_where_a_stroke_lets_it_go_both_ways_it_goes_where_it_is_pushed_without() -> None:
    """At rest no stroke has begun. Weights pull the block back; on its way forward a load would
    push it on."""
    scene = slider_crank()
    push = Load("push", "block C", "C", Constant(100.0), "time", "C", "forward")
    assert release(scene, 0.05).at(np.array([0.05])).sliders["C"].speed[0] < 0.0
    pushed = replace(scene, loads={"push": push})
    at, bodies = (let_go(pushed, 0.05).at(np.array([0.05])) for let_go in (release, by_bodies))
    assert at.sliders["C"].speed[0] < 0.0
    assert bodies.links["crank"].theta[0] == pytest.approx(at.links["crank"].theta[0], abs=1e-11)


def test_a_kink_may_come_with_the_end_and_be_foretold_beyond_the_reach() -> None:
    """A rotor comes to a row of a table within rounding of the end of its time."""
    scene = replace(fourbar(start_deg=0.0, speed_rad_s=30.0), loads=torque(TABLE, "angle"))
    edge = release(scene, 0.05).edges_s[0]
    for end in (edge, math.nextafter(edge, 1.0), edge + 1e-14):
        assert release(scene, end).until_s == end
    # A stiff damper brakes by so much that the tangent of the start leaves the range.
    damper = PinSpring("damper", 0.0, 2e3, 0.0, "A", ("ground", "crank"))
    scene = past_limits(start_deg=60.0, speed_rad_s=100.0)
    free = release(replace(scene, loads=torque(TABLE, "angle"), springs={"damper": damper}), 0.3)
    assert 0.0 < math.degrees(free.range_rad) < 1.0


def test_friction_holds_a_mechanism_that_has_come_to_rest() -> None:
    scene = replace(fourbar(), friction={"A": ConstantFriction("A", 0.05)})
    free = release(scene, 3.0)
    theta, omega, _ = free.law.at(np.array([2.0, 2.5, 3.0]))
    assert omega.tolist() == [0.0, 0.0, 0.0]
    assert theta.max() == theta.min()
    push = Machine(replace(scene, friction={})).push(np.zeros(1), theta[:1], np.zeros(1))
    assert abs(push[0]) <= 0.05
    assert free.sensitivity(np.array([3.0]))[0] < 100.0


def test_a_pin_spring_is_wound_up_by_whole_turns() -> None:
    spring = PinSpring("pin", 0.02, 0.0, 0.0, "A", ("ground", "crank"))
    scene = replace(fourbar(speed_rad_s=30.0), gravity_m_s2=(0.0, 0.0), springs={"pin": spring})
    free, time_s = release(scene, 0.5), np.linspace(0.0, 0.5, 101)
    theta = free.law.at(time_s)[0]
    assert theta.max() > 1.5 * math.tau
    potential = free.energy(time_s).potential
    assert np.abs(potential - 0.01 * theta**2).max() < 1e-12


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (replace(fourbar(), start=Start(angles_rad={"rocker": 1.0})), "angles_deg.rocker: .* open"),
        (replace(fourbar(), start=Start(rates_rad_s={"rocker": 1.0})), "rates_rad_s.rocker: "),
        (replace(slider_crank(), start=Start(displacements_m={"C": 1.0})), "it is open by .* m;"),
        (massless(fourbar()), "nothing that moves has a mass"),
        (replace(fourbar(), friction={"A": CoulombFriction("A", 0.1, 0.01)}), "friction.A follows"),
        (past_limits(start_deg=120.0), "cannot close at C"),
        (fourbar(0.2, 0.3, 0.2, 0.3), "at rest in the change point of C"),
    ],
)  # fmt: skip
def test_what_cannot_be_let_go_is_refused(scene: Scene, said: str) -> None:
    with pytest.raises(CrankcheckError, match=said):
        release(scene, 1.0)


ALLOWED = 1e-9
"""Times the sensitivity, of a turn, of the longest link, and of their rates: each scene is
integrated by itself, with roundings of its own."""
SCENES = {
    "everything that acts": parse_scene(EVERYTHING, "everything"),
    "swing": load_scene("fourbar-swing"),
    "limits": load_scene("fourbar-double-rocker-swing"),
}
CHANGES = MOVES | {"faster": faster(5.0)}


@cache
def unmoved(name: str, until_s: float) -> FreeMotion:
    """The motion that every change of a scene is held to."""
    return release(SCENES[name], until_s)


@pytest.mark.parametrize(
    ("name", "change", "until_s"),
    [
        *(("everything that acts", change, 0.1) for change in [*CHANGES][::2]),
        slowly("limits", "mirrored", 0.45, reason="half a second: through limits"),
        *(
            slowly(name, change, 0.8, reason="roundings that grow with time")
            for name in SCENES
            for change in CHANGES
        ),
    ],
)
def test_the_moved_scene_has_the_moved_motion(name: str, change: str, until_s: float) -> None:
    scene, by = SCENES[name], CHANGES[change]
    own, other = unmoved(name, until_s), release(by.of(scene), until_s / by.fast)
    time_s = np.linspace(0.0, until_s, 25)
    old, new = own.at(time_s, bound=False), other.at(time_s / by.fast, bound=False)
    off = ALLOWED * own.sensitivity(time_s)
    fastest = max(1.0, own.peak_speed_rad_s)
    for link, was in old.links.items():
        now = new.links[link]
        apart = now.theta - by.side * was.theta - by.turn_rad
        assert np.all(np.abs(apart - math.tau * np.round(apart[0] / math.tau)) <= off)
        assert np.all(np.abs(now.omega / by.fast - by.side * was.omega) <= 10.0 * fastest * off)
    for point, place in old.points.items():
        wanted = by.grow * by.turned(place.position) + by.shift_m
        assert np.all(
            np.hypot(*(new.points[point].position - wanted).T)
            <= off * (by.grow * scene.longest_m + np.hypot(*by.shift_m))
        )


@pytest.fixture(scope="module", params=[0.08, slowly(0.3, reason="errors that grow with time")])
def pendulum(request: pytest.FixtureRequest) -> Iterator[FreeMotion]:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("analytic.free.solved_motion.LOOKS", 101)  # bounds at 801 take a second
        yield release(parsed(DOUBLE_PENDULUM), request.param)


def test_several_freedoms_go_by_all_bodies_and_err_as_told(pendulum: FreeMotion) -> None:
    assert isinstance(pendulum, BodiesMotion)
    assert (pendulum.freedoms, pendulum.by_dyads, pendulum.passages) == (2, False, ())
    assert isinstance(release(load_scene("fourbar-chain"), 0.01), MachineMotion)
    time_s = np.linspace(0.0, pendulum.until_s, 31)
    energy = pendulum.energy(time_s)
    assert np.ptp(energy.balance) < 1e-11 * energy.kinetic.max()
    rough = replace(pendulum, method=Projection(1e-10))
    own, other = rough.at(time_s), pendulum.at(time_s)
    for name, link in own.links.items():
        off = np.abs(link.theta - other.links[name].theta)
        assert np.all(off <= own.bound.links[name].theta)
        assert np.all(own.bound.links[name].theta <= rough.error_rad(time_s))
    assert float(pendulum.error_rad(time_s).max()) < 1e-10


def test_beside_a_run_both_its_angles_stay_and_its_pins_are_closed(pendulum: FreeMotion) -> None:
    run = pendulum.at(np.linspace(0.0, pendulum.until_s, 7))
    run.links["lower"].theta[:] += 0.2
    run.points["C"].position[:] += 1e-3
    beside = pendulum.beside(run)
    for name, link in run.links.items():
        assert np.abs(beside.links[name].theta - link.theta).max() < 1e-14
    theta = [run.links[name].theta for name in ("upper", "lower")]
    x = 0.3 * np.cos(theta[0]) + 0.2 * np.cos(theta[1])
    assert np.abs(beside.points["C"].position[:, 0] - x).max() < 1e-14
    run.links["lower"].theta[1] = math.nan  # where there is nothing, there is nothing beside it
    found = np.isnan(pendulum.beside(run).points["C"].position).any(axis=1)
    assert found.tolist() == [False, True, *[False] * 5]


def test_what_leads_to_their_start_goes_on_through_it(pendulum: FreeMotion) -> None:
    h = 1e-3
    before = pendulum.outside(np.array([-h])).links
    after = pendulum.at(np.array([0.0, h])).links
    for name, link in after.items():
        second = (before[name].theta[0] - 2.0 * link.theta[0] + link.theta[1]) / h**2
        assert second == pytest.approx(link.alpha[0], rel=1e-3)
        # A central difference is off by the third derivative, some 1e4 rad/s^4.
        steady = (link.omega[1] - before[name].omega[0]) / (2.0 * h)
        assert steady == pytest.approx(link.alpha[0], abs=1e-2)


def test_several_freedoms_without_a_start_are_told_both_ways() -> None:
    unnamed = DOUBLE_PENDULUM.split("[start]")[0]
    with pytest.raises(StructureError, match=r"mobility W = .* the start of .*lower is not named"):
        release(parsed(unnamed.replace("speed_rad_s = 1.0", "")), 0.1)
