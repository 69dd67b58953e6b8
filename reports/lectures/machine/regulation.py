"""`cycle` and `flywheel`: how evenly a machine runs, and what makes it run so."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from analytic.lectures.regulation.cycle_search import cycle_of
from analytic.lectures.regulation.flywheel import WantedFlywheel, wanted_flywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle, cycle_scene, with_flywheel
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.errors import CrankcheckError
from models.scene import Scene
from reports.requests.arguments import SceneLike, kind_of, scene_of, told_at_the_call
from reports.requests.shown import Shown

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console


@dataclass(frozen=True, eq=False, repr=False)
class MachineCycle(Shown):
    """The steady cycle of a scene (`cycle`). Torques count along the motion: positive ones drive.

    ``details`` holds all that is known of it: ``delta``, ``mean_rad_s``, ``extreme_speeds_rad_s``,
    ``surplus_j``, ``works_j``, ``drive_n_m``, ``period_s`` and the like.
    """

    details: SteadyCycle

    @property
    def delta(self) -> float:
        """The coefficient of fluctuation, (largest - smallest speed) / mean."""
        return self.details.delta

    @property
    def mean_rad_s(self) -> float:
        """Half the sum of the largest and the smallest speed of the driver."""
        return self.details.mean_rad_s

    @property
    def extreme_speeds_rad_s(self) -> tuple[float, float]:
        """The largest and the smallest speed."""
        return self.details.extreme_speeds_rad_s

    @property
    def extreme_angles_deg(self) -> tuple[float, float]:
        """Where the driver stands at the largest and at the smallest speed."""
        one = self.details
        return (
            math.degrees(one.driver_rad(one.fastest)),
            math.degrees(one.driver_rad(one.slowest)),
        )

    @property
    def surplus_j(self) -> float:
        """The surplus of work over the cycle."""
        return self.details.surplus_j

    @property
    def drive_n_m(self) -> float:
        """The constant torque of the drive that closes the balance of work."""
        return self.details.drive_n_m

    def scene_let_go(self, cycles: float = 5.0) -> Scene:
        """The scene let go in this cycle, for so many of them, the drive's torque a load of it: an
        engine that runs it free runs the cycle."""
        return cycle_scene(self.details, cycles)

    def frame(self) -> pd.DataFrame:
        """One row each half degree of the driver: speed, inertia, torques, work, energy."""
        from reports.lectures.machine.cycle_frame import cycle_frame

        return cycle_frame(self.details)

    def show(self, console: Console) -> None:
        from reports.lectures.machine.cycle_frame import show_cycle

        show_cycle(console, self.details)


@dataclass(frozen=True, eq=False, repr=False)
class MachineFlywheel(Shown):
    """The flywheel of a scene for a coefficient of fluctuation (`flywheel`); ``details`` has the
    approximations of the textbooks beside it, and the cycle without it."""

    details: WantedFlywheel

    @property
    def inertia_kg_m2(self) -> float:
        """What is to be put on the driver, beside what it has."""
        return self.details.inertia_kg_m2

    @property
    def cycle(self) -> MachineCycle:
        """The steady cycle with it."""
        return MachineCycle(self.details.cycle)

    @property
    def scene(self) -> Scene:
        """The scene with it."""
        return with_flywheel(self.details.cycle.machine.scene, self.inertia_kg_m2)

    def frame(self) -> pd.DataFrame:
        """As that of the cycle, with the speed without the flywheel where there is one."""
        from reports.lectures.machine.cycle_frame import cycle_frame

        return cycle_frame(self.details.cycle, self.details.bare)

    def show(self, console: Console) -> None:
        from reports.lectures.machine.cycle_frame import show_flywheel

        show_flywheel(console, self.details)


@told_at_the_call
def cycle(scene: SceneLike) -> MachineCycle:
    """The cycle that a machine repeats under its loads: its speed, and how that fluctuates.

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene. Driven at constant speed, that is its
        mean speed, and the drive a constant torque; let go, its loads alone count.

    Raises
    ------
    CrankcheckError
        No steady cycle, and why.
    """
    return MachineCycle(cycle_of(TurningMachine.of(scene_of(scene))))


@told_at_the_call
def flywheel(scene: SceneLike, delta: float) -> MachineFlywheel:
    """The flywheel on the driver with which a machine has a coefficient of fluctuation.

    Parameters
    ----------
    scene : Scene, str or path
        As of `cycle`.
    delta : float
        The coefficient, (largest - smallest speed) / mean, such as 0.02.

    Raises
    ------
    CrankcheckError
        A coefficient that no flywheel gives, or that the machine keeps without; no steady cycle.
    """
    if isinstance(delta, bool) or not isinstance(delta, int | float):
        raise CrankcheckError(f"--delta: found {kind_of(delta)}; give a number, such as 0.02")
    return MachineFlywheel(wanted_flywheel(TurningMachine.of(scene_of(scene)), float(delta)))
