"""Driven elastic links with every coordinate kept, beside those with none but the free ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.check.driven_multipliers import DrivenMultipliers
from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.multibody.multibody_motion import Baumgarte, Method, Projection
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene
from models.forces import Forces
from models.motion import Motion
from models.scene import Scene
from tests.worlds.tiers import slowly

SCENE = load_scene("fourbar-elastic")
HEAVY = replace(
    SCENE,
    gravity_m_s2=(0.0, -9.81),
    elastic={"coupler": replace(SCENE.elastic["coupler"], damping_s=1e-4)},
)
TURN_S = SCENE.driver.law.period_s


def both(scene: Scene, until_s: float, method: Method, time_s: Array) -> tuple[Motion, Motion]:
    """Without multipliers, and with them, from one state."""
    driven = DrivenElasticMotion(scene, until_s, Modes(1), "quasi-static", stiffened=True)
    first = driven.first.now
    start = first.q[0], first.rates[0]
    other = DrivenMultipliers(driven.form.assembly, start, until_s, method)
    return driven.at(time_s), other.at(time_s)


def apart(motion: Motion, other: Motion) -> tuple[float, float]:
    """How far deflections are from each other, over the largest; and reactions with the torque."""
    forces, others = motion.forces, other.forces
    assert isinstance(forces, Forces)
    assert isinstance(others, Forces)
    pairs = [
        (motion.elastic["coupler"].middle, other.elastic["coupler"].middle),
        (forces.torque, others.torque),
        (forces.pins["C"]["coupler"], others.pins["C"]["coupler"]),
        (motion.links["rocker"].alpha, other.links["rocker"].alpha),
    ]
    bent, *rest = (float(np.abs(a - b).max() / np.abs(a).max()) for a, b in pairs)
    return bent, max(rest)


@pytest.mark.parametrize("turns", [0.3, slowly(2.0, reason="errors that grow with the turns")])
def test_over_turns_they_agree(turns: float) -> None:
    time_s = np.linspace(0.0, turns * TURN_S, 41)
    bent, forces = apart(*both(SCENE, turns * TURN_S, Projection(), time_s))
    assert bent < 1e-9
    assert forces < 1e-8


@pytest.mark.parametrize("turns", [0.1, slowly(0.2, reason="errors that grow with the turns")])
@pytest.mark.parametrize("method", [Projection(), Baumgarte(50.0, 50.0)])
def test_with_weight_and_damping(method: Method, turns: float) -> None:
    """And with Baumgarte's terms, whose constraints stay closed to what each step leaves."""
    time_s = np.linspace(0.0, turns * TURN_S, 11)
    assert max(apart(*both(HEAVY, turns * TURN_S, method, time_s))) < 1e-8


def test_steps_of_one_size_are_for_what_is_let_go() -> None:
    with pytest.raises(CrankcheckError, match="leave step_s out"):
        both(SCENE, 0.1, Baumgarte(5.0, 5.0, 1e-3), np.zeros(1))
