"""What is compared of elastic links: how far they bend, and how far their pins come apart.

Errors are shares of the largest deflection of the reference over the run (``D``), of all links: a
link that passes through its straight line is as hard on an engine there as elsewhere.
"""

from dataclasses import replace

import numpy as np

from models.motion import Motion
from models.scene import Scene
from reports.quantities.quantity import Criterion, Measure, Quantity, Series, Tolerance

LEAST = 1e-9
"""The least deflection that errors are shares of, over the longest link: below it a link is rigid
to an engine, whose joints are no nearer."""


def largest_deflection(scene: Scene, reference: Motion) -> float:
    """The largest deflection of the middle of any elastic link over the run [m]."""
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
    "What joints are off by, step^2 of the longest link at the curvature, over the deflection (of "
    "a beam of an engine's own, which has none, step^2 of itself); "
    "what a spring's swing of r times the driver's speed is off by, (r step)^2/24 of its phase in "
    "every swing; and, of what is held to the beam, what the exact chain of as many segments is "
    "off it by, and what the beam itself is.",
    cap=0.2,  # a fifth of the largest deflection: another stiffness, however coarse the chain
    coefficient=0.5,
    power=1.0,
    conditioned=True,
    bends=True,
)
CURE = (
    "Shorten the step (--steps-per-turn); look at the rates of the springs between segments, and "
    "at what else bends or damps."
)
DEFLECTION = Quantity(
    name="deflection",
    role="elastic",
    head="beam\n/ D",
    measures=(_middle("deflection_error_m"),),
    criteria=(
        Criterion(
            "CC131",
            "deflection",
            "How far the middle of each elastic link is from the line between its pins, against "
            "the beam with foreshortening, at the commanded time.",
            f"{CURE} More segments (--segments) come nearer to the beam, as 1/n^2.",
            short="bend",
            diagram="deflection of elastic links",
            tolerance=BENT,
        ),
    ),
)
SEGMENTS = Quantity(
    name="segments",
    role="elastic",
    head="engine\n/ D",
    measures=(_middle("segments_error_m"),),
    criteria=(
        Criterion(
            "CC132",
            "deflection of segments",
            "The same against the exact chain of as many segments, a multibody without an engine: "
            "what the engine itself is off by.",
            CURE,
            short="chain",
            diagram="deflection of segments",
            tolerance=BENT,
        ),
    ),
)
EXTENSION = Quantity(
    name="extension",
    role="elastic",
    head="extens.\n/ L",
    measures=(
        replace(
            _middle("extension_error_m"),
            share="L",
            scale=lambda scene, reference: scene.longest_m,
            truth=lambda scene, reference: _extensions(reference),
            logged=lambda scene, run: _extensions(run.motion),
        ),
    ),
    criteria=(
        Criterion(
            "CC133",
            "extension",
            "By how much the pins of each elastic link are further apart, or nearer, than at rest: "
            "a bent link is shorter.",
            CURE,
            short="ext",
            tolerance=Tolerance(
                "Of places: the pins are off by step^2 at the curvature, each.",
                cap=2e-2,
                coefficient=2.0,
                power=1.0,
                conditioned=True,
            ),
        ),
    ),
)
