"""Random designs of cams, with numbers that make a sound one."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from models.scene.cam_laws import KINDS, CamLaw, CamSegment
from models.scene.cams import Cam, OscillatingFollower, TranslatingFollower

SMOOTH = [kind for kind in KINDS if kind not in ("dwell", "table", "uniform")]
FOLLOWERS = [
    (motion, contact)
    for motion in ("translating", "oscillating")
    for contact in ("knife", "roller", "flat")
]


def law(random: np.random.Generator, stroke: float) -> CamLaw:
    """Rise, dwell, return and dwell of random kinds and spans."""
    shares = random.uniform((0.6, 0.1, 0.6, 0.1), (1.0, 0.4, 1.0, 0.4))
    up, top, down, rest = (float(x) for x in shares * (math.tau / shares.sum()))
    first, second = (str(random.choice(SMOOTH)) for _ in range(2))
    return CamLaw(
        (
            CamSegment(first, up, stroke),
            CamSegment("dwell", top),
            CamSegment(second, down, -stroke),
            CamSegment("dwell", rest),
        )
    )


def designs(motion: str, contact: str, count: int, seed: int = 0) -> Iterator[Cam]:
    """Cams of base radius 20 to 60 mm, both senses, none of them undercut or dead."""
    random = np.random.default_rng([seed, len(motion), len(contact)])
    for number in range(count):
        base, sense = float(random.uniform(0.02, 0.06)), 1 - 2 * (number % 2)
        roller = float(random.uniform(0.1, 0.4)) * base if contact == "roller" else 0.0
        if motion == "translating":
            stroke = float(random.uniform(0.1, 0.5)) * base
            offset = 0.0 if contact == "flat" else float(random.uniform(-0.4, 0.4)) * base
            slide = TranslatingFollower(contact, roller, offset)
            # s + s'' > -3.4 strokes for the sharpest kind over the shortest span.
            large = base + 9.0 * stroke if contact != "knife" else base
            yield Cam(law(random, stroke), large, slide, sense)
            continue
        pivot = float(random.uniform(2.0, 3.0)) * base
        if contact == "flat":
            turn = OscillatingFollower(
                contact, pivot_m=pivot, face_m=float(random.uniform(-0.3, 0.3)) * base
            )
            yield Cam(law(random, float(random.uniform(0.02, 0.06))), base, turn, sense)
            continue
        arm = float(random.uniform(0.7, 0.95)) * pivot
        turn = OscillatingFollower(contact, roller, pivot_m=pivot, arm_m=arm)
        yield Cam(law(random, float(random.uniform(0.02, 0.1))), base, turn, sense)
