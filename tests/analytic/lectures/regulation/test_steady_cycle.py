"""The cycle that a machine repeats: by hand, beside an integration, and where there is none; and
the flywheel for a coefficient of fluctuation, exact beside approximate. Positions of rest:
by hand, as extremes of the potential energy, and as motion has them."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analytic.forces.kinetostatics import forces
from analytic.free.release import release
from analytic.kinematics import solve_driven
from analytic.lectures.regulation.equilibria import equilibria
from analytic.lectures.regulation.flywheel import WantedFlywheel, wanted_flywheel
from analytic.lectures.regulation.periodic_solution import StallError
from analytic.lectures.regulation.steady_cycle import (
    SteadyCycle,
    cycle_of,
    cycle_scene,
    steady_cycle,
    with_flywheel,
)
from analytic.lectures.regulation.turning_machine import TurningMachine
from analytic.structure.mobility import sides_of
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.scene import GROUND, Driver, Scene
from models.scene import loads as acting
from models.scene.characteristics import Constant, Polynomial, Sine
from models.scene.driver import Released
from models.scene.laws import Accelerating, ConstantSpeed
from models.scene.moved import mirrored
from models.scene.tabulated import Tabulated
from tests.analytic.lectures.regulation.worked import shaft, yoke
from tests.worlds.tiers import few, slow, slowly

PULL = {"pull": (Sine(20.0, math.tau), "angle")}
"""40 J of surplus."""
MOTOR = Polynomial((30.0, -1.0)), "omega"


def cycle(scene: Scene, flywheel: float = 0.0) -> SteadyCycle:
    return steady_cycle(TurningMachine.of(scene), flywheel)


def test_a_shaft_under_a_sine_by_hand_long_or_short() -> None:
    """J 2 kg m^2, M = 20 sin u N m beside a drive that has nothing to close: W = 20 (1 - cos u),
    largest at 180 deg, smallest at 0: 40 J of surplus. J w dw: J mean (w_max - w_min) = 40, so
    delta = 40 / (2 10^2) = 0.2, w from 9 to 11 rad/s."""
    found = cycle(shaft(PULL))
    assert found.drive_n_m == pytest.approx(0.0, abs=1e-14)
    assert found.delta == pytest.approx(0.2, rel=1e-14)
    assert found.extreme_speeds_rad_s == pytest.approx((11.0, 9.0), rel=1e-14)
    assert found.fastest == pytest.approx(math.pi, abs=1e-12)
    assert math.remainder(found.slowest, math.tau) == pytest.approx(0.0, abs=1e-12)
    assert found.surplus_j == pytest.approx(40.0, rel=1e-13)
    assert found.inertia_range == pytest.approx((2.0, 2.0))
    # J w^2 / 2 = T(0) + A (1 - cos(k u)) / k: 2 A / k = J mean (w_max - w_min).
    short = cycle(shaft({"pull": (Sine(2000.0, math.tau / 120), "angle")}))
    assert short.delta == pytest.approx(2.0 * 2000.0 / 120 / (2.0 * 10.0**2), rel=1e-9)


def test_a_press_by_hand() -> None:
    """A third of every turn takes 60 N m, at 10 rad/s: the drive gives 60 / 3 = 20 N m, and
    20 2/3 2 pi = 83.776 J is gained beside the work, and lost in it. It is slowest where the work
    ends, at 240 deg, and fastest where it begins, at 120 deg. delta = 83.776 / (2 100)."""
    third = math.tau / 3.0
    places = (0.0, third, third + 1e-7, 2.0 * third, 2.0 * third + 1e-7)
    work = Tabulated(places, (0.0, 0.0, -60.0, -60.0, 0.0), period=math.tau)
    found = cycle(shaft({"work": (work, "angle")}))
    assert found.drive_n_m == pytest.approx(20.0, rel=1e-6)
    assert found.surplus_j == pytest.approx(20.0 * 2.0 * third, rel=1e-6)
    assert found.delta == pytest.approx(20.0 * 2.0 * third / 200.0, rel=1e-6)
    assert found.machine.theta(np.array(found.fastest)) == pytest.approx(third, abs=1e-6)
    assert found.machine.theta(np.array(found.slowest)) == pytest.approx(2.0 * third, abs=1e-6)
    assert found.works_j["loads.work"] == pytest.approx(-20.0 * math.tau, rel=1e-6)
    assert found.power_w == pytest.approx(20.0 * math.tau / found.period_s, rel=1e-6)


def lines(degrees: tuple[float, ...], values: tuple[float, ...]) -> Tabulated:
    return Tabulated(tuple(map(math.radians, degrees)), values, period=math.tau)


JUMP_DEG = 1e-8
OF_LINES = {
    "extremes within a line": lines((0.0, 80.0, 180.0, 260.0), (0.0, 2000.0, 0.0, 1500.0)),
    "jumps": lines((0.0, 120.3, 120.3 + JUMP_DEG, 240.1, 240.1 + JUMP_DEG),
                   (0.0, 0.0, -60.0, -60.0, 0.0)),
}  # fmt: skip


@pytest.mark.parametrize("name", few(OF_LINES, ["jumps"], "half a second: extremes within a line"))
def test_surplus_and_flywheel_of_torque_lines_are_exact(name: str) -> None:
    """Work is a parabola in each line: its extremes are in rows, and where M + D = 0. At 10 rad/s
    J = surplus / (delta 10^2), on a shaft of 2 kg m^2."""
    table = OF_LINES[name]
    x, y = np.append(table.places, math.tau), np.append(table.values, 0.0)
    torque = y - np.sum(np.diff(x) * (y[1:] + y[:-1])) / 2.0 / math.tau
    rises = np.diff(x) * (torque[1:] + torque[:-1]) / 2.0
    work = [0.0, *np.cumsum(rises)]
    for k, (first, last) in enumerate(itertools.pairwise(torque)):
        if first * last < 0.0:
            work.append(work[k] + 0.5 * first * np.diff(x)[k] * first / (first - last))
    delta = 0.02
    found = wanted(shaft({"lines": (table, "angle")}), delta)
    assert found.cycle.surplus_j == pytest.approx(np.ptp(work), rel=1e-12)
    exact = np.ptp(work) / (delta * 10.0**2) - 2.0
    near = found.approximations
    assert near.by_surplus == pytest.approx(exact, rel=1e-9)  # of a flywheel 10^4 times as heavy
    assert near.by_own_energy == pytest.approx(exact, rel=1e-9)
    assert found.inertia_kg_m2 == pytest.approx(exact, rel=1e-12)


def test_a_push_that_begins_next_to_a_dead_centre_by_hand() -> None:
    """F on the last 1e-6 m towards s = r cos u = r, between two samples: F r sin turns against D
    from a before the dead centre on, where s = c, until b before it, where they are alike."""
    push_n, radius, begin = 1e7, 0.2, 0.2 - 1e-6
    table = Tabulated((-0.3, begin, begin + 1e-15, 0.3), (0.0, 0.0, push_n, push_n))
    scene = yoke(mass_kg=1e-30, radius_m=radius)
    load = acting.Load("push", "yoke", "Y", table, "displacement", slider="Y", stroke="forward")
    driver = Driver("crank", ConstantSpeed(0.3017, 8.0))
    found = cycle(replace(scene, loads={"push": load}, driver=driver))
    drive = push_n * (radius - begin) / math.tau
    a, b = math.acos(begin / radius), math.asin(drive / (push_n * radius))
    surplus = push_n * (radius * math.cos(b) - begin) - drive * (a - b)
    assert found.surplus_j == pytest.approx(surplus, rel=1e-8)


def test_a_motor_and_a_fan_by_hand() -> None:
    """Motor 30 - w, fan -0.1 w^2: 0.1 w^2 + w - 30 = 0, w = 5 (sqrt(13) - 1), without any
    fluctuation; a change of the speed dies as exp(-(1 + 0.2 w) 2 pi / (J w)), one of the energy
    as well."""
    fan = Polynomial((0.0, 0.0, -0.1))
    found = cycle(shaft({"motor": MOTOR, "fan": (fan, "omega")}, free=True, speed=1.0))
    speed = 5.0 * (math.sqrt(13.0) - 1.0)
    assert found.mean_rad_s == pytest.approx(speed, rel=1e-13)
    assert found.delta == pytest.approx(0.0, abs=1e-12)
    decay = math.exp(-(1.0 + 0.2 * speed) * math.tau / (2.0 * speed))
    assert found.settling == pytest.approx(decay, rel=1e-6)
    assert found.works_j["loads.motor"] == pytest.approx(math.tau * (30.0 - speed))


def test_a_pushed_yoke_by_hand() -> None:
    """F = 40 N, r = 0.2 m: T = T0 + 8 (cos u - 1), J = 0.5 + 0.12 sin^2 u. w^2 = 2 T / J has
    its largest value at 0 and its smallest beyond 90 deg, where T' J = T J'."""
    scene = yoke(40.0)
    turned = cycle(replace(scene, driver=Driver("crank", ConstantSpeed(0.321, 8.0))))
    assert turned.inertia_range == pytest.approx((0.5, 0.62), rel=1e-13)
    found = cycle(scene)
    start = found.solution.at_borders[0]
    u = np.linspace(0.0, math.tau, 50001)
    square = 2.0 * (start + 8.0 * (np.cos(u) - 1.0)) / (0.5 + 0.12 * np.sin(u) ** 2)
    assert found.extreme_speeds_rad_s[0] ** 2 == pytest.approx(square.max(), rel=1e-8)
    assert found.extreme_speeds_rad_s[1] ** 2 == pytest.approx(square.min(), rel=1e-8)
    s = found.slowest
    energy, inertia = start + 8.0 * (math.cos(s) - 1.0), 0.5 + 0.12 * math.sin(s) ** 2
    assert -8.0 * math.sin(s) * inertia == pytest.approx(energy * 0.12 * math.sin(2.0 * s))


def integrated(found: SteadyCycle) -> tuple[float, float]:
    """The energy after a cycle over that at its start, less 1, and the time of it, by RK45 over
    the angle."""
    machine, solution = found.machine, found.solution

    def rates(u: float, state: np.ndarray) -> tuple[float, float]:
        at = np.array([u])
        inertia = machine.inertia(at)[0] + solution.flywheel
        speed = np.sqrt(2.0 * state[:1] / inertia)
        return float((machine.torque(at, speed) + solution.drive)[0]), float(1.0 / speed[0])

    done = solve_ivp(
        rates, (0.0, machine.cycle_rad), (solution.at_borders[0], 0.0),
        method="RK45", rtol=3e-8, atol=1e-11, max_step=0.5,
    )  # fmt: skip
    return float(done.y[0, -1] / solution.at_borders[0] - 1.0), float(done.y[1, -1])


def driven_by_a_motor() -> Scene:
    """The compressor behind a motor, with a damper on its piston and a valve that hangs on a
    spring."""
    scene = load_scene("compressor")
    table = Tabulated((0.0, 140.0, 160.0, 300.0), (60.0, 40.0, 0.0, -90.0))
    motor = shaft({"motor": (table, "omega")}, free=True, speed=150.0)
    springs = {
        "damper": acting.SlideSpring("damper", 0.0, 5.0, 0.0, "C"),
        "spring": acting.LineSpring("spring", 900.0, 2.0, 0.05, ("A", "C")),
    }
    friction = {"C": acting.ConstantFriction("C", 12.0), "B": acting.ConstantFriction("B", 0.1)}
    loads = {**scene.loads, **motor.loads}
    return replace(scene, loads=loads, springs=springs, friction=friction, driver=motor.driver)


def test_the_cycle_is_what_an_integration_repeats() -> None:
    """Tables over speed, displacement and strokes, a spring, dampers and friction: scalar steps,
    which nothing else has in common with the cells. They err: at a tolerance of 1e-11 and 19 s they
    are within 3e-10 and 2e-11."""
    found = cycle(driven_by_a_motor(), 0.05)
    off, period = integrated(found)
    assert abs(off) < 1e-5
    assert period == pytest.approx(found.period_s, rel=1e-6)
    assert 0.0 < found.settling < 1.0
    assert sum(found.works_j.values()) == pytest.approx(0.0, abs=1e-9 * found.work_j)
    assert found.time_s(np.array([found.machine.cycle_rad]))[0] == pytest.approx(found.period_s)


def test_a_steep_motor_is_followed_after_each_kink() -> None:
    """The speed comes back to that of the motor within 3 deg: J w dw/du = -20 (w - 10) + ..."""
    pull = Tabulated((0.0, 1.0, 1.5, 4.0), (-8.0, 20.0, -30.0, 4.0), "linear", math.tau)
    loads = {"motor": (Polynomial((200.0, -20.0)), "omega"), "pull": (pull, "angle")}
    scene = shaft(loads, free=True, inertia=0.05)
    found = cycle(scene)
    begin = float(found.solution.speed_at(np.zeros(1))[0])
    let_go = replace(scene, driver=Driver("crank", Released(0.0, begin, 1.0)))
    free = release(let_go, found.period_s)
    theta, omega, _ = free.law.at(np.linspace(0.0, found.period_s, 2000))
    assert np.abs(found.solution.speed_at(theta) - omega).max() < 1e-8


@pytest.mark.parametrize("backward", [False, True])
def test_torques_are_those_that_kinetostatics_has_at_constant_speed(backward: bool) -> None:
    """torque of the drive = J' w^2 / 2 - M, friction and dampers among what acts."""
    speed = -140.0 if backward else 140.0
    scene = driven_by_a_motor()
    scene = mirrored(scene, sides_of(scene)) if backward else scene
    scene = replace(scene, driver=Driver("crank", ConstantSpeed(0.4, speed)))
    machine = TurningMachine.of(scene)
    u = np.linspace(0.05, 6.2, 40)
    needed = 0.5 * machine.inertia(u)[1] * speed**2 - machine.torque(u, np.full_like(u, 140.0))
    found = forces(scene, u / 140.0).torque
    assert machine.way * needed == pytest.approx(found, abs=1e-11 * np.abs(found).max())


