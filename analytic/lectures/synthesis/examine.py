"""Defects and merits of a proposed mechanism: by the reference, not by the equations of its
construction.

A mechanism that fits all positions may still not do the task: where they lie on two circuits it has
to be taken apart between them, where they lie on two branches its driver can not lead from one to
the other, and in another order they are another task.

Source: lecture "Tong hop co cau" (synthesis), branch and order defect; T. R. Chase and J. A. Mirth,
Journal of Mechanical Design 115 (1993), circuits and branches.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve_driven
from analytic.lectures.circuits.arcs import Arc, Signs
from analytic.lectures.circuits.circuits import SAME, Circuits, Defect, Position, circuits_of
from analytic.lectures.synthesis.design import PrecisionPosition, Proposal, asked_motion
from analytic.mechanism.fourbar import grashof_of
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.files.assemble import Table
from models.lectures.draft import SPEED_RAD_S, Draft
from models.scene import Scene
from models.scene.laws import ConstantSpeed, Law, Oscillating

LOOKS = 361
"""Samples of the driver's way, for transmission and size."""
UNMET = 1e-6
"""Error of an unmet position, over the size or in rad: a hundred times the rounding of a position
near a limit of a dyad, and far below any tolerance of a workshop."""
ROUNDING = 1e-13
"""Error of a position, as above, at which no other assembly is looked for."""
MARGIN = math.radians(5.0)
"""Swing of a limited driver beyond the outermost positions, where possible."""
KEEP = 0.5
"""Share of the way from an outermost position to the end of a branch that it keeps clear of."""
IN_LINE = 1e-3
"""Sine of transmission, below which the links of a dyad are in line: 0.06 degrees. An error of a
length is a thousand times as large in the position, and its assembly is open. Places given to six
digits put a position so near to a change point."""


@dataclass(frozen=True)
class Examined:
    """Proposal with its scene, in which the driver leads from the first position on as far as it
    can, and its values by the reference.

    ``positions`` have the driver's angles [rad] of the scene's law, whole turns counted.
    ``least_sine`` is the least sine of a transmission angle, or its equivalent in other dyads, over
    the way of the driver; ``extent_m`` the larger side of the box that all named points stay in.
    ``off`` is the error of each position by the reference (angles in rad, lengths over the size).
    ``torque_n_m`` is the largest driving torque under the loads, None without any. ``fault`` is any
    other defect, ``notes`` are its merits, and ``misses`` is its error between the positions.
    ``unfulfilled`` are wishes of the task that it does not fulfil.
    """

    proposal: Proposal
    scene: Scene
    draft: Draft
    positions: tuple[PrecisionPosition, ...]
    defect: Defect
    turns_fully: bool
    grashof: str
    least_sine: float
    extent_m: float
    off: tuple[float, ...]
    torque_n_m: float | None = None
    fault: str = ""
    notes: tuple[str, ...] = ()
    misses: float = 0.0
    unfulfilled: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """Text of the scene's file."""
        return self.draft.text

    @property
    def least_transmission_rad(self) -> float:
        """Angle of `least_sine` [rad]."""
        return math.asin(min(self.least_sine, 1.0))

    @property
    def defects(self) -> list[str]:
        """Texts of its defects; empty for a mechanism that does the task."""
        worst = max(self.off)
        unmet = [f"misses a position by {worst:.3g} rad or longest links"] * (
            not worst <= max(UNMET, self.proposal.allowed)
        )
        faults = [self.fault] * bool(self.fault)
        return [f"{self.defect} defect"] * (self.defect != "none") + unmet + faults


def ranked(every: Sequence[Examined]) -> list[Examined]:
    """Sort: those without a defect first, then by unfulfilled wishes, by the error between the
    positions, by transmission angle, and, where these are equal, the smaller mechanism first."""
    return sorted(
        every,
        key=lambda one: (
            bool(one.defects),
            len(one.unfulfilled),
            one.misses,
            -round(one.least_sine, 9),
            one.extent_m,
        ),
    )


