"""How far the driver turns until all that acts on a machine repeats, and what never repeats."""

from __future__ import annotations

import math

import numpy as np

from analytic.forces.force_elements import spring_lengths
from analytic.kinematics import reach, repeats_after, unit_chunk
from analytic.structure.mobility import refuse_other_than_cranked
from models.characteristics import Constant
from models.errors import CrankcheckError, few
from models.laws import ConstantSpeed
from models.loads import Load
from models.scene import Scene
from models.tabulated import Tabulated

MOST_TURNS = 12
"""Of the mechanism's own cycle, within which that of the loads has to come round."""
MOST_PERIODS = 2000
"""Of a load in a cycle; all of them are worked out."""
CLOSE = 1e-9
"""What a period may be off a whole part of the cycle by, over it."""


def cycle_angle(scene: Scene) -> float:
    """The angle of the driver after which the machine is as it was [rad]: a turn, two of a
    four-stroke engine.

    Raises
    ------
    CrankcheckError
        A driver that does not turn round, or speeds up by its law; friction that follows the
        reactions; a load over time, or over the angle without a period; a spring that winds up.
    """
    _check_turns(scene)
    if scene.coulomb_joints:
        raise CrankcheckError(
            f"{scene.name}: friction.{scene.coulomb_joints[0]}: Coulomb's friction follows from "
            "the reactions, and no torque over angle and speed stands for it; give torque_n_m or "
            "force_n in its place"
        )
    own = repeats_after(scene)
    periods = [p for load in scene.loads.values() if (p := _period(scene, load)) is not None]
    for turns in range(1, MOST_TURNS + 1):
        whole = turns * own
        if all(abs(whole / p - round(whole / p)) <= CLOSE * max(1.0, whole / p) for p in periods):
            _check_springs(scene, whole)
            _check_periods(scene, whole)
            return whole
    told = few([f"{math.degrees(p):.6g} deg" for p in periods], 6)
    raise CrankcheckError(
        f"{scene.name}: loads over the angle repeat after {told}, the mechanism after "
        f"{math.degrees(own):.6g} deg; within {MOST_TURNS} times that they never meet, so that "
        "there is no cycle; give periods that go into a common angle"
    )


def _check_turns(scene: Scene) -> None:
    """Refuse a driver that no cycle is like the next of, or whose speed is no body's own."""
    refuse_other_than_cranked(scene, "a cycle of speed")
    if not (scene.is_free or isinstance(scene.driver.law, ConstantSpeed)):
        raise CrankcheckError(
            f"{scene.name}: its driver swings or speeds up by its law, and a cycle of speed is "
            'that of a driver that turns on; give it law = "constant", or "free"'
        )
    ranges = reach(scene)
    if ranges != [(-math.pi, math.pi)]:
        spans = [f"{math.degrees(a):.6g} to {math.degrees(b):.6g} deg" for a, b in ranges]
        raise CrankcheckError(
            f"{scene.name}: {scene.driver.link} does not turn round, and so has no cycle of speed: "
            f"it can stand at {' and '.join(spans) or 'no angle'}; drive a link that turns"
        )


def _period(scene: Scene, load: Load) -> float | None:
    """The driver's angle after which a load over it repeats; None where it follows no angle."""
    own = load.characteristic
    if isinstance(own, Constant):
        return None
    if load.over == "time":
        raise CrankcheckError(
            f"{scene.name}: loads.{load.name} follows time, which no cycle of the machine repeats; "
            "give it over the angle"
        )
    if load.over != "angle":
        return None
    if own.repeats_after is None:
        key = "period_deg" if isinstance(own, Tabulated) else "a table or a sum of waves"
        raise CrankcheckError(
            f"{scene.name}: loads.{load.name} follows the angle and never repeats; give {key}"
        )
    return own.repeats_after


def _check_periods(scene: Scene, whole_rad: float) -> None:
    """Refuse loads that repeat more often in a cycle than can be worked out."""
    for load in scene.loads.values():
        period = _period(scene, load)
        if period is not None and whole_rad / period > MOST_PERIODS:
            raise CrankcheckError(
                f"{scene.name}: loads.{load.name} repeats after {math.degrees(period):.6g} deg, "
                f"{whole_rad / period:.6g} times in a cycle of {math.degrees(whole_rad):.6g} deg; "
                f"at most {MOST_PERIODS} are worked out: give a longer period, or its mean"
            )


def _check_springs(scene: Scene, whole_rad: float) -> None:
    """Refuse springs that are wound up cycle by cycle."""
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    chunk = unit_chunk(scene, start + np.array([0.0, whole_rad]), bound=False)
    for spring, q, _ in spring_lengths(scene, chunk, counted=True):
        if spring.rate and abs(q[1] - q[0]) > 1.0:  # a turn or more: lengths come back
            raise CrankcheckError(
                f"{scene.name}: springs.{spring.name} is wound up by "
                f"{math.degrees(q[1] - q[0]):.4g} deg in every cycle, so that none is like the "
                "next; leave it out"
            )
