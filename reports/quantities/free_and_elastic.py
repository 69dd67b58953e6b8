"""The quantities of free motion alone (phase, geometry, conserved quantities), and of elastic
links.

Errors are shares of the largest deflection of the reference over the run (``D``), of all links: a
link that passes through its straight line is as hard on an engine there as elsewhere.
"""

from dataclasses import replace

import numpy as np

from models.motion import Motion
from models.scene import GROUND, Scene
from reports.quantities.places import driver_series
from reports.quantities.quantity import Criterion, Measure, Quantity, Series, Tolerance, every_place
from sim.engine import Run


def _driver_bound(scene: Scene, reference: Motion) -> Series:
    bound, driver = reference.bound, scene.driver
    if bound is None:
        return {}
    if driver.slider is not None:
        slider = bound.sliders.get(driver.slider)
        return {driver.name: slider.displacement / scene.driver_arm_m} if slider else {}
    links = [bound.links.get(name) for name in (driver.link, driver.base) if name != GROUND]
    if None in links:
        return {}
    return {driver.name: np.sum([link.theta for link in links if link], axis=0)}


PHASE = Quantity(
    name="phase",
    role="free",
    head="phase\n/ G",
    measures=(
        Measure(
            body_kind="driver",
            column="phase_error_rad",
            unit="rad",
            share="rad",
            scale=lambda scene, reference: 1.0,
            truth=driver_series,
            logged=lambda scene, run: driver_series(scene, run.motion),
            bound=_driver_bound,
        ),
    ),
    criteria=(
        Criterion(
            "CC127",
            "phase",
            "In free motion a mechanism that is slightly too fast or too slow drifts away. The "
            "driver's angle is compared with the integrated one at the same time, over the "
            "sensitivity of the motion: the growth of a small change of its start.",
            "Shorten the step (--dt), or use an integrator of higher order, and look for "
            "damping in the joints.",
            short="phase",
            diagram="phase: the driver's angle over the sensitivity",
            tolerance=Tolerance(
                "Second order for most of the time: a loss of energy makes an error of phase "
                "that grows with the square of time, and the sensitivity grows only with time.",
                cap=0.1,  # IFToMM's class of low precision, whatever the step
                coefficient=6.0,
                power=1.0,
                lasting=1.2,
                drifting=0.7,
                opening=0.5,
            ),
        ),
    ),
)
GEOMETRY = Quantity(
    name="geometry",
    role="free",
    head="geom.\nat phi",
    measures=(
        every_place("link", "geometry_angle_error_rad"),
        every_place("slider", "geometry_displacement_error_m"),
        every_place("point", "geometry_position_error_m"),
    ),
    criteria=(
        Criterion(
            "CC128",
            "geometry",
            "All places at the run's own angle: this separates an open linkage from an error of "
            "phase.",
            "Stiffen the loop (settings of the engine), or shorten the step.",
            short="geom",
            diagram="geometry at the run's own angle",
            tolerance=Tolerance(
                "A step moves the pins along tangents, which leaves a gap of step^2/2 times the "
                "curvature to close; a dyad enlarges it by 1/sine of its transmission angle.",
                cap=2e-2,
                coefficient=0.8,
                power=1.0,
                conditioned=True,
                closes=True,
            ),
        ),
    ),
)


def _nothing(scene: Scene, of: Motion | Run) -> Series:
    return {}


def _drift(column: str, unit: str, share: str) -> Measure:
    """Return one number of a whole run, which no series of the log has."""
    return Measure(
        body_kind="mechanism",
        column=column,
        unit=unit,
        share=share,
        scale=lambda scene, reference: 1.0,
        truth=_nothing,
        logged=_nothing,
    )


