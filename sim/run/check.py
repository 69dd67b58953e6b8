"""Comparison of the model in the engine with the requested scene, before the first step."""

import math
from collections.abc import Callable, Iterable, Iterator

import numpy as np

from models.errors import EngineError
from models.motion import State
from models.scene import Scene, driver, loads
from models.scene.joints import bodies, centre_of, frames, mass_of
from sim.engine import EPSILON, Drive, Engine, Facts, Precision, measure
from sim.engine.drive import pace, start_speed

SAME = 1e-9
"""Relative difference that counts as none: rounding of a few operations, far below any error."""
SHUT = 1e-12
"""Largest loop gap at the start, over the longest link, that counts as assembled."""
CLOSED = 10.0
"""Largest turn of a body [rad] where an engine closes an open start, over the gap in terms of the
longest link: the inverse of a fair transmission angle, and of a short link."""
ROUNDINGS = 16.0
"""Units of the last place of an engine's numbers that both of these allow at least."""


class OtherModelError(EngineError):
    """An engine that holds another model or start than was requested."""


def rounding_of(precision: Precision) -> float:
    """Return the relative difference of numbers of an engine that rounding explains."""
    return ROUNDINGS * EPSILON[precision]


def refuse_other_model(
    scene: Scene,
    state: State,
    facts: Facts,
    dt_s: float,
    drive: Drive,
    open_m: float = 0.0,
    precision: Precision = "double",
) -> None:
    """Refuse a model that differs from the scene. Raises OtherModelError with all differences.

    Compared are mass, inertia, gravity, springs, beams, position and angle of every body, loop
    gaps, and the velocities at the engine's own instant. A prescribed crank need not have a mass,
    nor a body that cannot turn an inertia; a free crank needs both, and nothing else. ``precision``
    is that of the engine's numbers.
    """
    rounding = rounding_of(precision)
    same = max(SAME, rounding)
    faults = [
        *_matter(scene, facts, drive, same),
        *_springs(scene, facts, same),
        *_beams(scene, facts, same),
        *_state(scene, state, facts, dt_s, drive, same + CLOSED * open_m / scene.longest_m),
        *_gaps(scene, facts, open_m, max(SHUT, rounding)),
    ]
    if faults:
        raise OtherModelError(f"the engine does not hold {scene.name}: " + "; ".join(faults))


def refuse_unknown_forces(
    scene: Scene,
    engine: Engine,
    *,
    with_forces: bool,
    applying: Callable[[str], Iterable[str]] = lambda what: (),
) -> None:
    """Refuse loads, springs or friction that an engine would silently leave out, and forces of an
    engine that reports none; for beams and gears the message names the engines ``applying`` them.
    Raises EngineError."""
    for what in ("loads", "springs"):
        given = getattr(scene, what)
        if given and not getattr(engine, f"applies_{what}"):
            names = ", ".join(f"{what}.{name}" for name in given)
            raise EngineError(
                f"{scene.name}: {engine.name} gets no {what} ({names}) here; remove them to run "
                "it, or use the reference alone"
            )
    touching = [name for name, pair in scene.cams.items() if pair.facets]
    segments = (
        "links that do not stretch can be rigid segments with springs between them (--springs "
        "plain)"
    )
    for what, held, cure in (
        ("beams", scene.beams, segments),
        ("gears", scene.gears, "run one of those"),
        ("cams", scene.cams, "run one of those"),
        ("cams by contact", touching, "give it facets = 0"),
    ):
        flag = what.replace(" ", "_")
        if held and not getattr(engine, f"applies_{flag}"):
            able = " or ".join(applying(flag)) or "no engine here"
            raise EngineError(
                f"{scene.name}: {what} ({', '.join(held)}) in {engine.name} are not offered by "
                f"crankcheck, but in {able}; {cure}"
            )
    for name, pair in scene.cams.items():
        if any(jump.lift or jump.velocity for jump in pair.profile.law.jumps):
            raise EngineError(
                f"{scene.name}: the velocity of the law of cams.{name} jumps, an infinite "
                "acceleration, which no engine follows; give a law of continuous velocity"
            )
    if touching and with_forces:
        raise EngineError(
            f"{scene.name}: a cam by contact presses on its follower at the contact, and the "
            f"reference along its path; run {engine.name} without forces, or with facets = 0"
        )
    if isinstance(scene.driver.law, driver.Controlled):
        raise EngineError(
            f"{scene.name}: its driver is controlled, and {engine.name} gets no such driver "
            'here; use law = "constant", or use the reference alone'
        )
    rubbing = [
        f"friction.{name}"
        for name in scene.friction
        if name in scene.coulomb_joints or not engine.applies_constant_friction
    ]
    if rubbing:
        raise EngineError(
            f"{scene.name}: {engine.name} gets no such friction ({', '.join(rubbing)}) here; "
            "remove it to run it, or use the reference alone"
        )
    if with_forces and engine.forces_of == "nothing":
        why = engine.no_forces and f": {engine.no_forces}"
        raise EngineError(
            f"{engine.name} reports no forces{why}; run it without, or another engine"
        )