def test_rows_of_tables_are_borders_of_cells() -> None:
    """So that the quadrature is right: against many trapezoids, whose kinks err by 1e-10."""
    found, count = cycle(load_scene("compressor"), 1e4), 200_000
    u = (np.arange(count) + 0.5) * (found.machine.cycle_rad / count)
    mean = float(np.mean(found.machine.steady_torque(u)))
    assert found.drive_n_m == pytest.approx(-mean, rel=2e-9)


@pytest.mark.parametrize("name", few(shipped("forces"), [*shipped("forces")][::3], "as the others"))
def test_shipped_machines_close_their_balance(name: str) -> None:
    scene = replace(load_scene(name), friction={})
    found = cycle(scene, 1e4)
    left = sum(found.works_j.values())
    assert left == pytest.approx(0.0, abs=1e-9 * max(found.work_j, 1.0))
    speed = abs(float(scene.driver.law.at(np.zeros(1))[1][0]))
    assert found.mean_rad_s == pytest.approx(speed, rel=1e-13)
    turns = 2.0 if name == "engine-four-stroke" else 1.0
    assert found.machine.cycle_rad == pytest.approx(turns * math.tau)


def test_from_rest_a_machine_turns_to_the_side_that_its_motor_drives_it_to() -> None:
    loads = {"motor": (Polynomial((-30.0, -1.0)), "omega")}
    found = cycle_of(TurningMachine.of(shaft(loads, free=True, speed=0.0)))
    assert found.machine.way == -1.0
    assert found.mean_rad_s == pytest.approx(30.0)


