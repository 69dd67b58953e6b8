"""Results of the steps: the driven crank, errors over the step, gravity."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from analytic.structure.mobility import sides_of
from models.array import Array
from models.files.reading import load_scene
from models.scene import Same, Scene
from models.scene.joints import bodies, centre_of
from models.scene.laws import ConstantSpeed, Oscillating
from models.scene.moved import mirrored, moved, rotated, scaled
from reports.compare.compare import places, truth_of
from reports.compare.errors import Error, largest
from reports.contract.oscillators import centres
from reports.contract.subject import NotTriedError, Subject, clause
from reports.judge.halving import PLACES
from reports.judge.rules.reference import too_good
from reports.judge.three_steps import convergence
from sim.engine import AT_ROUNDING, Poses

DRIVE_RAD = 1e-9
"""Largest error of a prescribed crank, or the engine's floor."""
STEPS = (180, 360, 720)
SLACK = 0.5
"""Largest distance of a slope over three steps from its asymptotic order."""
SOLVED = 1e-9
"""Largest position error, as a pure number, after solving to rounding, or the engine's floor."""
TWICE, NONE = 2.0, 1e-9
"""Errors of two runs that should be equal differ by less than this factor, or are negligible: by
that or the engine's floor."""
SPEEDS = {"fifty times as fast": 50.0, "a thousandth as fast": 1e-3, "backwards": -1.0}
FINE, FAR = 2880, 6.0
"""Small steps, at which the floor is at most this many times the error."""
TURN = 400
"""Steps in a turn in which errors of two runs are compared."""
FALL_STEPS = 60
FALL = 0.2
"""Fall of a body without joints meanwhile, over the longest link."""
FALL_OFF = 0.1
"""Largest difference of a free motion to that of the equations, over its size: far above the effect
of steps and of joints that give way, far below a body without weight or with another's mass."""

PAIR_OFF = 0.01
"""Largest error of place in a turn: far above that of steps, far below that of another ratio."""


@clause(
    "EC51",
    "a prescribed crank follows the driver's law",
    "An error of the crank is an error of all links; a motor of limited gain is a servo.",
    "Move the crank yourself: drive.angles, drive.chords and drive.pushes give its places and "
    "speeds; or refuse the drive with EngineError.",
)
def _crank(subject: Subject) -> Iterator[str]:
    law = subject.scene.driver.law
    if text := _drive_fault(subject, 3.0):
        yield text
    if isinstance(law, ConstantSpeed):
        swinging = Oscillating(law.start_rad, 0.4, abs(law.speed_rad_s), 0.2)
        try:
            if text := _drive_fault(subject.driven_by(swinging), 2.0):
                yield f"driven to and fro, {text}"
        except NotTriedError:
            return  # an engine need not have every law


def _drive_fault(subject: Subject, turns: float) -> str:
    done = subject.ran(360, turns)
    if done.motion is None or done.status != "ok":
        return f"the run ended {done.status}: {done.reason}"
    scene = subject.scene
    commanded = scene.driver.law.at(done.motion.time_s)[0]
    off = float(np.abs(done.motion.links[scene.driver.link].theta - commanded).max())
    return (
        ""
        if off <= subject.beyond(DRIVE_RAD)
        else f"the crank is off by {off:.2g} rad over {turns:g} turns"
    )


@clause(
    "EC52",
    "errors of place shrink with the step, at the declared order, down to a floor",
    "By this order verify separates errors of the step from errors of the model.",
    "Set Engine.order to the measured order; if order 1 is not intended, look for places moved "
    "with the velocity of another instant.",
)
def _shrinking(subject: Subject) -> Iterator[str]:
    if subject.engine.placing(subject.settings()) == "solved":
        raise NotTriedError("placing is solved, and its errors need not shrink")
    errors, unit = [], ""
    for steps in STEPS:
        worst, fault = _worst_place(subject, steps)
        if worst is None:
            yield fault
            return
        errors.append(worst.pure)
        unit = worst.unit
    dt_s = [subject.dt_s(steps) for steps in STEPS]
    seen = convergence(dt_s, errors, unit, subject.beyond(AT_ROUNDING))
    told = ", ".join(f"{error:.2g}" for error in errors)
    order = subject.engine.order
    if seen.trend == "grows":
        yield f"errors of place grow as the step shrinks: {told} at {STEPS} steps a turn"
    elif seen.trend == "shrinks" and seen.order < order - SLACK:
        yield (
            f"errors of place shrink as dt^{seen.order:.1f}, but order is {order}: {told} at "
            f"{STEPS} steps a turn"
        )


