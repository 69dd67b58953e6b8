"""Elastic links in words: their description, their start, and its uncertainty."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from analytic.elastic import elastic_motion, released
from analytic.elastic.discretisation import Discretisation, ElasticDoubt, Elements, Modes, Segments
from models.array import Array
from models.motion import Motion
from models.scene import Scene, cut_links, elastic, laws
from reports.output.numbers import count, error_text, listed, readable

NEAR = 0.1
"""Distance from a whole frequency ratio below which an undamped link is nearly resonant."""
SLOW = 20
"""Ratio beyond which a resonance is too small to be seen."""
SLIGHT = 1e-2
"""Largest square of a slope for which a curvature is the second derivative of a deflection, to
about that share of it."""
STARTS: dict[elastic.Shape, str] = {
    "periodic": "Starts on the periodic motion, with the period of the driver.",
    "quasi-static": "Starts with the deflection that the rigid motion requires (quasi-static); the "
    "rest of the vibration continues{damped}.",
    "straight": "Starts straight: it vibrates, up to twice the deflection that the motion "
    "requires{damped}.",
}


def elastic_facts(scene: Scene, by: Discretisation, *, stiffened: bool) -> list[str]:
    """Return one line per elastic link, and one on the description of all of them."""
    lines = [_link(scene, own) for own in scene.elastic.values()]
    line = f"elastic links by {described(scene, by)} each, "
    line += "with" if stiffened else "without"
    line += " the shortening of bent links"
    return [*lines, line if stiffened else f"{line} (linear, as in the thesis)"]


def described(scene: Scene, by: Discretisation) -> str:
    """Return the description of elastic links, such as 5 sines across and 2 sines along."""
    if isinstance(by, Elements):
        return count(by.count, "beam element")
    if isinstance(by, Segments):
        return count(by.count, "rigid segment")
    noun, links = "sine" if isinstance(by, Modes) else "polynomial", scene.elastic.values()
    across = [f"{count(by.across, noun)} across"] * any(own.bends for own in links)
    along = [f"{count(by.along, noun)} along"] * any(own.stretches for own in links)
    return listed([*across, *along])


def _link(scene: Scene, own: elastic.ElasticLink) -> str:
    """Return a link with its stiffness and its first natural frequencies between its pins."""
    line = cut_links.line_of(scene, own.link)
    parts = []
    if own.bends:
        first = own.bending_rad_s(line.length_m, line.density_kg_m)
        parts.append(f"bends with EI = {own.flexural_n_m2:.6g} N m^2, from {_ratio(scene, first)}")
    if own.stretches:
        first = own.axial_rad_s(line.length_m, line.density_kg_m)
        parts.append(f"stretches with EA = {own.axial_n:.6g} N, from {_ratio(scene, first)}")
    damped = f"damping {own.damping_s:g} s of its stiffness" if own.damping_s else "undamped"
    words = " and ".join(parts)
    return f"{own.link} {words}; {line.density_kg_m:.6g} kg/m over {line.length_m:.6g} m; {damped}"


def _ratio(scene: Scene, first_rad_s: float) -> str:
    words = f"{first_rad_s:.6g} rad/s on"
    law = scene.driver.law
    if isinstance(law, laws.ConstantSpeed):
        words += f" ({first_rad_s / abs(law.speed_rad_s):.4g} times the speed of the driver)"
    return words


def start_words(scene: Scene, start: elastic.Shape) -> str:
    """Return the start in a sentence."""
    damped = any(own.damping_s for own in scene.elastic.values())
    ending = " until it is damped" if damped else ", as nothing damps it"
    return STARTS[start].format(damped=ending)


def elastic_warnings(scene: Scene, largest_m: dict[str, float]) -> Iterator[str]:
    """Yield sentences on the limits of the model, with the largest deflections [m] by link."""
    law = scene.driver.law
    for name, own in scene.elastic.items():
        line = cut_links.line_of(scene, name)
        if own.bends and not own.damping_s and isinstance(law, laws.ConstantSpeed):
            ratio = own.bending_rad_s(line.length_m, line.density_kg_m) / abs(law.speed_rad_s)
            if 1 <= round(ratio) <= SLOW and abs(ratio - round(ratio)) < NEAR:
                yield (
                    f"Near resonance: the first natural frequency of {name} is {ratio:.4g} "
                    "times the speed, and nothing damps it; small changes of either change its "
                    "whole deflection. Use a half-integer ratio, or give it damping_s."
                )
        slope = math.pi * largest_m.get(name, 0.0) / line.length_m
        if slope**2 > SLIGHT:
            yield (
                f"{name} bends by {100 * largest_m[name] / line.length_m:.2g} % of its length: "
                "curvatures are those of small slopes, with an error of about "
                f"{readable(100 * slope**2, 2)} % here; give it more stiffness, or less speed."
            )


ROUNDING = 1e-13
"""Accuracy of closed joints and solved equations: differences are no less."""
SAMPLES = 73
"""Instants at which motions are compared."""


class Shares(NamedTuple):
    """The largest distances of a motion from another: of a deflection over the largest of its link
    in the other (the worst link counts), of an angle [rad], of the torque over its largest."""

    deflection: float
    angle_rad: float
    torque: float


def _shares(one: Motion, other: Motion) -> Shares:
    """Return the distances of motions at the same instants; none is less than rounding."""
    apart = ElasticDoubt.between(one, other)
    bent = [_over(off, other.elastic[name].middle) for name, off in apart.middle_m.items()]
    turned = [float(off.max()) for off in apart.theta_rad.values()]
    acting = other.forces.torque if other.forces is not None else np.zeros(0)
    every = max(bent, default=0.0), max(turned, default=0.0), _over(apart.torque_n_m, acting)
    return Shares(*(max(ROUNDING, each) for each in every))


def _over(off: Array, series: Array) -> float:
    largest = float(np.nanmax(np.abs(series), initial=0.0))
    return float(np.nanmax(off, initial=0.0)) / (largest or 1.0)


def beam_certainty(motion: elastic_motion.ElasticHistory) -> list[str]:
    """Return the uncertainty of a motion, in sentences. Raises CrankcheckError where it has
    none."""
    if isinstance(motion.by, Segments):
        return []  # a model of engines, and not the beam
    time_s = np.linspace(0.0, motion.until_s, SAMPLES)
    own = motion.at(time_s)
    notes = [_by_other_shapes(motion, time_s, own)]
    if not motion.stiffened:
        short = _shares(own, replace(motion, stiffened=True).at(time_s))
        notes.append(
            "The shortening of bent links, which the linear theory leaves out, changes "
            f"deflections by {100.0 * short.deflection:.3g} % of the largest; engines are "
            "compared with the motion that has it."
        )
    return notes


def _by_other_shapes(motion: elastic_motion.ElasticHistory, time_s: Array, own: Motion) -> str:
    """Compare with the next finer description; for elements, and for free motion, which take long,
    with one of fewer shapes, whose error is the larger one, if there are any fewer."""
    fewer = coarser(motion.by)
    slow = isinstance(motion, released.ReleasedElasticMotion) or isinstance(motion.by, Elements)
    if not slow or described(motion.scene, fewer) == described(motion.scene, motion.by):
        found = _shares(own, motion.finer.at(time_s))
        told = [
            f"deflections {error_text(found.deflection)} of the largest",
            f"angles {error_text(found.angle_rad)} rad",
        ]
        if own.forces is not None and own.forces.torque.any():
            told.append(f"torque {error_text(found.torque)} of its largest")
        return f"Uncertainty, from the next finer description: {', '.join(told)}."
    found = _shares(replace(motion, by=fewer).at(time_s), own)
    return (
        f"With {described(motion.scene, fewer)} deflections differ by "
        f"{error_text(found.deflection)} of the largest, angles by "
        f"{error_text(found.angle_rad)} rad: the uncertainty is less."
    )


def coarser(by: Discretisation) -> Discretisation:
    """Return about half as many shapes of each kind, and at least one."""
    if isinstance(by, Elements | Segments):
        return replace(by, count=max(1, by.count // 2))
    return replace(by, across=max(1, (by.across + 1) // 2), along=max(1, by.along // 2))
