"""Free motion of a mechanism. With one freedom, by its own equation, integrated to rounding and
compared with a second integration with other nodes; else by those of all bodies."""

import math
from collections.abc import Iterator
from functools import lru_cache, partial

import numpy as np

from analytic.change_points.sign import AT_START
from analytic.free.chart import Chart, LimitedScene
from analytic.free.coordinate_history import CoordinateHistory, Window
from analytic.free.free_motion import FreeMotion, LimitPassage
from analytic.free.integration import Integration
from analytic.free.machine import Machine
from analytic.free.solved_motion import BodiesMotion, MachineMotion
from analytic.free.window import gauss, sums
from analytic.kinematics import solve_driven
from analytic.multibody.release_multibody import release_multibody
from analytic.prepared import prepared
from analytic.structure.mobility import analyse
from models.errors import CrankcheckError, SceneError, StructureError
from models.motion import Motion
from models.scene import KEPT, Same, Scene
from models.scene.driver import Released, check_duration
from models.scene.loads import LineSpring

NODES, OTHERS = 20, 16
"""Nodes of a window, and of a window of the integration that it is compared with."""


def release(scene: Scene, until_s: float) -> FreeMotion:
    """Return the free motion of a scene from its start.

    Parameters
    ----------
    scene : Scene
        A mechanism with a free driver (`models.scene.driver`) and masses. With another mobility
        than 1, or a group without a closed form, the start names the links' angles.
    until_s : float
        Duration [s].

    Returns
    -------
    FreeMotion
        With one freedom and dyads to a few roundings of the driver's angle per turn times its
        `sensitivity`, else to about 1e-11 times that; its error is `error_rad`.

    Raises
    ------
    StructureError
        No freedom; or a start that does not fix all links, or in a change point, where the mobility
        is not 1, or a group has no closed form.
    CrankcheckError
        A driver that is driven; a start that contradicts itself; no mass that moves; friction that
        follows from the reactions; a position on the way that has no smooth motion through it; an
        invalid time.
    """
    check_duration(scene.name, until_s)
    return _released(Same(scene), float(until_s))


@lru_cache(maxsize=KEPT)
def _released(same: Same, until_s: float) -> FreeMotion:
    scene = same.scene
    law = scene.driver.law
    if scene.elastic:
        raise CrankcheckError(
            f"{scene.name}: {', '.join(scene.elastic)} is elastic, and would be taken as rigid "
            "here; solve it with analytic.elastic.released, or take [elastic] out"
        )
    if not isinstance(law, Released):
        raise CrankcheckError(f'{scene.name}: its driver follows a law; give it law = "free"')
    try:
        analyse(scene)
    except StructureError as error:
        return _of_all_bodies(scene, until_s, error)
    return _of_one_freedom(scene, law, until_s)


def _of_all_bodies(scene: Scene, until_s: float, reason: StructureError) -> BodiesMotion:
    """Return the motion by the equations of all bodies, as ``reason`` excludes any other."""
    try:
        free = release_multibody(scene, until_s)
    except CrankcheckError as error:
        raise StructureError(
            f"{reason} The equations of motion of all bodies do not solve its free motion either: "
            f"{error}"
        ) from None
    return BodiesMotion(free.dynamics, free.method, free.until_s, free.start)


def _of_one_freedom(scene: Scene, law: Released, until_s: float) -> MachineMotion:
    chart = Chart.at(LimitedScene.of(scene, law.start_rad), law.start_rad, {})
    machine = Machine(scene, chart)
    u, v = chart.state(law.start_rad, law.speed_rad_s)
    check_start(scene, machine, u)
    wound = machine.lengths(np.array([u]))
    start = {name: float(q[0]) for name, q in wound.items()}
    history, edges = _integrated(machine, until_s, NODES, (u, v), start)
    other = partial(_other, machine, until_s, (u, v), start)
    return MachineMotion(scene, until_s, history, other, tuple(_passages(history)), tuple(edges))


def _integrated(
    machine: Machine,
    until_s: float,
    nodes: int,
    start: tuple[float, float],
    wound: dict[str, float],
) -> tuple[CoordinateHistory, list[float]]:
    """Return the windows up to a time, and the instants at which the forces are not smooth."""
    going = Integration(machine.scene, gauss(nodes), until_s, machine, *start, wound)
    return going.run(), going.edges_s


def _other(
    machine: Machine, until_s: float, start: tuple[float, float], wound: dict[str, float]
) -> CoordinateHistory:
    """Return the windows of the second integration."""
    return _integrated(machine, until_s, OTHERS, start, wound)[0]


def _passages(history: CoordinateHistory) -> Iterator[LimitPassage]:
    for window in history.windows:
        limit = window.chart.limit
        if limit is None:
            continue
        share = np.linspace(0.0, 1.0, 17)
        u = sums(np.ones((17, 1)) * window.u, share)
        for k in np.flatnonzero((u[:-1] < 0.0) != (u[1:] < 0.0)):
            if u[k] == 0.0 and window.start_s == 0.0 and k == 0:
                continue  # it is released there
            time_s = window.start_s + window.long_s * _zero(window, share[k], share[k + 1])
            yield LimitPassage(time_s, limit.dyad, limit.driver_rad)