def examine(proposal: Proposal) -> Examined:
    """Assemble a proposal in its first position and examine the way of its driver. Raises
    CrankcheckError for lengths that make no mechanism, or one that can not be assembled in its
    first position."""
    first, speed = proposal.positions[0].driver_rad, proposal.speed_rad_s
    circuits = circuits_of(proposal.draft.driven(_turning(proposal.driver, first, speed)).scene)
    places: list[Position] = []
    for each in proposal.positions:
        places.append(_place_of(circuits, each, places[-1].signs if places else None))
    _, arc = circuits.place(places[0])
    on_arc = [arc.signs == p.signs and arc.holds(p.driver_rad, SAME) for p in places]
    angles = _unwrapped(arc, [position.driver_rad for position in proposal.positions])
    own = angles
    if arc.low is not None:
        own = [angle for angle, on in zip(angles, on_arc, strict=True) if on]
        own += _unwrapped(arc, [angle for angle in proposal.also_rad if arc.holds(angle)])
    branch = dict(zip(circuits.signed.dyads, places[0].signs, strict=True))
    driver = _driver(proposal.driver, arc, own, speed)
    draft = proposal.draft.driven(driver).with_branch(branch)
    scene = draft.scene
    positions = tuple(
        replace(each, driver_rad=angle)
        for each, angle in zip(proposal.positions, angles, strict=True)
    )
    off = tuple(
        _off(scene if on else _at(circuits, place), each)
        for each, place, on in zip(positions, places, on_arc, strict=True)
    )
    defect = circuits.defect(places)
    if defect in ("branch", "circuit") and circuits.change_points:
        own_off = _through_change_points(scene, positions)
        if max(own_off) <= max(UNMET, proposal.allowed):
            in_a_turn = abs(angles[-1] - angles[0]) < math.tau
            defect, off = "none" if arc.low is not None or in_a_turn else "order", own_off
    fault = "" if defect != "none" else _in_line(scene, positions, proposal.also_rad)
    sine, extent_m = _over_the_way(scene)
    kind = grashof_of(scene)
    return Examined(
        proposal,
        scene,
        draft,
        positions,
        defect,
        arc.low is None,
        kind.name if kind is not None else "",
        sine,
        extent_m,
        off,
        _largest_torque(scene) if scene.loads else None,
        fault,
    )


def _in_line(
    scene: Scene, positions: Sequence[PrecisionPosition], also_rad: Sequence[float]
) -> str:
    """Return the text on the first position, or end of a range, at a change point or a limit of the
    driver: the links of a dyad are in line, and both of its assemblies are one."""
    angles = np.array([*(each.driver_rad for each in positions), *also_rad])
    try:
        motion = solve_driven(
            scene, angles, np.ones(1), np.zeros(1), links=(), points=(), sliders=(), bound=False
        )
    except ReachError:
        return ""  # a defect of another kind, which is told where it is looked for
    for key, sine in motion.conditioning.items():
        near = np.flatnonzero(np.abs(np.broadcast_to(sine, angles.shape)) < IN_LINE)
        if near.size:
            k = int(near[0])
            where = f"position {k + 1}" if k < len(positions) else "an end of its range"
            return (
                f"{where} is at a change point or limit: at {math.degrees(angles[k]):.6g} deg of "
                f"the driver the two assemblies of dyad {key} meet"
            )
    return ""


def _over_the_way(scene: Scene) -> tuple[float, float]:
    """Return the least sine of a transmission angle over the way of the driver, and the larger side
    of the box that all points stay in [m]."""
    way, one = way_of(scene.driver.law), np.ones(1)
    motion = solve_driven(scene, way, one, 0.0 * one, links=(), sliders=(), bound=False)
    sine = min((float(np.min(np.abs(s))) for s in motion.conditioning.values()), default=1.0)
    every = np.concatenate([point.position for point in motion.points.values()])
    return sine, float(np.max(np.ptp(every, axis=0)))


def _through_change_points(
    scene: Scene, positions: Sequence[PrecisionPosition]
) -> tuple[float, ...]:
    """Return the error of each position on the reference's own way, which is smooth through change
    points: branches that meet in them are one; inf where there is no such way."""
    try:
        return tuple(_off(scene, each) for each in positions)
    except CrankcheckError:
        return (math.inf,)


def _turning(link: str, start_rad: float, speed_rad_s: float) -> Table:
    return {"link": link, "speed_rad_s": speed_rad_s, "start_deg": math.degrees(start_rad)}


