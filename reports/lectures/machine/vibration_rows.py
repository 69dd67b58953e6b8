"""Words on a steady vibration: natural frequencies, orders, deflections, notes."""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from analytic.elastic.natural import FrequencySensitivity, link_modes, lowest_rad_s
from analytic.lectures.vibration.floquet import STABLE
from analytic.lectures.vibration.over_speeds import HIGHEST, InertiaMap, OverSpeeds
from analytic.lectures.vibration.steady_vibration import SteadyVibration
from reports.output.numbers import readable

NEAR = 2.0
"""Sensitivity from which on a resonance is reported as near; without one it is about 1."""
THICK = 0.1
"""Deflection over the length beyond which the theory of a bent beam is left."""


@dataclass(frozen=True)
class LinkRow:
    """A natural frequency of a link between its pins alone [rad/s], and over the driver's speed."""

    link: str
    kind: str
    number: int
    frequency_rad_s: float
    ratio: float


@dataclass(frozen=True)
class ModeRow:
    """A mode of the mechanism: its natural frequency with the driver fixed, the least and the most
    over a turn [rad/s] and the mean over the driver's speed; its order while the driver turns, and
    the multiplier of a deviation over a turn."""

    mode: int
    least_rad_s: float
    most_rad_s: float
    ratio: float
    order: float
    multiplier: float


@dataclass(frozen=True)
class SwingRow:
    """The largest deflection of a link [m], over its length, its place [m from the first pin] and
    the driver's angle at it [deg]; the largest deflection of its middle and its extension [m]; and
    the deviations of the linear theories from the largest, as shares."""

    link: str
    largest_m: float
    share: float
    place_m: float
    at_deg: float
    middle_m: float
    extension_m: float
    linear_off: float
    unstiffened_off: float


def link_rows(vibration: SteadyVibration) -> list[LinkRow]:
    speed = vibration.speed_rad_s
    return [
        LinkRow(m.link, m.kind, m.number, m.frequency_rad_s, m.frequency_rad_s / speed)
        for m in link_modes(vibration.scene)
    ]


def mode_rows(vibration: SteadyVibration) -> list[ModeRow]:
    natural, speed = vibration.natural, vibration.speed_rad_s
    least, most = (own(natural.frequency_rad_s, axis=0) for own in (np.min, np.max))
    return [
        ModeRow(
            each.mode, float(least[each.mode - 1]), float(most[each.mode - 1]),
            float(natural.mean_rad_s[each.mode - 1]) / speed, each.order, each.size,
        )
        for each in vibration.stability.deviations
    ]  # fmt: skip


def swing_rows(vibration: SteadyVibration) -> list[SwingRow]:
    linear, unstiffened = vibration.theories.values()
    angles = np.degrees(vibration.angles)
    return [
        SwingRow(
            name, own.largest_m, own.share, own.place_m, float(angles[own.when]) % 360.0,
            float(np.abs(own.middle).max()), float(np.abs(own.extension).max()),
            linear[name].largest_m / own.largest_m - 1.0,
            unstiffened[name].largest_m / own.largest_m - 1.0,
        )
        for name, own in vibration.swings.items()
        if own.largest_m
    ]  # fmt: skip


def heading(vibration: SteadyVibration) -> str:
    """The heading: scene, elastic links, speed, and frequency ratio."""
    scene, speed = vibration.scene, vibration.speed_rad_s
    links = ", ".join(scene.elastic)
    ratio = lowest_rad_s(scene) / speed
    return (
        f"{scene.name}: steady vibration of {links}, {scene.driver.link} at {speed:.6g} rad/s; the "
        f"lowest natural frequency of a link is {ratio:.4g} times that"
    )


def notes(vibration: SteadyVibration) -> list[str]:
    """Notes on stability, resonance and damping, and on the meaning of the numbers."""
    told = [stability_text(vibration), resonance_text(vibration.motion.sensitivity)]
    thick = [row.link for row in swing_rows(vibration) if row.share > THICK]
    if thick:
        told.append(
            f"{', '.join(thick)} bends by more than a tenth of its length: the beam of this theory "
            "bends less than that."
        )
    dampings = [own.damping_s for own in vibration.scene.elastic.values()]
    if 0.0 in dampings:
        told.append(
            "Without damping_s the motion from any other start keeps vibrating around this one."
        )
    told.append(
        "Order: number of vibrations of a mode in a turn; at a whole number the driver excites "
        "it. Linear: about the rigid motion, with the stiffening by tension; not stiffened: "
        "without, as in the thesis."
    )
    return told