ROCKING = load_scene("fourbar-double-rocker")
SPRUNG = acting.PinSpring("main", 1.0, 0.0, 0.0, "A", (GROUND, "crank"))
TWO = {"one": (Sine(1.0, 2.0), "angle"), "other": (Sine(1.0, 3.0), "angle")}
REFUSED = {
    "no balance": (shaft({"pull": (Constant(3.0), "time")}, free=True),
                   "gain 18.8496 J at any speed; add a torque on crank of -3 N m"),
    "from rest": (shaft({"pull": (Sine(3.0, math.tau), "angle")}, free=True, speed=0.0),
                  "starts from rest: any speed would do"),
    "faster and faster": (shaft({"motor": (Polynomial((3.0, 1.0)), "omega")}, free=True),
                          "goes faster and faster"),
    "to rest": (shaft({"brake": (Polynomial((-3.0, -1.0)), "omega")}, free=True), "comes to rest"),
    "a short table": (shaft({"motor": (Tabulated((0.0, 20.0), (9.0, 4.0)), "omega")}, free=True),
                      "from 10 to 20 rad/s of crank, 40.84 to 25.13 J"),
    "a start beyond a table": (
        shaft({"motor": (Tabulated((20.0, 30.0), (9.0, -4.0)), "omega")}, free=True, speed=5.0),
        "the table goes from 20 to 30"),
    "time": (shaft({"pull": (Sine(3.0, 1.0), "time")}), "loads.pull follows time"),
    "no period": (shaft({"pull": (Polynomial((1.0, 1.0)), "angle")}), "never repeats"),
    "no common cycle": (shaft(TWO), "repeat after 114.592 deg, 171.887 deg"),
    "hardly a period": (shaft({"pull": (Sine(1.0, math.tau / 5000), "angle")}),
                        "5000 times in a cycle of 360 deg"),
    "waves too short": (shaft({"pull": (Sine(2e4, math.tau / 1999), "angle")}),
                        "torques change too fast"),
    "a wound spring": (replace(shaft({}), springs={"main": SPRUNG}),
                       "springs.main is wound up by 360 deg"),
    "no turn": (ROCKING, "swings or speeds up"),
    "no law": (replace(shaft({}), driver=Driver("crank", Accelerating(0.0, 1.0, 1.0))),
               "swings or speeds up"),
    "Coulomb": (replace(shaft({}), friction={"C": acting.CoulombFriction("C", 0.1)}), "friction.C"),
    "a stop": (shaft({"pull": (Sine(300.0, math.tau), "angle")}), "add a flywheel, as large"),
    "no mass": (shaft({"pull": (Sine(3.0, math.tau), "angle")}, inertia=0.0), "no mass moves"),
    "elastic links": (load_scene("fourbar-elastic"), "coupler is elastic"),
    "not round": (replace(ROCKING, driver=replace(shaft({}, free=True).driver, link="driver")),
                  "does not turn round"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_without_a_steady_cycle_it_says_why(name: str) -> None:
    scene, words = REFUSED[name]
    with pytest.raises(CrankcheckError) as raised:
        cycle_of(TurningMachine.of(scene))
    assert words in str(raised.value)


def test_a_machine_stops_from_the_coefficient_on_that_is_2() -> None:
    """On a shaft delta = surplus / (J mean^2): at 2 the smallest speed is 0."""
    nearly, stops = (
        shaft({"pull": (Sine(share * 200.0, math.tau), "angle")}) for share in (0.99, 1.01)
    )
    assert cycle(nearly).delta == pytest.approx(2.0 * 0.99, rel=1e-9)
    with pytest.raises(StallError):
        cycle(stops)


def wanted(scene: Scene, delta: float) -> WantedFlywheel:
    return wanted_flywheel(TurningMachine.of(scene), delta)


def test_the_flywheel_of_a_shaft_by_hand_also_where_it_is_all_that_moves() -> None:
    """40 J at 10 rad/s for 0.02: J = 40 / (0.02 100) = 20 kg m^2, of which the shaft has 2. All
    ways agree: its own moment of inertia is constant."""
    found = wanted(shaft(PULL), 0.02)
    near = found.approximations
    assert found.inertia_kg_m2 == pytest.approx(18.0, rel=1e-11)
    for other in (near.by_surplus, near.by_own_energy, near.by_tangents):
        assert other == pytest.approx(18.0, rel=1e-7)
    assert found.bare.delta == pytest.approx(0.2)
    assert found.slopes == pytest.approx((0.5 * 10.1**2, 0.5 * 9.9**2))
    # Without masses there is no cycle; 40 J at 10 rad/s for 0.1 take 4 kg m^2.
    alone = wanted(shaft(PULL, inertia=0.0), 0.1)
    assert alone.bare is None
    assert alone.inertia_kg_m2 == pytest.approx(4.0, rel=1e-11)


def test_the_flywheel_of_a_yoke_without_loads_by_hand() -> None:
    """Energy stays: w_max / w_min = sqrt((J + 0.62) / (J + 0.5)) = (1 + delta/2) / (1 - delta/2) =
    q, so J = (0.62 - 0.5 q^2) / (q^2 - 1). There is no surplus of work, so that this approximation
    puts no flywheel on; own energy: 0.12 / (2 delta) less 0.5; tangents: both touch the line W = 0,
    at its ends, and meet in J = (0.62 k_max' - 0.5 ...) as below."""
    delta = 0.05
    found = wanted(yoke(), delta)
    q = ((1.0 + 0.5 * delta) / (1.0 - 0.5 * delta)) ** 2
    assert found.inertia_kg_m2 == pytest.approx((0.62 - 0.5 * q) / (q - 1.0), rel=1e-10)
    near = found.approximations
    assert near.by_surplus < 0.0
    assert near.by_own_energy == pytest.approx(0.06 / delta - 0.5, rel=1e-6)
    # max(-k_max J) = -0.5 k_max, min(-k_min J) = -0.62 k_min, with k = w^2 (1 +- delta) / 2.
    tangents = (0.62 * (1.0 - delta) - 0.5 * (1.0 + delta)) / (2.0 * delta)
    assert near.by_tangents == pytest.approx(tangents, rel=1e-6)


@slow("a second; flywheels of shafts and a yoke are compared with those by hand")
def test_a_machine_with_its_flywheel_has_the_coefficient_let_go_or_driven() -> None:
    """And tangents of the exact slopes say the same: no torque follows the speed."""
    found = wanted(load_scene("compressor"), 0.02)
    (above, _), (_, below) = map(found.cycle.heights, found.slopes)
    steep, flat = found.slopes
    assert (above - below) / (steep - flat) == pytest.approx(found.inertia_kg_m2, rel=1e-11)
    near = found.approximations
    for other in (near.by_surplus, near.by_own_energy):
        assert other == pytest.approx(found.inertia_kg_m2, rel=0.2)
    # What the drawn tangents leave out is delta^2 / 4 of the slopes.
    assert near.by_tangents == pytest.approx(found.inertia_kg_m2, rel=1e-4)
    # Let go in its cycle.
    scene = cycle_scene(found.cycle, cycles=3.0)
    law, mean = scene.driver.law, found.cycle.mean_rad_s
    assert isinstance(law, Released)
    assert law.duration_s == pytest.approx(3.0 * found.cycle.period_s)
    assert law.speed_rad_s == pytest.approx(mean, rel=0.01 * 1.001)
    assert set(scene.loads) == {"compression", "expansion", "drive"}
    # Its loads balance, and its start is the mean speed that is asked of it.
    freely = cycle(replace(scene, driver=Driver("crank", replace(law, speed_rad_s=mean))))
    assert freely.delta == pytest.approx(0.02, rel=1e-9)
    assert freely.drive_n_m == pytest.approx(0.0, abs=1e-9)


@slow("0.6 s: the cycle of a motor is compared with an integration, flywheels by hand")
def test_with_a_motor_the_flywheel_is_that_of_its_own_cycle() -> None:
    scene = shaft({**PULL, "motor": MOTOR}, free=True)
    found = wanted(scene, 0.01)
    assert found.cycle.delta == pytest.approx(0.01, rel=1e-11)
    # The motor itself works against the fluctuation: it takes less than without it.
    bound = 40.0 / (0.01 * found.cycle.mean_rad_s**2) - 2.0
    assert 0.5 * bound < found.inertia_kg_m2 < bound
    again = cycle(with_flywheel(scene, found.inertia_kg_m2))
    assert again.delta == pytest.approx(0.01, rel=1e-10)


@pytest.mark.parametrize("delta", [0.0, -0.1, 9e-7, 2.0, math.nan, math.inf])
def test_a_coefficient_that_is_none_is_refused(delta: float) -> None:
    with pytest.raises(CrankcheckError, match=rf"^delta {delta:g}: .*(0\.02|0\.2|1e-06 or more)"):
        wanted(shaft(PULL), delta)


@pytest.mark.parametrize("rate", [0.0, 3.0])
def test_a_pendulum_by_hand(rate: float) -> None:
    """J theta'' = -m g l cos(theta) - k (theta - free), m g l = 0.981 N m, J = 2 + m l^2."""
    scene = shaft({})
    crank = replace(scene.links["crank"], centre_m=(0.1, 0.0))
    springs = {"s": acting.PinSpring("s", rate, 0.0, 0.3, "A", (GROUND, "crank"))} if rate else {}
    scene = replace(
        scene, links={**scene.links, "crank": crank}, springs=springs, gravity_m_s2=(0.0, -9.81)
    )
    found = [one for one in equilibria(scene).found if one.circuit == 0]
    assert [one.stiffness > 0.0 for one in found] == ([True] if rate else [True, False])
    for one in found:
        theta = one.driver_rad
        assert -0.981 * math.cos(theta) == pytest.approx(rate * (theta - 0.3), abs=1e-12)
        slope = rate - 0.981 * math.sin(theta)
        assert one.stiffness == pytest.approx(slope / 2.01, rel=1e-6)


@pytest.mark.parametrize(
    "name",
    [slowly("fourbar-swing", reason="one without limits"), "fourbar-double-rocker-swing"],
)
def test_a_stable_one_is_swung_about_and_has_the_least_potential(name: str) -> None:
    """Half a small oscillation later it stands on the other side; the lowest is the lowest of a
    circuit, whose limits are passed."""
    scene, rests = load_scene(name), equilibria(load_scene(name))
    own = [one for one in rests.found if one.circuit == rests.circuits.own[0]]
    for one in (each for each in own if each.stiffness > 0.0):
        start = one.driver_rad + 1e-4
        sign = dict(zip(rests.circuits.signed.dyads, one.signs, strict=True))
        driver = Driver(scene.driver.link, Released(start, 0.0, 1.0))
        half_s = math.pi / math.sqrt(one.stiffness)
        free = release(
            replace(scene, branch=sign, driver=driver, start=type(scene.start)()), half_s
        )
        swung = free.law.at(np.array([half_s]))[0][0] - one.driver_rad
        assert swung == pytest.approx(-1e-4, rel=1e-2)
    lowest = math.inf
    for arc, _ in rests.circuits.course:
        theta = arc.angles(4001)[1:-1]
        motion = solve_driven(rests.circuits.signed.with_signs(arc.signs), theta, 0.0, 0.0)
        height = np.zeros_like(theta)
        for link in scene.links.values():  # bars: their centres are between their ends
            ends = [motion.points[point].position[:, 1] for point in link.points]
            height += 9.81 * link.mass_kg * np.mean(ends, axis=0)
        lowest = min(lowest, float(height.min()))
    stable = [one.potential_j for one in own if one.stiffness > 0.0]
    assert min(stable) == pytest.approx(lowest, rel=1e-4)
    assert min(stable) <= lowest + 1e-12
    assert len(own) == 2 * len(stable)