def _place_of(circuits: Circuits, position: PrecisionPosition, before: Signs | None) -> Position:
    """Return the assembly in which a position is met, among all at the driver's angle; that of the
    position ``before``, if it meets this one as well."""
    best, chosen = math.inf, circuits.signed.signs
    every = itertools.product((1, -1), repeat=len(circuits.signed.dyads))
    for signs in sorted(every, key=lambda each: each != before):
        off = _off(_at(circuits, Position(position.driver_rad, signs)), position)
        if off < best:
            best, chosen = off, signs
        if signs == before and off <= ROUNDING:
            break
    if best == math.inf:
        at = math.degrees(position.driver_rad)
        raise CrankcheckError(f"it can not be assembled with its driver at {at:.6g} deg")
    return Position(position.driver_rad, chosen)


def _at(circuits: Circuits, place: Position) -> Scene:
    scene = circuits.signed.with_signs(place.signs)
    law = ConstantSpeed(place.driver_rad, SPEED_RAD_S)
    return replace(scene, driver=replace(scene.driver, law=law))


def _off(scene: Scene, position: PrecisionPosition) -> float:
    """Return the error of a scene at a position; inf where it is not assembled there."""
    try:
        motion = asked_motion(scene, [position])
    except ReachError:
        return math.inf
    return float(position.off(motion, scene.longest_m)[0])


def _unwrapped(arc: Arc, angles: Sequence[float]) -> list[float]:
    """Return the driver's angles [rad] on one way through them: within the arc; for a driver that
    turns fully each within a turn of the one before, in the sense that takes fewer turns."""
    if arc.low is not None:
        low, high = arc.range_rad
        middle = 0.5 * (low + high)
        return [middle + math.remainder(angle - middle, math.tau) for angle in angles]
    ahead = [(b - a) % math.tau for a, b in itertools.pairwise(angles)]
    behind = [(a - b) % math.tau for a, b in itertools.pairwise(angles)]
    sense, ways = (1.0, ahead) if sum(ahead) <= sum(behind) else (-1.0, behind)
    return [angles[0] + sense * way for way in itertools.accumulate(ways, initial=0.0)]


def _driver(link: str, arc: Arc, angles: Sequence[float], speed: float) -> Table:
    """Return the table of a driver that goes through angles [rad] of its branch: at constant speed
    from the first on, or to and fro."""
    if arc.low is None:
        back = len(angles) > 1 and angles[-1] < angles[0]
        return _turning(link, angles[0], -speed if back else speed)
    low, high = arc.range_rad
    least, most = min(angles), max(angles)
    least -= min(MARGIN, KEEP * max(least - low, 0.0))
    most += min(MARGIN, KEEP * max(high - most, 0.0))
    return {
        "link": link,
        "law": "oscillating",
        "centre_deg": math.degrees(0.5 * (least + most)),
        "amplitude_deg": math.degrees(0.5 * (most - least)),
        "frequency_rad_s": speed,
    }


def way_of(law: Law, count: int = LOOKS) -> Array:
    """Return angles of the driver [rad] over its whole way."""
    if isinstance(law, Oscillating):
        swing = abs(law.amplitude_rad)
        return np.linspace(law.centre_rad - swing, law.centre_rad + swing, count)
    start = float(law.at(np.zeros(1))[0][0])
    return np.linspace(start, start + math.tau, count)


def _largest_torque(scene: Scene) -> float:
    """Return the largest driving torque over the way of its law [N m], without dead points."""
    time_s = np.linspace(0.0, scene.driver.law.period_s, LOOKS)
    acting = forces(scene, time_s, bound=False, skip_dead_points=True)
    return float(np.nanmax(np.abs(acting.torque)))


def passing_times(law: Law, angles: Sequence[float]) -> Array:
    """Return the times [s] of successive driver angles [rad]: in the first turn and later ones, or
    in the first whole swing from end to end that leads through them in their order."""
    theta = np.asarray(angles)
    if isinstance(law, Oscillating):
        rising = len(angles) < 2 or theta[-1] >= theta[0]
        phase = np.arcsin(np.clip((theta - law.centre_rad) / law.amplitude_rad, -1.0, 1.0))
        phase = phase + math.tau if rising else math.pi - phase
        return np.asarray((phase - law.phase_rad) / law.frequency_rad_s)
    start, speed, _ = (float(each[0]) for each in law.at(np.zeros(1)))
    return np.asarray((theta - start) / speed)
