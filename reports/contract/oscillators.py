"""Independent references for free motion: oscillators, and a mechanism under gravity alone.

::

    q'' + 2 decay q' + pace^2 (q - rest) = 0

A rod on a pin, with a spring in the pin, or between its end and a point across its way; a block on
a line, with a spring along it, or to a point of it. Without weight; released at rest. An engine's
motion is identified from samples at even times: q(n + 1) = a q(n) + b q(n - 1) + c holds for each
such motion to the last digit, and a, b, c determine pace, decay and rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.motion import State
from models.scene import GROUND, Driver, Link, Point, Scene, Slider
from models.scene.driver import Released
from models.scene.joints import bodies, centre_of, frames
from models.scene.loads import LineSpring, PinSpring, SlideSpring, Spring
from sim.engine import Poses
from sim.engine.measure import motion

PACE, DECAY = 10.0, 0.5
"""Pace and decay of all of them, in rad/s and 1/s."""
PERIODS, SAMPLES, STEPS = 3, 16, 40
"""Number of periods, samples in each, and steps between two samples."""
DURATION_S = PERIODS * math.tau / PACE
LENGTH_M, MASS_KG, BLOCK_KG = 0.5, 1.2, 0.8
BASE_RAD = 0.7
"""Angle of the rod when nothing turns it, where that can be chosen."""


@dataclass(frozen=True)
class Oscillator:
    """One body at a spring, at its release: ``body`` is the link, or the slider, with the angle or
    displacement q."""

    words: str
    scene: Scene
    state: State
    body: str
    rest: float
    amplitude: float

    @property
    def unit(self) -> str:
        return "rad" if self.body in self.scene.links else "m"

    def read(self, poses: Poses) -> SwingOscillator:
        """Return the oscillation in the poses."""
        seen = motion(self.scene, poses)
        if self.body in seen.links:
            return SwingOscillator.of(seen.links[self.body].theta, seen.time_s)
        return SwingOscillator.of(seen.sliders[self.body].displacement, seen.time_s)


@dataclass(frozen=True)
class SwingOscillator:
    """Natural angular velocity [rad/s], decay [1/s] and place of rest; NaN where none swings."""

    pace: float
    decay: float
    rest: float

    @staticmethod
    def of(q: Array, time_s: Array) -> SwingOscillator:
        """Return the oscillation of samples at even times."""
        step_s = float(time_s[1] - time_s[0])
        if not np.isfinite(q).all():
            return SwingOscillator(math.nan, math.nan, math.nan)
        rows = np.stack([q[1:-1], q[:-2], np.ones(len(q) - 2)], axis=1)
        a, b, c = np.linalg.lstsq(rows, q[2:], rcond=None)[0]
        still = not np.ptp(q) > 1e-9 * np.abs(q).max()
        if still or not -b > 0.0 or not abs(0.5 * a / math.sqrt(-b)) < 1.0:
            return SwingOscillator(math.nan, math.nan, math.nan)
        decay = -math.log(-b) / (2.0 * step_s)
        damped = math.acos(0.5 * a / math.sqrt(-b)) / step_s
        return SwingOscillator(math.hypot(damped, decay), decay, float(c / (1.0 - a - b)))


def oscillators() -> Iterator[Oscillator]:
    """Yield one oscillator for each kind of spring, rods first."""
    inertia = MASS_KG * LENGTH_M**2 / 3.0
    stiff, damping = inertia * PACE**2, 2.0 * DECAY * inertia
    # The free angle lies beyond half a turn, so that a wrapped angle is not where it has to be.
    turned = PinSpring("pin", stiff, damping, math.pi + 0.2, "A", (GROUND, "rod"))
    yield _rod("a spring in a pin", turned, rest=math.pi + 0.2, amplitude=-0.5)
    # At rest the spring is slack and stands square on the rod.
    gap = 0.8
    c, s = math.cos(BASE_RAD), math.sin(BASE_RAD)
    far = LENGTH_M * c - gap * s, LENGTH_M * s + gap * c
    across = LineSpring("line", stiff / LENGTH_M**2, damping / LENGTH_M**2, gap, ("D", "B"))
    yield _rod("a spring between two points", across, BASE_RAD, 0.04, {"D": far})
    stiff, damping = BLOCK_KG * PACE**2, 2.0 * DECAY * BLOCK_KG
    along = SlideSpring("slider", stiff, damping, 0.1, "C")
    yield _block("a spring along a slider", along, rest=0.1, amplitude=0.15)
    to_point = LineSpring("block", stiff, damping, 0.5, ("E", "C"))
    yield _block("a spring between a point and a slider", to_point, rest=-0.1, amplitude=0.15)


def rod_scene(points: dict[str, Point] | None = None) -> Scene:
    """Return a rod from A to B on a pin, without weight; with other points of the ground."""
    rod = Link(
        "rod",
        {"A": (0.0, 0.0), "B": (LENGTH_M, 0.0)},
        MASS_KG,
        (LENGTH_M / 2.0, 0.0),
        MASS_KG * LENGTH_M**2 / 12.0,
    )
    law = Released(BASE_RAD, 0.0, DURATION_S)
    ground = {"A": (0.0, 0.0), **(points or {})}
    return Scene("rod", "contract", ground, {"rod": rod}, {}, Driver("rod", law))


def block_scene() -> Scene:
    """Return a block on a line beside a still rod; E lies on the line, 0.6 m before it."""
    through, direction = (0.1, -0.2), 0.5
    behind = through[0] - 0.6 * math.cos(direction), through[1] - 0.6 * math.sin(direction)
    slider = Slider("C", "C", GROUND, through, direction, mass_kg=BLOCK_KG, inertia_kg_m2=0.01)
    return replace(rod_scene({"E": behind}), name="block", sliders={"C": slider})


def rod_state(scene: Scene, theta: float, omega: float, alpha: float) -> State:
    """Return the state of the rod at an angle."""
    c, s = math.cos(theta), math.sin(theta)
    tip = LENGTH_M * c, LENGTH_M * s
    return State(
        time_s=0.0,
        theta={"rod": theta},
        omega={"rod": omega},
        alpha={"rod": alpha},
        position={**scene.ground, "B": tip},
        velocity={
            **dict.fromkeys(scene.ground, (0.0, 0.0)),
            "B": (-omega * tip[1], omega * tip[0]),
        },
        acceleration={
            **dict.fromkeys(scene.ground, (0.0, 0.0)),
            "B": (-alpha * tip[1] - omega**2 * tip[0], alpha * tip[0] - omega**2 * tip[1]),
        },
        displacement={},
        speed={},
    )


def block_state(scene: Scene, place_m: float, speed_m_s: float, push_m_s2: float) -> State:
    """Return the state of the block at a displacement, and the rod at rest."""
    slider, rod = scene.sliders["C"], rod_state(scene, BASE_RAD, 0.0, 0.0)
    c, s = math.cos(slider.direction_rad), math.sin(slider.direction_rad)
    x, y = slider.through_m
    return replace(
        rod,
        position={**rod.position, "C": (x + place_m * c, y + place_m * s)},
        velocity={**rod.velocity, "C": (speed_m_s * c, speed_m_s * s)},
        acceleration={**rod.acceleration, "C": (push_m_s2 * c, push_m_s2 * s)},
        displacement={"C": place_m},
        speed={"C": speed_m_s},
    )


def _rod(
    words: str,
    spring: Spring,
    rest: float,
    amplitude: float,
    points: dict[str, Point] | None = None,
) -> Oscillator:
    bare = rod_scene(points)
    law = Released(rest + amplitude, 0.0, DURATION_S)
    scene = replace(bare, springs={spring.name: spring}, driver=Driver("rod", law))
    state = rod_state(scene, rest + amplitude, 0.0, -(PACE**2) * amplitude)
    return Oscillator(words, scene, state, "rod", rest, amplitude)


def _block(words: str, spring: Spring, rest: float, amplitude: float) -> Oscillator:
    scene = replace(block_scene(), springs={spring.name: spring})
    state = block_state(scene, rest + amplitude, 0.0, -(PACE**2) * amplitude)
    return Oscillator(words, scene, state, "C", rest, amplitude)


def centres(scene: Scene, state: State, duration_s: float, steps: int) -> Mapping[str, Point]:
    """Return the centres of mass a while after the driver's release [m].

    The equations of motion of all bodies (`analytic.multibody`) are stepped by the fourth-order
    Runge-Kutta method, without correction of the joints' drift: it is for short motions, and to a
    thousandth.

    Raises CrankcheckError for a freedom without mass, or a start in a change point.

    Parameters
    ----------
    scene : Scene
        A mechanism with its masses and its gravity; loads and friction are left out.
    state : State
        The mechanism at its release.
    duration_s : float
        The duration of free motion [s].
    steps : int
        Steps of the integration.
    """
    # scipy, which takes longer to import than most clauses to check, each in a process apart
    from analytic.multibody.multibody_motion import Baumgarte
    from analytic.multibody.release_multibody import release_multibody

    heavy = replace(scene, loads={}, springs={}, friction={})
    plain = Baumgarte(0.0, 0.0, step_s=duration_s / steps)
    free = release_multibody(heavy, duration_s, plain, near=state)
    placed = frames(heavy, free.at(np.array([duration_s])).state())
    return {body: placed[body].at(centre_of(heavy, body)) for body in bodies(heavy)}