def _worst_place(subject: Subject, steps: int) -> tuple[Error | None, str]:
    """Return the largest error of place over a turn in so many steps; None with the fault."""
    done = subject.ran(steps, 1.0, every=steps // STEPS[0])
    rows = places(truth_of(Same(subject.scene)).beside(done))
    worst = largest(row for row in rows if row.quantity in PLACES)
    if worst is None or done.status != "ok":
        return None, f"with {steps} steps a turn the run ended {done.status}: {done.reason}"
    return worst, ""


@clause(
    "EC53",
    "places are found as `placing` states",
    "Places nearer to the reference than the steps allow were copied from it.",
    "Set Engine.placing to solved if each step solves the joints; raise Engine.order if errors "
    "shrink faster than it states.",
)
def _placing(subject: Subject) -> Iterator[str]:
    engine = subject.engine
    placing = engine.placing(subject.settings())
    for steps in (180, 720):
        errors = subject.errors(subject.ran(steps, 1.0))
        if errors is None:
            yield f"with {steps} steps a turn nothing is logged"
            return
        if placing == "solved":
            worst = largest(row for row in errors.rows if row.quantity in PLACES)
            if worst and not worst.pure <= subject.beyond(SOLVED):
                yield f"placing is solved, and {worst.body} is off by {worst.pure:.2g}"
        elif near := too_good(errors, placing, engine.order):
            yield (
                f"placing is integrated with order {engine.order}, and with {steps} steps a turn "
                f"{near[0].quantity} of {near[0].body} is off by {near[0].pure:.2g} only"
            )


@clause(
    "EC54",
    "errors depend on the steps in a turn, not on the speed or its sign",
    "Advice for one speed is carried over to others.",
    "List in Engine.in_seconds the settings with a time of their own, such as a damping.",
)
def _speed(subject: Subject) -> Iterator[str]:
    law = subject.scene.driver.law
    if timed := subject.engine.in_seconds(subject.settings()):
        raise NotTriedError(f"in_seconds lists {', '.join(timed)}, with a time of its own")
    if not isinstance(law, ConstantSpeed) or any(subject.scene.gravity_m_s2):
        raise NotTriedError("gravity, or the driver's law, has a time of its own")
    plain = pure_errors(subject)
    for words, factor in SPEEDS.items():
        other = subject.driven_by(replace(law, speed_rad_s=factor * law.speed_rad_s))
        yield from unlike(plain, pure_errors(other), words, subject)


def pure_errors(subject: Subject) -> Mapping[str, float]:
    """Return the largest reported error of each quantity, over 1.5 turns, after the start."""
    done = subject.ran(TURN, 1.5)
    errors = subject.errors(done)
    if errors is None or done.status != "ok":
        return {"run": math.inf}
    rows = [row for row in errors.rows if row.kind == "total" and row.source == "reported"]
    each = {row.quantity: largest(r for r in rows if r.quantity == row.quantity) for row in rows}
    return {name: row.pure for name, row in each.items() if row is not None}


def unlike(
    plain: Mapping[str, float], other: Mapping[str, float], words: str, subject: Subject
) -> Iterator[str]:
    """Yield errors that differ in a scene that is equivalent as a mechanism. None are those of
    places below the engine's floor, and of rates below that in a step."""
    none = subject.beyond(NONE)
    rough = max(NONE, subject.engine.floor * TURN / math.tau)
    for name in plain.keys() | other.keys():
        one, two = plain.get(name, math.inf), other.get(name, math.inf)
        least = none if name in PLACES else rough
        if not (one <= TWICE * two + least and two <= TWICE * one + least):
            yield f"{words}, {name} is off by {two:.2g}, and by {one:.2g} unchanged"


@clause(
    "EC55",
    "free motion follows masses, speeds and gravity",
    "A free mechanism that falls differently is not the scene.",
    "Set the engine's gravity to scene.gravity_m_s2, for every body, give each its own mass and "
    "inertia, and damp nothing; or refuse drive free with EngineError.",
)
def _gravity(subject: Subject) -> Iterator[str]:
    fall_s = FALL_STEPS * subject.dt_s()
    pull = FALL * subject.scene.longest_m / (0.5 * fall_s**2)
    own, true = {}, {}
    for axis, gravity in {"": (0.0, 0.0), "x": (-pull, 0.0), "y": (0.0, -pull)}.items():
        heavy = subject.in_scene(replace(subject.scene, gravity_m_s2=gravity))
        poses = heavy.opened(drive="free", start=subject.start).record(FALL_STEPS, 1).poses
        own[axis] = _centres(subject.scene, poses, -1)
        if not axis:
            start = _centres(subject.scene, poses, 0)
        fallen = centres(heavy.scene, subject.start, fall_s, FALL_STEPS // 2)
        true[axis] = np.array([fallen[name] for name in bodies(subject.scene)])
    least = max(float(np.linalg.norm(true[axis] - true[""])) for axis in "xy")
    for axis in "xy":
        fall, wanted = own[axis] - own[""], true[axis] - true[""]
        if text := _apart(fall, wanted, least):
            yield f"free, gravity along {axis} moves the centres of mass by {text}"
    moved, wanted = own[""] - start, true[""] - start
    if text := _apart(moved, wanted, float(np.linalg.norm(wanted))):
        yield f"free and without gravity, the centres of mass move by {text}"


def _apart(own: Array, wanted: Array, size: float) -> str:
    """Return actual and required motion of places (n, 2), if too far apart over a size [m]."""
    off, gone, whole = (float(np.linalg.norm(each)) for each in (own - wanted, own, wanted))
    if off <= FALL_OFF * size:
        return ""
    return f"{gone:.2g} m, and the equations of motion by {whole:.2g} m: {off:.2g} m apart"


def _centres(scene: Scene, poses: Poses, sample: int) -> Array:
    """Return the centres of mass of all bodies at a sample [m], (n, 2)."""
    rows = []
    for name in bodies(scene):
        body, (x, y) = poses.bodies[name], centre_of(scene, name)
        c, s = math.cos(body.theta[sample]), math.sin(body.theta[sample])
        rows.append(body.origin[sample] + np.array([c * x - s * y, s * x + c * y]))
    return np.array(rows)


@clause(
    "EC57",
    "gears keep their ratio and cams their law, if the engine takes them",
    "A pair that slips, or has another sign, makes another motion.",
    "Keep scene.gears by Gear.relation and scene.cams by CamPair.lift at each step; or set "
    "Engine.applies_gears, applies_cams to False.",
    of_scenes=False,
)
def _pairs(subject: Subject) -> Iterator[str]:
    takes_gears, takes_cams = subject.engine.applies_gears, subject.engine.applies_cams
    names = ("gear-train", "planetary") * takes_gears + ("cam-roller", "cam-rocker") * takes_cams
    if not names:
        raise NotTriedError("applies_gears and applies_cams are False: it takes none")
    for name in names:
        worst, fault = _worst_place(subject.in_scene(load_scene(name)), STEPS[1])
        if worst is None:
            yield f"{name}: {fault}"
        elif not worst.pure <= subject.beyond(PAIR_OFF):
            yield f"{name}: {worst.body} is off by {worst.pure:.2g} after a turn"


CHANGES: Mapping[str, Callable[[Scene], Scene]] = {
    "turned by 0.7 rad": lambda scene: rotated(scene, 0.7),
    "moved by (3, -2) m": lambda scene: moved(scene, (3.0, -2.0)),
    "mirrored": lambda scene: mirrored(scene, sides_of(scene)),
    "ten times as large": lambda scene: scaled(scene, 10.0),
    "a tenth as large": lambda scene: scaled(scene, 0.1),
}


@clause(
    "EC56",
    "errors of place stay near `floor`, if that is above rounding in double precision",
    "Errors below the floor show neither a fault nor which of two engines is better.",
    "Set Engine.floor to the error that remains at small steps, as a pure number.",
    of_scenes=False,
)
def _floor(subject: Subject) -> Iterator[str]:
    floor = subject.engine.floor
    if floor <= AT_ROUNDING:
        raise NotTriedError("floor is rounding in double precision")
    worst, fault = _worst_place(subject, FINE)
    if worst is None:
        yield fault
    elif not floor <= FAR * worst.pure:
        yield f"floor is {floor:.2g}, and with {FINE} steps a turn it is off by {worst.pure:.2g}"


@clause(
    "EC61",
    "a turned, moved, mirrored or scaled scene has the same errors",
    "A sign or a number that suits one scene alone fails on another.",
    "Look for signs of angles, lines assumed level, and tolerances in metres.",
)
def _elsewhere(subject: Subject) -> Iterator[str]:
    plain = pure_errors(subject)
    for words, change in CHANGES.items():
        try:
            other = pure_errors(subject.in_scene(change(subject.scene)))
            yield from unlike(plain, other, words, subject)
        except NotTriedError as refused:
            yield f"{words}, it is refused: {refused}"
