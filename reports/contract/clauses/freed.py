"""Free motion: springs that hold it, its energy, and motors that depend on its speed."""

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import Motion, State
from models.scene import Driver, Scene
from models.scene.characteristics import Polynomial
from models.scene.driver import Released
from models.scene.loads import Load
from reports.contract.clauses.reactions import pulled
from reports.contract.oscillators import (
    BASE_RAD,
    BLOCK_KG,
    DECAY,
    LENGTH_M,
    MASS_KG,
    PACE,
    PERIODS,
    SAMPLES,
    STEPS,
    Oscillator,
    block_scene,
    block_state,
    oscillators,
    rod_scene,
    rod_state,
)
from reports.contract.subject import NotTriedError, Subject, clause
from sim.engine.measure import energy, motion

PACE_OFF, DECAY_OFF, REST_OFF = 0.02, 0.2, 0.02
"""Largest errors of an oscillation: of its pace, over that of its spring; its decay, over it; and
its place of rest, over the amplitude: far above the effect of steps, far below another spring."""
ENERGY_STEPS = 1200, 2400
ENERGY_OFF, SHRUNK = 0.02, 0.7
"""Largest gain or loss of exchanged energy in a period: this part, or less than that share of the
value at half the steps."""
FIRST, LAST, RATE = 1.0, 4.0, 2.0
"""Speeds [rad/s or m/s] at the start and in the end, and decay rate of their difference [1/s]."""
SETTLING_STEPS, SETTLED = 600, 3.0
"""Steps in which a speed settles, and the duration, over 1 / `RATE`."""
SPEED_OFF = 0.02
"""Largest difference to its closed form, over its whole change."""


@clause(
    "EC91",
    "the springs of the scene are reported, if applies_springs is True",
    "A missing or different spring makes another machine; run refuses it.",
    "Give Facts.springs: rate, damping and free length or angle of each spring of "
    "scene.springs, as the engine holds them; or leave applies_springs False.",
    of_scenes=False,
)
def _held(subject: Subject) -> Iterator[str]:
    def check(one: Oscillator, own: Subject) -> Iterator[str]:
        steps = PERIODS * SAMPLES * STEPS
        facts = own.opened(drive="free", start=one.state, steps=steps).facts()
        try:
            own.refuse_other_model(one.state, facts, own.dt_s(steps), "free")
        except EngineError as error:
            yield str(error)

    yield from _each_spring(subject, check)


@clause(
    "EC92",
    "springs pull by their rate, damping, free length and ends, if they are applied",
    "These alone determine frequency, decay and rest of a mechanism on springs.",
    "Pull q back with rate (q - free) + damping q', on both bodies alike: q is the distance of "
    "two points (line_ends gives them on their bodies), the angle of a pin's second body "
    "against the first with its whole turns, or the displacement of a slider.",
    of_scenes=False,
)
def _swings(subject: Subject) -> Iterator[str]:
    def check(one: Oscillator, own: Subject) -> Iterator[str]:
        steps = PERIODS * SAMPLES * STEPS
        log = own.opened(drive="free", start=one.state, steps=steps).record(steps, STEPS)
        swing = one.read(log.poses)
        if log.diverged or math.isnan(swing.pace):
            yield "the body does not swing"
            return
        for words, unit, found, wanted, most in (
            ("swings at", "rad/s", swing.pace, PACE, PACE_OFF * PACE),
            ("dies away by", "1/s", swing.decay, DECAY, DECAY_OFF * DECAY),
            ("swings about", one.unit, swing.rest, one.rest, REST_OFF * abs(one.amplitude)),
        ):
            if not abs(found - wanted) <= most:
                yield f"the body {words} {found:.4g} {unit}, not {wanted:.4g}"

    yield from _each_spring(subject, check)


def _each_spring(
    subject: Subject, check: Callable[[Oscillator, Subject], Iterator[str]]
) -> Iterator[str]:
    """Yield faults of the springs of each kind that an engine can hold: on sliders, if it has
    them."""
    if not subject.engine.applies_springs:
        raise NotTriedError("applies_springs is False: it takes no springs")
    refusals = []
    for one in (every := list(oscillators())):
        try:
            for text in check(one, subject.in_scene(one.scene)):
                yield f"{one.words}: {text}"
        except NotTriedError as error:
            refusals.append(error)
    if len(refusals) == len(every):
        raise refusals[0]