ENERGY = Quantity(
    name="energy",
    role="free",
    head="energy\n/ T",
    measures=(_drift("energy_drift_j", "J", "T"),),
    criteria=(
        Criterion(
            "CC129",
            "energy drift",
            "Drift of the engine's energy, less the work of loads and dampers: the mean over the "
            "last window less that over the first, as a share of the largest kinetic energy. An "
            "offset that comes and goes with the motion is no drift.",
            "Shorten the step (--dt); look for damping or driving of bodies that is not in the "
            "scene.",
            short="drift",
            diagram="drift of energy",
            tolerance=Tolerance(
                "Joints closed by impulses, or by springs with dampers, lag by the gap of a "
                "step: its work changes the energy with second order, and a part is lost at "
                "every step with third order.",
                cap=0.1,
                arc=4.0,
                late=0.5,
            ),
        ),
    ),
)
MOMENTUM = Quantity(
    name="momentum",
    role="free",
    measures=(_drift("momentum_drift_kg_m2_s", "kg m^2/s", "of the largest"),),
    criteria=(
        Criterion(
            "CC130",
            "momentum drift",
            "Without weight and loads, a mechanism that is pinned to the ground at one point keeps "
            "its angular momentum about that point.",
            "Look for damping in the pin, or for outside loads that are not in the scene.",
            short="mom",
            tolerance=Tolerance(
                "Pins exert no moment about themselves, at any step: rounding, and the gap of a "
                "step, remain.",
                cap=0.1,
                coefficient=10.0,
            ),
        ),
    ),
)


LEAST = 1e-9
"""The least deflection for shares of errors, over the longest link: below it a link is rigid to an
engine, whose joints are no nearer."""


def largest_deflection(scene: Scene, reference: Motion) -> float:
    """Return the largest deflection of the middle of any elastic link over the run [m]."""
    sizes = (float(np.max(np.abs(each), initial=0.0)) for each in _middles(reference).values())
    return max(*sizes, LEAST * scene.longest_m, 0.0)


def _middles(motion: Motion | None) -> Series:
    return {n: own.middle for n, own in motion.elastic.items()} if motion else {}


def _extensions(motion: Motion | None) -> Series:
    return {n: own.extension for n, own in motion.elastic.items()} if motion else {}


def _middle(column: str) -> Measure:
    return Measure(
        body_kind="link",
        column=column,
        unit="m",
        share="D",
        scale=largest_deflection,
        truth=lambda scene, reference: _middles(reference),
        logged=lambda scene, run: _middles(run.motion),
    )


BENT = Tolerance(
    "Sum of: the error of joints, step^2 of the longest link at the curvature, over the deflection "
    "(for a beam of an engine's own, without joints, step^2 of itself); the error of a spring's "
    "swing of r times the driver's speed, (r step)^2/24 of its phase in every swing; and, compared "
    "with the beam, the error of the exact chain of as many segments and the uncertainty of the "
    "beam.",
    cap=0.2,  # a fifth of the largest deflection: another stiffness, however coarse the chain
    coefficient=0.5,
    power=1.0,
    conditioned=True,
    bends=True,
)
CURE = (
    "Shorten the step (--steps-per-turn); check the rates of the springs between segments, and "
    "look for other bending or damping."
)


def _elastic(name: str, measure: Measure, head: str, criterion: Criterion) -> Quantity:
    return Quantity(name, "elastic", (measure,), (criterion,), head)


DEFLECTION = _elastic(
    "deflection",
    _middle("deflection_error_m"),
    "beam\n/ D",
    Criterion(
        "CC131",
        "deflection",
        "The distance of the middle of each elastic link from the line between its pins, against "
        "the beam with foreshortening, at the commanded time.",
        f"{CURE} More segments (--segments) come nearer to the beam, as 1/n^2.",
        short="bend",
        diagram="deflection of elastic links",
        tolerance=BENT,
    ),
)
SEGMENTS = _elastic(
    "segments",
    _middle("segments_error_m"),
    "engine\n/ D",
    Criterion(
        "CC132",
        "deflection of segments",
        "The same against the exact chain of as many segments, a multibody without an engine: the "
        "error of the engine itself.",
        CURE,
        short="chain",
        diagram="deflection of segments",
        tolerance=BENT,
    ),
)
EXTENSION = _elastic(
    "extension",
    replace(
        _middle("extension_error_m"),
        share="L",
        scale=lambda scene, reference: scene.longest_m,
        truth=lambda scene, reference: _extensions(reference),
        logged=lambda scene, run: _extensions(run.motion),
    ),
    "extens.\n/ L",
    Criterion(
        "CC133",
        "extension",
        "The change of distance between the pins of each elastic link since rest: a bent link is "
        "shorter.",
        CURE,
        short="ext",
        tolerance=Tolerance(
            "That of places: each pin has an error of step^2 at the curvature.",
            cap=2e-2,
            coefficient=2.0,
            power=1.0,
            conditioned=True,
        ),
    ),
)
