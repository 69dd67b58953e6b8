"""What elastic links can not follow: change points, and speeds that jump."""

from __future__ import annotations

import math

import numpy as np

from analytic.kinematics import solve
from analytic.structure.cranked import refuse_other_than_cranked
from models.errors import CrankcheckError
from models.scene import Scene

JUMP = 1e-6
"""Of the peak speed: what more it changes by at once is a jump."""


def check_drive(scene: Scene, until_s: float) -> None:
    """Refuse what elastic links can not be followed through from time 0 to ``until_s``.

    Raises
    ------
    CrankcheckError
        No elastic link; a driver other than a crank; a change point on the way, where a bent link
        takes the other branch as well; a speed of the driver that jumps, which is a blow.
    """
    if not scene.elastic:
        raise CrankcheckError(
            f"{scene.name}: no link of it is elastic; give one a table [elastic.LINK]"
        )
    refuse_other_than_cranked(scene, "the motion of elastic links")
    for crossing in solve(scene, np.array([0.0, until_s])).crossings:
        raise CrankcheckError(
            f"{scene.name}: with its driver at {math.degrees(crossing.driver_rad):.6g} deg the "
            f"dyad of {crossing.dyad} goes through a change point, from which links that bend go "
            "on in either branch; change a length"
        )
    law = scene.driver.law
    for kink in law.kinks_s:
        beside = np.nextafter(kink, [-np.inf, np.inf])
        omega = law.at(beside)[1]
        if kink < until_s and abs(omega[1] - omega[0]) > JUMP * law.peak_speed_rad_s:
            raise CrankcheckError(
                f"{scene.name}: at {kink:g} s the driver's speed jumps from {omega[0]:g} to "
                f"{omega[1]:g} rad/s, which is a blow to elastic links; give it a rise_s above 0"
            )
