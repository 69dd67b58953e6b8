"""Random mechanisms at a position, anywhere or next to a singular one."""

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.kinematics import solve
from analytic.prepared import prepared, shortage
from models.errors import CrankcheckError
from models.scene import Driver, Scene
from models.scene.laws import Accelerating
from tests.analytic.assur.triad_scenes import KINDS, triad
from tests.worlds.strategies import FORMS, Layout, with_dyads

TRIAD = "triad"
ALL = (*FORMS, TRIAD)


@dataclass
class Flat(Layout):
    """A layout whose two lines of a dyad are parallel but for ``apart`` [rad]."""

    apart: float = 0.0

    def lean(self) -> float:
        return math.pi / 2 - self.apart


def laid_out(form: str, rng: np.random.Generator, *, near: bool) -> Scene:
    """A mechanism with a dyad of this form, or a triad of any kind."""
    if form == TRIAD:
        return triad(KINDS[rng.integers(len(KINDS))], int(rng.integers(2**31)), 0.6)[0]
    numbers = (
        lambda low, high: float(rng.uniform(low, high)),
        lambda names: str(rng.choice(list(names))),
    )
    flat = near and form[:3] in ("PRP", "RPP")
    at = Flat(*numbers, apart=10.0 ** rng.uniform(-6, -2)) if flat else Layout(*numbers)
    crank = at.crank()
    return with_dyads(at, [form], crank, Accelerating(at.frames[crank][1], 1.0, 1.0)).scene


def limit(scene: Scene, start: float, way: float) -> float | None:
    """The first limit of the driver from an angle on, one way; None where there is none."""
    ahead = start + way * np.linspace(0.0, math.pi, 65)
    is_open = shortage(prepared(scene).stretched, ahead) > 0.0
    if is_open[0] or not is_open.any():
        return None
    far = int(np.argmax(is_open))
    low, high = ahead[far - 1], ahead[far]
    for _ in range(60):
        middle = 0.5 * (low + high)
        gap = shortage(prepared(scene).stretched, np.array([middle]))[0]
        low, high = (low, middle) if gap > 0.0 else (middle, high)
    return float(low)


def drawn(form: str, rng: np.random.Generator, *, near: bool) -> Scene:
    """A mechanism that is at time 0 in a position as its layout has it, or ``near`` to a singular
    one: 1e-12 to 1e-2 rad from a limit of its driver, or with lines 1e-6 to 1e-2 rad from parallel.
    Its driver accelerates."""
    for _ in range(300):
        try:
            scene = laid_out(form, rng, near=near)
            start = float(scene.driver.law.at(np.zeros(1))[0][0])
            if near and form[:3] not in ("PRP", "RPP"):
                way = float(rng.choice((-1.0, 1.0)))
                if (end := limit(scene, start, way)) is None:
                    continue
                start = end - way * 10.0 ** rng.uniform(-12, -2)
            law = Accelerating(start, *(float(x) for x in rng.uniform(-9.0, 9.0, 2)))
            scene = replace(scene, driver=Driver(scene.driver.link, law))
            solve(scene, np.zeros(1))
        except (CrankcheckError, AssertionError):
            continue
        return scene
    raise AssertionError(f"no {form} of 300 can be had")
