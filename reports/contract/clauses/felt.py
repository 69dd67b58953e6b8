"""Loads and friction that an engine declares: they act in full and in time."""

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np

from analytic.forces import kinetostatics
from models.array import Array
from models.motion import Forces
from models.scene import Scene
from models.scene.characteristics import Constant, Sine
from models.scene.joints import blocks, bodies, centre_of, joined_at, mass_of
from models.scene.loads import ConstantFriction, Load
from reports.contract.clauses.reactions import LATE, OFF, START, STEPS, largest, late_by, named
from reports.contract.subject import NotTriedError, Subject, clause, numbers
from sim.engine import Poses
from sim.engine.measure import energy, motion

SHARE = 0.98
"""Share of all samples that have to be within `OFF`: friction jumps where a joint turns back, and
its value there depends on rounding."""
BRAKED, BRAKE_OFF = 0.3, 0.05
"""Kinetic energy that friction takes from a free motion, over that of the start, and its largest
error, over it."""
FREE_STEPS = 60
CENTRE = "centre of mass"
"""A point that no scene has, as names hold no space."""


@clause(
    "EC85",
    "loads act as the scene states, if applies_loads is True",
    "A load that is missing, late or in another frame makes another machine.",
    "Apply each load of scene.loads at every step, in free motion too: at its point, in its "
    "frame, with the size of load_magnitudes at the time of the forces; or leave applies_loads "
    "False.",
)
def _loads(subject: Subject) -> Iterator[str]:
    engine, scene = subject.engine, subject.scene
    if not engine.applies_loads:
        raise NotTriedError("applies_loads is False: it takes no loads")
    if engine.forces_of == "nothing":
        yield from _as_weight(subject)
        return
    # Forces that come from the change of momentum have all loads, pushed or not.
    with suppress(NotTriedError):
        yield from _as_weight(subject)
    moving = [
        (n, p) for n, each in scene.links.items() for p in each.points if p not in scene.ground
    ]
    (link, point), size = moving[-1], _size(scene)
    wave = Sine(size, 0.5 * scene.driver.law.period_s, 0.4)
    couple = Sine(size * scene.longest_m, math.pi, 0.7)
    plain = subject.acting(STEPS)
    for words, load in {
        "a force over time in the ground's frame": Load("load", link, point, wave),
        "a constant force in the body's frame": Load(
            "load", link, point, Constant(size), direction_rad=2.0, frame="body"
        ),
        "a torque over the driver's angle": Load("load", link, None, couple, "angle"),
    }.items():
        for text in _unfelt(subject, plain, replace(scene, loads={"load": load}), 1.0):
            yield f"{words} on {link}: {text}"


def _freed(subject: Subject) -> Poses:
    """Return a short free motion from the start. Raises NotTriedError."""
    return subject.opened(drive="free").record(FREE_STEPS, 1).poses


def _as_weight(subject: Subject) -> Iterator[str]:
    """Yield faults where, free, loads like the weights move bodies otherwise than gravity."""
    scene, fall_s = subject.scene, FREE_STEPS * subject.dt_s()
    pull = 0.4 * scene.longest_m / fall_s**2
    heavy = replace(scene, gravity_m_s2=(0.6 * pull, -0.8 * pull))
    light = replace(scene, gravity_m_s2=(0.0, 0.0))
    ways = [heavy, _weighed(light, pull, math.atan2(-0.8, 0.6)), light]
    fallen = [numbers(_freed(subject.in_scene(way)), bodies(scene))[-1] for way in ways]
    off, whole = (float(np.abs(fallen[0] - other).max()) for other in fallen[1:])
    if not off <= OFF * whole:
        yield (
            f"free, loads equal to its weight and gravity move it differently, by {off / whole:.2g}"
        )


def _weighed(scene: Scene, pull: float, down_rad: float) -> Scene:
    """Return the scene with the weight of each body as a load at a point of its own."""
    links = {
        name: replace(link, points={**link.points, f"{CENTRE} {name}": centre_of(scene, name)})
        for name, link in scene.links.items()
    }
    at = {name: f"{CENTRE} {name}" for name in links}
    at |= {name: slider.point for name, slider in blocks(scene).items()}
    loads = {
        name: Load(
            name, name, point, Constant(pull * mass_of(scene, name)[0]), direction_rad=down_rad
        )
        for name, point in at.items()
    }
    return replace(scene, links=links, loads=loads)