def stability_text(vibration: SteadyVibration) -> str:
    """The stability of the periodic motion, in words."""
    largest = vibration.stability.largest
    damped = any(own.damping_s for own in vibration.scene.elastic.values())
    if not vibration.stability.is_stable:
        return (
            f"UNSTABLE: a turn multiplies deviations by {largest:.4g}: the rotation feeds the "
            "vibration, and the mechanism does not stay on this motion. Use another speed, a "
            "lighter link that the elastic one moves, or more damping_s."
        )
    if damped and largest == 0.0:  # below the smallest number
        return "Stable: deviations die out within a turn."
    if damped and largest < 1.0 - STABLE:
        turns = -math.log(10.0) / math.log(largest)
        return f"Stable: deviations fall to a tenth in {readable(turns)} turns."
    return "Stable, without damping: deviations neither grow nor fall."


def resonance_text(found: FrequencySensitivity) -> str:
    """The distance from a resonance, in words."""
    if found.size < NEAR:
        return (
            f"No resonance is near: 1 % of stiffness changes the deflection by {found.size:.3g} %."
        )
    return (
        f"NEAR A RESONANCE with {found.link} at order {found.order}: 1 % of stiffness changes "
        f"the deflection by {found.size:.3g} %, so its uncertainty is that of the stiffness "
        "times this."
    )


MOST_ROWS = 12
"""Most critical speeds on a terminal; files have all."""


@dataclass(frozen=True)
class Unstable:
    """Adjacent speeds of unstable motion [rad/s], and the largest multiplier among them."""

    low_rad_s: float
    high_rad_s: float
    multiplier: float


def unstable_speeds(over: OverSpeeds) -> list[Unstable]:
    """The ranges of speeds at which deviations grow."""
    found = []
    for is_stable, run in itertools.groupby(over.points, lambda point: point.stability.is_stable):
        points = list(run)
        if not is_stable:
            largest = max(point.stability.largest for point in points)
            found.append(Unstable(points[0].speed_rad_s, points[-1].speed_rad_s, largest))
    return found


def speeds_heading(over: OverSpeeds) -> str:
    low, high = over.points[0], over.points[-1]
    return (
        f"{over.scene.name}: steady vibration at {len(over.points)} speeds of "
        f"{over.scene.driver.link} from {low.speed_rad_s:.6g} to {high.speed_rad_s:.6g} rad/s, "
        f"frequency ratio {low.ratio:.4g} to {high.ratio:.4g}"
    )


def speeds_notes(over: OverSpeeds) -> list[str]:
    """Notes on unstable and critical speeds."""
    told = [
        f"Unstable from {each.low_rad_s:.6g} to {each.high_rad_s:.6g} rad/s: a turn multiplies "
        f"deviations by up to {readable(each.multiplier)}."
        for each in unstable_speeds(over)
    ] or ["Deviations grow at none of these speeds."]
    told.append(
        f"Critical speeds: the driver excites a mode at a whole order, up to {HIGHEST}; within "
        "the band the motion depends on the stiffness too much to be computed. By equations "
        "linear in the deflection, with the stiffening by tension."
    )
    return told


def map_heading(found: InertiaMap) -> str:
    low, high = found.factors[0], found.factors[-1]
    return (
        f"{found.scene.name}: steady vibration with {found.link} {low:g} to {high:g} times as "
        f"heavy, at {len(found.speeds)} speeds from {found.speeds[0]:.6g} to "
        f"{found.speeds[-1]:.6g} rad/s"
    )


@dataclass(frozen=True)
class InertiaRow:
    """Results for a link so many times as heavy: the median over the speeds of the largest
    deflection over the length, the largest multiplier with its speed [rad/s], and the number of
    speeds at which the motion is unstable."""

    factor: float
    share: float
    multiplier: float
    at_rad_s: float
    unstable: int


def inertia_rows(found: InertiaMap) -> list[InertiaRow]:
    rows = []
    for factor, over in zip(found.factors, found.over, strict=True):
        worst = max(over.points, key=lambda point: point.stability.largest)
        rows.append(
            InertiaRow(
                float(factor),
                float(np.median([point.share for point in over.points])),
                worst.stability.largest,
                worst.speed_rad_s,
                sum(not point.stability.is_stable for point in over.points),
            )
        )
    return rows