@clause(
    "EC93",
    "free motion keeps its energy for a period, up to an error that shrinks with the step",
    "Energy that an engine adds or takes acts like a motor or a brake that is not in the scene.",
    "Look for damping that is left on, for joints whose correction moves bodies, and for "
    "positions that are moved with velocities of another instant; or refuse drive free.",
)
def _energy(subject: Subject) -> Iterator[str]:
    coarse, fine = (_drift(subject, steps) for steps in ENERGY_STEPS)
    if not fine <= ENERGY_OFF and not fine <= SHRUNK * coarse:
        yield (
            f"free, {fine:.2g} of the exchanged energy is gained or lost in a period of "
            f"{ENERGY_STEPS[1]} steps, and {coarse:.2g} in one of {ENERGY_STEPS[0]}"
        )


def _drift(subject: Subject, steps: int) -> float:
    """Return the largest gain or loss, as a part of the exchanged energy, in a period of ``steps``
    steps, under gravity."""
    scene = pulled(subject.scene)
    session = subject.in_scene(scene).opened(drive="free", start=subject.start, steps=steps)
    log = session.record(steps, 1)
    if log.diverged:
        return math.inf
    kept = energy(scene, log.poses)
    exchanged = 0.5 * float(np.ptp(kept.kinetic_j) + np.ptp(kept.potential_j))
    return float(np.abs(kept.total_j - kept.total_j[0]).max()) / exchanged


@clause(
    "EC94",
    "a load over a speed has the size of the speed at its instant",
    "A motor that does not feel its own speed never settles.",
    "load_magnitudes does not know these loads ahead: call Load.size at each step, with the "
    "angular velocity of the load's own body or the speed of its slider.",
    of_scenes=False,
)
def _by_speed(subject: Subject) -> Iterator[str]:
    if not subject.engine.applies_loads:
        raise NotTriedError("applies_loads is False: it takes no loads")
    inertia = MASS_KG * LENGTH_M**2 / 3.0
    motor = Load("motor", "rod", None, _by_rate(inertia), "omega")
    turning = _settling(rod_scene(), motor)
    yield from _unsettled(
        subject.in_scene(turning),
        rod_state(turning, BASE_RAD, FIRST, RATE * (LAST - FIRST)),
        "a torque over the angular velocity of its link",
        lambda own: own.links["rod"].omega,
    )
    direction = block_scene().sliders["C"].direction_rad
    along = Load("drag", "block C", "C", _by_rate(BLOCK_KG), "speed", "C", direction_rad=direction)
    sliding = _settling(block_scene(), along)
    with suppress(NotTriedError):  # an engine need not have sliders
        yield from _unsettled(
            subject.in_scene(sliding),
            block_state(sliding, 0.0, FIRST, RATE * (LAST - FIRST)),
            "a force over the speed of its slider",
            lambda own: own.sliders["C"].speed,
        )


def _by_rate(inertia: float) -> Polynomial:
    """Return the load over speed under which a mass, or a moment of inertia, settles."""
    return Polynomial((RATE * LAST * inertia, -RATE * inertia))


def _settling(scene: Scene, load: Load) -> Scene:
    driver = Driver(scene.driver.link, Released(BASE_RAD, 0.0, SETTLED / RATE))
    return replace(scene, loads={load.name: load}, driver=driver)


def _unsettled(
    subject: Subject, start: State, words: str, speed: Callable[[Motion], Array]
) -> Iterator[str]:
    """Yield a fault of a speed that begins at `FIRST` and should settle at `LAST`, at `RATE`."""
    session = subject.opened(drive="free", start=start, steps=SETTLING_STEPS)
    poses = session.record(SETTLING_STEPS, SETTLING_STEPS // 20).poses
    found = speed(motion(subject.scene, poses))
    wanted = LAST + (FIRST - LAST) * np.exp(-RATE * (poses.time_s + poses.lag_s))
    off = np.abs(found - wanted)
    if not off.max() <= SPEED_OFF * abs(LAST - FIRST):
        worst = int(np.argmax(np.nan_to_num(off, nan=math.inf)))
        yield (
            f"{words}: after {poses.time_s[worst]:.3g} s the speed is {found[worst]:.4g}, and "
            f"its closed form {wanted[worst]:.4g}"
        )