@clause(
    "EC86",
    "constant friction acts as the scene states, if applies_constant_friction is True",
    "Friction opposes the relative motion of two bodies, and acts on both.",
    "Let it act on both bodies of the joint, against their relative speed; or leave "
    "applies_constant_friction False.",
)
def _friction(subject: Subject) -> Iterator[str]:
    engine, scene = subject.engine, subject.scene
    if not engine.applies_constant_friction:
        raise NotTriedError("applies_constant_friction is False: it takes no friction")
    subject.reports_forces()
    size = 0.2 * _size(scene)
    pins = [point for point, names in joined_at(scene).items() if len(names) == 2]
    pins = [point for point in pins if point not in scene.sliders]
    rubbing = [(point, size * scene.longest_m) for point in pins[-1:]]
    plain = subject.acting(STEPS)
    for joint, most in [*rubbing, *((name, size) for name in list(scene.sliders)[-1:])]:
        changed = replace(scene, friction={joint: ConstantFriction(joint, most)})
        for text in _unfelt(subject, plain, changed, SHARE):
            yield f"friction in {joint}: {text}"
        # Forces that come from the change of momentum have all friction, felt or not.
        with suppress(NotTriedError):
            for text in _unbraked(subject, joint):
                yield f"friction in {joint}: {text}"


def _unbraked(subject: Subject, joint: str) -> Iterator[str]:
    """Yield a fault where friction takes another energy from a free motion than its work."""
    light = replace(subject.scene, gravity_m_s2=(0.0, 0.0), loads={}, springs={}, friction={})
    plain = _freed(subject.in_scene(light))
    energy_j = energy(light, plain).kinetic_j
    size = BRAKED * float(energy_j[0]) / _way(light, joint, plain)
    rubbing = replace(light, friction={joint: ConstantFriction(joint, size)})
    braked = _freed(subject.in_scene(rubbing))
    taken_j = float(energy_j[-1] - energy(rubbing, braked).kinetic_j[-1])
    work_j = size * _way(light, joint, braked)
    if not abs(taken_j - work_j) <= BRAKE_OFF * work_j:
        yield f"free, it takes {taken_j:.2g} J from the motion, and its work is {work_j:.2g} J"


def _way(scene: Scene, joint: str, poses: Poses) -> float:
    """Return the way that two bodies rub along in a joint [rad or m]."""
    seen = motion(scene, poses)
    if joint in scene.sliders:
        place = seen.sliders[joint].displacement
    else:
        angles = [seen.links[n].theta if n in seen.links else 0.0 for n in joined_at(scene)[joint]]
        place = np.asarray(angles[1] - angles[0])
    return float(np.abs(np.diff(place)).sum())


def _size(scene: Scene) -> float:
    """Return the largest force of the motion itself [N]."""
    times = np.linspace(0.0, scene.driver.law.period_s, 50)
    return largest(kinetostatics.forces(scene, times, bound=False, skip_dead_points=True))


def _unfelt(subject: Subject, plain: Forces, changed: Scene, share: float) -> Iterator[str]:
    """Yield changes of the reference forces by a change of the scene that the engine's, ``plain``
    without it, lack."""
    scenes = (changed, subject.scene)
    each_own = subject.in_scene(changed).acting(STEPS), plain
    own = [forces.stretch(slice(START, None)) for forces in each_own]
    true = [
        kinetostatics.forces(each, own[0].time_s, bound=False, skip_dead_points=True)
        for each in scenes
    ]
    more, wanted = _change(*own), _change(*true)
    longest = changed.longest_m
    size = max(1e-300, _most(wanted, "force"), _most(wanted, "moment") / longest)
    off = {
        name: float(np.nanquantile(np.abs(each - wanted[name]), share))
        / (size if _kind(name) == "force" else size * longest)
        for name, each in more.items()
        if np.isfinite(each).any()
    }
    if not off:
        yield "no force is reported"
        return
    worst = max(off, key=lambda name: off[name])
    if not off[worst] <= OFF:
        yield f"the change of the {worst} is wrong by {off[worst]:.2g} of the largest"
        return
    if share < 1.0:
        return  # it jumps, which shows no time
    late = late_by(more, wanted, subject.dt_s(STEPS))
    worst = max(late, key=lambda name: abs(late[name]), default="")
    if worst and not abs(late[worst]) <= LATE:
        yield f"the {worst} responds {late[worst]:+.2f} steps after the load"


def _change(one: Forces, other: Forces) -> dict[str, Array]:
    before = dict(named(other))
    return {name: each - before[name] for name, each in named(one)}


def _kind(name: str) -> str:
    return "force" if "force" in name else "moment"


def _most(series: dict[str, Array], kind: str) -> float:
    each = [np.nanmax(np.abs(values)) for name, values in series.items() if _kind(name) == kind]
    return max(map(float, each), default=0.0)
