"""Forces of the joints and the drive: reactions, forces and moments of sliders, driving torque.

They are compared on request, at the instants at which the engine states that they act. Errors are
shares of the largest of the reference over the run (``F`` of reactions, ``M`` of the torque): a
reaction that passes through 0 is as hard on an engine as any other.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from models.array import Array
from models.motion import ForceBound, Forces, Motion
from models.scene import Scene
from reports.quantities.quantity import BodyKind, Criterion, Measure, Quantity, Series, Tolerance
from sim.engine import Run

LEAST_ARM = 0.1
"""The least arm of a torque, over the longest link: a torque whose largest is under this part of
the largest reaction times that link (that of a parallelogram at constant speed is 0) is scaled by
it. Of the shipped scenes none has less than 0.13."""
OPEN_SHARE = 3e-4
"""Three times the part of a force that MuJoCo's stiffest documented impedance (0.9999) leaves; over
the largest of them no ratio of masses makes it more (0.001 to 1000 times the mass of any link)."""
TAKEN_UP = Tolerance(
    "Second order: forces follow accelerations, at places with the error of a step, and a dyad "
    "enlarges them by 1/sine of its transmission angle. Further parts: the share of a force "
    "that soft constraints leave open, and the error of a load at a displaced slider.",
    cap=0.2,  # a fifth of the largest force; twice the worst at 90 steps a turn
    coefficient=12.0,
    power=1.0,
    conditioned=True,
    share=OPEN_SHARE,
    slope="reaction",
    rate=2,
    parts=True,
    makes_up=True,
)

FREE_FORCE = Tolerance(
    "That of the phase, times the rates of the accelerations, and the share of a force that "
    "soft constraints leave open.",
    cap=0.2,
    coefficient=6.0,
    power=2.0,
    lasting=1.8,
    drifting=1.0,
    opening=0.7,
    share=OPEN_SHARE,
    rate=2,
    parts=True,
    makes_up=True,
)


def acting(run: Run) -> Forces | None:
    """Return the forces that a run logged, without the start where they are those of steps; None
    where it logged none, or another number than its samples."""
    forces = run.motion.forces if run.motion is not None else None
    if forces is None or run.motion is None or forces.time_s.shape != run.motion.time_s.shape:
        return None
    return forces.stretch(slice(1, None)) if run.forces_of == "steps" else forces


def acting_at(run: Run) -> Array | None:
    """Return the instants at which the forces of a run act, None where unknown."""
    forces = acting(run)
    if forces is None or not np.all(np.isfinite(forces.time_s)):
        return None
    return forces.time_s


def unreported(run: Run, quantity: str, body: str) -> bool:
    """True for a force that the engine declares not to report."""
    missing = run.unreported
    if quantity == "reaction":
        return body.partition(" on ")[0] in missing.pins
    return missing.torque if quantity == "torque" else body in missing.sliders


def silent(run: Run) -> bool:
    """True if the engine gives a reason for missing forces."""
    forces = acting(run)
    return forces is not None and bool(forces.undetermined)


def largest_reaction(scene: Scene, reference: Motion) -> float:
    """Return the largest reaction in a pin, or normal force of a slider, over the run [N]; with
    gears or cams, which take the load past the joints, at least the torque over the longest link.
    """
    forces = reference.forces
    assert forces is not None
    pins = (np.hypot(*force.T) for bodies in forces.pins.values() for force in bodies.values())
    sliders = (np.abs(slider.normal) for slider in forces.sliders.values())
    passed = [np.abs(forces.torque) / scene.longest_m] if scene.gears or scene.cams else []
    return _largest(itertools.chain(pins, sliders, passed)) or 1.0


def largest_moment(scene: Scene, reference: Motion) -> float:
    """Return the moment of the largest reaction at the end of the longest link [N m]."""
    return largest_reaction(scene, reference) * scene.longest_m


def largest_torque(scene: Scene, reference: Motion) -> float:
    """Return the largest torque over the run, or of the largest reaction on the least arm [N m];
    for a driven slider the force, or the least share of that reaction [N]."""
    forces = reference.forces
    assert forces is not None
    bears = largest_reaction(scene, reference) if forces.pins else _inertia(scene)
    return max(
        _largest([np.abs(forces.torque)]), LEAST_ARM * scene.longest_m / scene.driver_arm_m * bears
    )


def _inertia(scene: Scene) -> float:
    """Return the inertia force of all masses at the speed of the longest link, and their weight
    [N]: redundant links have no known reaction."""
    masses = [link.mass_kg for link in scene.links.values()]
    masses += [slider.mass_kg for slider in scene.sliders.values()]
    push = scene.longest_m * scene.pace_rad_s**2 + math.hypot(*scene.gravity_m_s2)
    return sum(masses) * push or 1.0


def _largest(series: object) -> float:
    """Return the largest finite number of some series (T,), 0 where there is none."""
    sizes = [
        np.max(each, where=np.isfinite(each), initial=0.0)
        for each in series  # type: ignore[attr-defined]
    ]
    return float(max(sizes, default=0.0))


Read = Callable[[Scene, Forces | ForceBound], Series]


def _pins(_: Scene, forces: Forces | ForceBound) -> Series:
    """Return the force on the second of two bodies that meet in a pin; on each, where more meet."""
    found: dict[str, Array] = {}
    for point, bodies in forces.pins.items():
        if len(bodies) == 2:
            found[point] = list(bodies.values())[1]
        else:
            found |= {f"{point} on {body}": force for body, force in bodies.items()}
    return found


def _force(
    name: str,
    kind: BodyKind,
    read: Read,
    unit: str,
    share: str,
    scale: Callable[[Scene, Motion], float],
    criterion: Criterion,
) -> Quantity:
    def seen(scene: Scene, forces: Forces | ForceBound | None) -> Series:
        return {} if forces is None else read(scene, forces)

    measure = Measure(
        body_kind=kind,
        column=f"{name}_error_{unit.lower().replace(' ', '_')}",
        unit=unit,
        share=share,
        scale=scale,
        truth=lambda scene, reference: seen(scene, reference.forces),
        logged=lambda scene, run: seen(scene, acting(run)),
        bound=lambda scene, reference: seen(
            scene, own.bound if (own := reference.forces) else None
        ),
    )
    head, held = f"{criterion.short}\n/ {share}", replace(criterion, free_motion=FREE_FORCE)
    return Quantity(name, "force", (measure,), (held,), head, acting_at, silent)


CURE = (
    "Shorten the step; check the instant and the frame of the engine's forces: `crankcheck "
    "recipe forces --engine NAME` reads them correctly."
)
REACTION = _force(
    "reaction",
    "point",
    _pins,
    "N",
    "F",
    largest_reaction,
    Criterion(
        "CC120",
        "reaction",
        "The force in every pin, as a vector in the ground's frame, against kinetostatics at the "
        "instant of the force; at a pin of more than two bodies, that on each of them.",
        CURE,
        "react.",
        TAKEN_UP,
        diagram="reactions in pins",
    ),
)
NORMAL = _force(
    "normal",
    "slider",
    lambda _, forces: {name: slider.normal for name, slider in forces.sliders.items()},
    "N",
    "F",
    largest_reaction,
    Criterion(
        "CC121",
        "normal force",
        "The force that each guide exerts across its line, against kinetostatics.",
        CURE,
        "normal",
        TAKEN_UP,
        diagram="normal forces of sliders",
    ),
)
MOMENT = _force(
    "moment",
    "slider",
    lambda _, forces: {name: slider.moment for name, slider in forces.sliders.items()},
    "N m",
    "F L",
    largest_moment,
    Criterion(
        "CC122",
        "moment",
        "The moment that each guide exerts about the slider's point, against kinetostatics.",
        f"{CURE} A moment is about a point: about another it is another moment.",
        "moment",
        TAKEN_UP,
        diagram="moments of sliders",
    ),
)
TORQUE = _force(
    "torque",
    "driver",
    lambda scene, forces: {scene.driver.name: forces.torque},
    "N m",
    "M",
    largest_torque,
    Criterion(
        "CC123",
        "torque",
        "The torque that the drive exerts on the driver, against kinetostatics.",
        f"{CURE} The torque on a flywheel of the model is no part of it.",
        "torque",
        replace(
            TAKEN_UP,
            reason="That of reactions, times their arms.",
            slope="torque",
        ),
        diagram="driving torque",
    ),
)