def _zero(window: Window, low: float, high: float) -> float:
    """Return the share of a window at which its coordinate is 0, between two shares."""
    for _ in range(10):
        share = np.linspace(low, high, 65)
        u = sums(np.ones((65, 1)) * window.u, share)
        k = int(np.argmax((u[:-1] < 0.0) != (u[1:] < 0.0)))
        low, high = float(share[k]), float(share[k + 1])
    return 0.5 * (low + high)


CLOSE = 1e-9
"""Distance of coincident points, over the longest link."""
ROOM = 1e-6
"""Allowed contradiction of a start that is written with some digits: [rad], and of the longest link
[m]; of rates, over those that they follow from."""


def check_start(scene: Scene, machine: Machine, u: float) -> None:
    """Refuse a start, at coordinate ``u`` of the machine, that contradicts itself, that moves no
    mass, or that is at rest in a change point. Raises CrankcheckError."""
    law = scene.driver.law
    assert isinstance(law, Released)
    turned = math.degrees(law.start_rad)
    chart = machine.chart
    if chart.limit is not None and u < ROOM and law.speed_rad_s:
        raise CrankcheckError(
            f"{scene.name}: {scene.driver.link} starts at its limit, {turned:.6g} deg, with "
            f"{law.speed_rad_s:g} rad/s, where it has no speed; start it at rest, or beside the "
            "limit"
        )
    for key, passage in prepared(scene).passages.items():
        phase = np.abs(np.remainder(passage.angles - law.start_rad + 1.0, passage.period) - 1.0)
        if law.speed_rad_s == 0.0 and phase.min() <= 10.0 * AT_START:
            raise CrankcheckError(
                f"{scene.name}: it starts at rest in the change point of {key}, at "
                f"{scene.driver.link} {turned:.6g} deg, where it may continue in two ways; give "
                "it a speed, or another angle"
            )
    place = np.array([u])
    inertia = float(machine.inertia(place)[0][0])
    # At a limit of the driver everything moves by the coordinate that is used there.
    if not inertia > 0.0:
        around = machine.inertia(u + 0.1 * np.array([-1.0, 1.0]) * (u or 1.0))[0]
        what = "nothing that moves has a mass"
        if np.any(around > 0.0):
            what = f"nothing that moves has a mass at {scene.driver.link} {turned:.6g} deg"
        raise CrankcheckError(f"{scene.name}: {what}; free motion needs one: give the links masses")
    theta, omega = np.array([law.start_rad]), np.array([law.speed_rad_s])
    found = solve_driven(scene, theta, omega, np.zeros(1), bound=False)
    if faults := [*_contradictions(scene, found), *_without_direction(scene, found)]:
        raise SceneError(scene.name, faults)


def _without_direction(scene: Scene, at: Motion) -> Iterator[str]:
    """Yield texts on springs whose two points are at one place."""
    for spring in scene.springs.values():
        if isinstance(spring, LineSpring):
            a, b = (at.points[name].position[0] for name in spring.points)
            if math.dist(a, b) <= CLOSE * scene.longest_m:
                yield (
                    f"springs.{spring.name}: {' and '.join(spring.points)} are at one place at the "
                    "start, where a pull between them has no direction; start elsewhere"
                )


def _contradictions(scene: Scene, at: Motion) -> Iterator[str]:
    """Yield texts on contradictions between the start of a scene and its assembly."""
    start, long_m = scene.start, scene.longest_m
    links, sliders = at.links, at.sliders
    fastest = max(
        [abs(float(link.omega[0])) for link in links.values()]
        + [abs(float(slider.speed[0])) / long_m for slider in sliders.values()]
    )
    told = (
        *((f"angles_deg.{n}", a, links[n].theta, ROOM, "rad") for n, a in start.angles_rad.items()),
        *(
            (f"rates_rad_s.{n}", w, links[n].omega, ROOM * fastest, "rad/s")
            for n, w in start.rates_rad_s.items()
        ),
        *(
            (f"displacements_m.{n}", s, sliders[n].displacement, ROOM * long_m, "m")
            for n, s in start.displacements_m.items()
        ),
        *(
            (f"speeds_m_s.{n}", v, sliders[n].speed, ROOM * long_m * fastest, "m/s")
            for n, v in start.speeds_m_s.items()
        ),
    )
    for key, value, own, room, unit in told:
        here = float(own[0])
        off, size = value - here, 1.0
        shown = unit
        if unit == "rad":
            off, size, shown = math.remainder(off, math.tau), math.degrees(1.0), "deg"
        if abs(off) > room:
            yield (
                f"start.{key}: found {size * value:.9g} {shown}, where the assembly has "
                f"{size * here:.9g} {shown} with {scene.driver.link} as it is: it is open by "
                f"{abs(off):.3g} {unit}; leave it out, or give that"
            )
