"""Elastic links in words: how they are described, how they start, and how far that is to be
trusted."""

from __future__ import annotations

import math
from collections.abc import Iterator

from analytic.elastic.discretisation import Discretisation, Elements, Modes, Polynomials
from models.cut_links import line_of
from models.elastic import ElasticLink, Shape
from models.laws import ConstantSpeed
from models.scene import Scene
from reports.output.numbers import count, listed, readable

NEAR = 0.1
"""From a whole frequency ratio: undamped, what is so near to it is nearly resonant."""
SLOW = 20
"""A ratio beyond which what resonates is too small to be seen."""
SLIGHT = 1e-2
"""What the square of a slope may be, so that a curvature is the second derivative of a deflection
to about that share of it."""
STARTS: dict[Shape, str] = {
    "periodic": "Starts on the periodic motion: it comes back after a period of the driver.",
    "quasi-static": "Starts with the deflection that the rigid motion asks for (quasi-static); "
    "what that leaves of the vibration rings on{damped}.",
    "straight": "Starts straight: it rings, at up to twice the deflection that the motion asks "
    "for{damped}.",
}


def elastic_facts(scene: Scene, by: Discretisation, *, stiffened: bool) -> list[str]:
    """One line per elastic link, and one of how all of them are described."""
    lines = [_link(scene, own) for own in scene.elastic.values()]
    short = "with the shortening of bent links" if stiffened else (
        "without the shortening of bent links (linear, as in the thesis)"
    )  # fmt: skip
    return [*lines, f"elastic links by {described(scene, by)} each, {short}"]


def described(scene: Scene, by: Discretisation) -> str:
    """By what elastic links are described, such as 5 sines across and 2 sines along."""
    bends, stretches = (
        any(getattr(own, kind) for own in scene.elastic.values()) for kind in ("bends", "stretches")
    )
    if isinstance(by, Modes):
        return listed(_across_and_along(by, "sine", bends=bends, stretches=stretches))
    if isinstance(by, Polynomials):
        return listed(_across_and_along(by, "polynomial", bends=bends, stretches=stretches))
    if isinstance(by, Elements):
        return count(by.count, "beam element")
    return count(by.count, "rigid segment")


def _across_and_along(
    by: Modes | Polynomials, noun: str, *, bends: bool, stretches: bool
) -> list[str]:
    across, along = count(by.across, noun), count(by.along, noun)
    return [f"{across} across"] * bends + [f"{along} along"] * stretches


def _link(scene: Scene, own: ElasticLink) -> str:
    """A link with its stiffness and its first natural frequencies between its pins."""
    line = line_of(scene, own.link)
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
    """A frequency, and how often it goes into the driver's speed where that is constant."""
    words = f"{first_rad_s:.6g} rad/s on"
    law = scene.driver.law
    if isinstance(law, ConstantSpeed):
        words += f" ({first_rad_s / abs(law.speed_rad_s):.4g} times the speed of the driver)"
    return words


def start_words(scene: Scene, start: Shape) -> str:
    """What it starts with, in a sentence."""
    damped = any(own.damping_s for own in scene.elastic.values())
    ending = " until it is damped" if damped else ", as nothing damps it"
    return STARTS[start].format(damped=ending)


def elastic_warnings(scene: Scene, largest_m: dict[str, float]) -> Iterator[str]:
    """Sentences on what the model is not fit for, with the largest deflections [m] by link."""
    law = scene.driver.law
    for name, own in scene.elastic.items():
        line = line_of(scene, name)
        if own.bends and not own.damping_s and isinstance(law, ConstantSpeed):
            ratio = own.bending_rad_s(line.length_m, line.density_kg_m) / abs(law.speed_rad_s)
            if 1 <= round(ratio) <= SLOW and abs(ratio - round(ratio)) < NEAR:
                yield (
                    f"Near resonance: the first natural frequency of {name} is {ratio:.4g} times "
                    "the speed, and nothing damps it; small changes of either change all of its "
                    "deflection. Take a half-integer ratio, or give it damping_s."
                )
        slope = math.pi * largest_m.get(name, 0.0) / line.length_m
        if slope**2 > SLIGHT:
            yield (
                f"{name} bends by {100 * largest_m[name] / line.length_m:.2g} % of its length: "
                f"curvatures are taken as of small slopes, which is off by about "
                f"{readable(100 * slope**2, 2)} % here; give it more stiffness, or less speed."
            )
