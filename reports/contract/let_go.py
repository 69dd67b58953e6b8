"""The second opinion of what nothing drives: the motion of a mechanism under gravity alone.

The equations of motion of all bodies (`analytic.multibody`), stepped by the fourth-order
Runge-Kutta method, without correction of what the joints drift: it is for short motions, and to a
thousandth.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from analytic.multibody.multibody_motion import Baumgarte
from analytic.multibody.release_multibody import release_multibody
from models.joints import bodies, centre_of, frames
from models.motion import State
from models.scene import Point, Scene


def centres(scene: Scene, state: State, duration_s: float, steps: int) -> Mapping[str, Point]:
    """Where the centres of mass are a while after the driver has let go [m].

    Parameters
    ----------
    scene : Scene
        A mechanism with its masses and its gravity; loads and friction are left out.
    state : State
        The mechanism when it is let go.
    duration_s : float
        For how long it is free [s].
    steps : int
        Of the integration.

    Raises
    ------
    CrankcheckError
        A freedom without mass, or a start in a change point.
    """
    heavy = replace(scene, loads={}, springs={}, friction={})
    plain = Baumgarte(0.0, 0.0, step_s=duration_s / steps)
    free = release_multibody(heavy, duration_s, plain, near=state)
    placed = frames(heavy, free.at(np.array([duration_s])).state())
    return {body: placed[body].at(centre_of(heavy, body)) for body in bodies(heavy)}
