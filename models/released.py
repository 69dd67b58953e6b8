"""The driver of a free mechanism: where it is let go, and how fast it moves then."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.laws import Law
from models.scene import Scene

LONGEST_S = 1e6
"""For which a mechanism may be left free [s]."""


def check_duration(name: str, until_s: float) -> None:
    """Raises CrankcheckError for a time [s] for which the scene of a name cannot be left free."""
    if not 0.0 < until_s <= LONGEST_S:  # or no number
        raise CrankcheckError(
            f"{name}: free for {until_s:g} s; give a time above 0, of at most {LONGEST_S:g} s"
        )


@dataclass(frozen=True)
class Released(Law):
    """A driver that is let go at time 0 at an angle, with a speed, which may be 0.

    What it does then follows from masses and forces (`analytic.free`), and not from a law: `at`
    gives the tangent of the start, of which only time 0 belongs to the motion. Its "turn" is the
    time ``duration_s`` for which the scene is left free.
    """

    is_free: ClassVar[bool] = True
    start_rad: float
    speed_rad_s: float
    duration_s: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.duration_s > 0.0:
            raise ValueError(f"duration_s is {self.duration_s:g}: give a time above 0")

    @property
    def offset_rad(self) -> float:
        return abs(self.start_rad)

    @property
    def period_s(self) -> float:
        return self.duration_s

    @property
    def peak_speed_rad_s(self) -> float:
        """The speed of the start; of a start from rest, one radian in the whole duration."""
        return abs(self.speed_rad_s) or 1.0 / self.duration_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        # From rest either way is as good to say on which branch it starts.
        theta = self.start_rad + (self.speed_rad_s or self.peak_speed_rad_s) * time_s
        return theta, np.full_like(theta, self.speed_rad_s), np.zeros_like(theta)

    def turned(self, angle_rad: float) -> Released:
        return replace(self, start_rad=self.start_rad + angle_rad)


TURNS = 10.0
"""Of its own law, for which a driven mechanism is left free where nothing else is said."""


def let_go(scene: Scene, duration_s: float | None = None) -> Scene:
    """The scene with its driver let go, at the angle and with the speed that its law has at time 0.

    Parameters
    ----------
    duration_s : float or None
        For how long [s]; None for that of a scene whose driver is let go already, and for the time
        of 10 turns of a driver that follows a law.
    """
    law = scene.driver.law
    if isinstance(law, Released):
        return (
            scene if duration_s is None else _with_law(scene, replace(law, duration_s=duration_s))
        )
    theta, omega, _ = (float(each[0]) for each in law.at(np.zeros(1)))
    lasts_s = TURNS * law.period_s if duration_s is None else duration_s
    return _with_law(scene, Released(theta, omega, lasts_s))


def _with_law(scene: Scene, law: Law) -> Scene:
    return replace(scene, driver=replace(scene.driver, law=law))