def _matter(scene: Scene, facts: Facts, drive: Drive, same: float) -> Iterator[str]:
    for body in bodies(scene):
        mass, inertia = mass_of(scene, body)
        if body not in facts.mass_kg:
            if body != scene.driver.link or drive != "prescribed":
                yield f"{body} has no mass_kg"
        elif not math.isclose(facts.mass_kg[body], mass, rel_tol=same):
            yield f"{body} has mass_kg {facts.mass_kg[body]:g}, not {mass:g}"
        centre, wanted = facts.centre_m.get(body), centre_of(scene, body)
        if centre is not None and math.dist(centre, wanted) > same * scene.longest_m:
            yield f"{body} has centre_m {centre}, not {wanted}"
        own = facts.inertia_kg_m2.get(body, inertia)
        if not math.isclose(own, inertia, rel_tol=same):
            yield f"{body} has inertia_kg_m2 {own:g}, not {inertia:g}"
    if math.dist(facts.gravity_m_s2, scene.gravity_m_s2) > same * math.hypot(*scene.gravity_m_s2):
        yield f"gravity is {facts.gravity_m_s2}, not {scene.gravity_m_s2} m/s^2"


def _springs(scene: Scene, facts: Facts, same: float) -> Iterator[str]:
    """Yield differences of springs; a free length of 0 has no relative difference."""
    for name, spring in scene.springs.items():
        if name not in facts.springs:
            yield f"springs.{name} is not there"
            continue
        turning = isinstance(spring, loads.PinSpring)
        length = 1.0 if turning else scene.longest_m
        for what, found, wanted, scale in zip(
            ("rate", "damping", "free"),
            facts.springs[name],
            (spring.rate, spring.damping, spring.free),
            (0.0, 0.0, length),
            strict=True,
        ):
            if not abs(found - wanted) <= same * max(abs(wanted), scale):
                yield f"springs.{name} has {what} {found:g}, not {wanted:g}"
    for name in facts.springs:
        if name not in scene.springs:
            yield f"springs.{name} is none of the scene"


def _beams(scene: Scene, facts: Facts, same: float) -> Iterator[str]:
    """Yield differences of beams, at their first element."""
    for name, beam in scene.beams.items():
        elements = facts.beams.get(name, ())
        if len(elements) != beam.elements:
            yield f"{name} has {len(elements)} elements, not {beam.elements}"
        for what, wanted in (
            ("length_m", beam.element_m),
            ("density_kg_m", beam.density_kg_m),
            ("flexural_n_m2", beam.flexural_n_m2),
            ("axial_n", beam.axial_n),
            ("damping_s", beam.damping_s),
        ):
            for i, element in enumerate(elements, start=1):
                own = getattr(element, what)
                if not abs(own - wanted) <= same * abs(wanted):
                    yield f"element {i} of {name} has {what} {own:g}, not {wanted:g}"
                    break


def _state(
    scene: Scene, state: State, facts: Facts, dt_s: float, drive: Drive, same: float
) -> Iterator[str]:
    """Yield differences of position and velocity.

    Angular velocities are compared at the engine's own instant, to the second order of a delay.
    Velocities of origins there follow from a chord in one engine and a tangent in another, so they
    may differ by half a step's acceleration. A crank that follows another law than constant speed
    starts with a chord of the law.
    """
    delay = facts.velocity_shift * dt_s
    wanted = frames(scene, state, delay)
    peak = max(pace(scene, state, drive), *(abs(w) for w in state.omega.values()))
    rate = max(peak, math.sqrt(max(abs(a) for a in state.alpha.values())))
    slack = (delay * rate) ** 2 * peak
    if drive != "free":
        crank = start_speed(scene.driver.law, state.time_s, dt_s, facts.velocity_shift)
        if scene.driver.is_crank:
            own = wanted[scene.driver.link].omega
        else:  # a block without mass has no frame
            own = float(scene.driver.law.at(np.array([state.time_s + delay]))[1][0])
        slack += abs(crank - own) / scene.driver_arm_m
    # Rounding scales with the longest length or coordinate [m].
    length = max(scene.longest_m, *(math.hypot(*p) for p in state.position.values()))
    push = max(math.hypot(*a) for a in state.acceleration.values())
    for body in bodies(scene):
        frame, pose = wanted[body], facts.start.bodies[body]
        turn = abs(math.remainder(float(pose.theta[0]) - frame.theta, math.tau))
        if not turn <= same:
            yield f"{body} stands at {pose.theta[0]:g} rad, not {frame.theta:g}"
        if not np.hypot(*(pose.origin[0] - frame.origin)) <= same * length:
            yield f"{body} lies at {pose.origin[0]}, not {frame.origin} m"
        if not abs(pose.omega[0] - frame.omega) <= same * peak + 4.0 * slack:
            yield f"{body} turns at {pose.omega[0]:g} rad/s, not {frame.omega:g}"
        off = float(np.hypot(*(pose.velocity[0] - frame.velocity)))
        if not off <= (same * peak + 4.0 * slack) * length + 2.0 * abs(delay) * push:
            yield f"{body} moves at {pose.velocity[0]} m/s, not {frame.velocity}"


def _gaps(scene: Scene, facts: Facts, open_m: float, shut: float) -> Iterator[str]:
    """Yield joints that are open at the start by more than ``open_m`` [m]."""
    farthest = max(float(np.abs(facts.start.bodies[link].origin).max()) for link in scene.links)
    limit = shut * max(scene.longest_m, farthest)
    for name, gap in measure.gaps(scene, facts.start).items():
        if not gap[0] <= limit + open_m:
            yield f"{name} is open by {gap[0]:.2e} m"
