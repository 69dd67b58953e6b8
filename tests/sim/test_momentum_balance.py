"""The balance of momentum: forces by hand, and where there are none."""

from __future__ import annotations

import numpy as np

from models.files import load_scene
from models.scene import GROUND
from sim.momentum_balance import Hinge, MomentumGain, joint_pushes

SCENE = load_scene("fourbar-lecture-1")
HINGES = (
    Hinge("A", GROUND, "crank"),
    Hinge("D", GROUND, "rocker"),
    Hinge("B", "crank", "coupler"),
    Hinge("C", "coupler", "rocker"),
)


def gains(samples: int) -> dict[str, MomentumGain]:
    """Crank upright, coupler level, rocker hanging; their joints hold up 1, 2 and 3 N in their
    middles. In the last sample the angles are lost."""
    angles = dict(zip(SCENE.links, (np.pi / 2, 0.0, np.pi / 2), strict=True))
    made = {}
    for weight, (name, theta) in enumerate(angles.items(), 1):
        turned = np.full(samples, theta)
        turned[-1] = np.nan
        force = np.tile([0.0, float(weight)], (samples, 1))
        place, none = np.zeros((samples, 2)), np.zeros(samples)
        made[name] = MomentumGain(SCENE.links[name].centre_m, place, turned, force, none)
    return made


def test_weights_are_shared_as_levers_say() -> None:
    """What stands upright bears no side force: crank and rocker each hold half of the coupler."""
    pushes = joint_pushes(SCENE, HINGES, gains(3), driven=True)
    for hinge, upwards in zip(HINGES, (2.0, 4.0, 1.0, -1.0), strict=True):
        np.testing.assert_allclose(pushes.hinges[hinge][:2], [[0.0, upwards]] * 2, atol=1e-12)
    np.testing.assert_allclose(pushes.torque[:2], 0.0, atol=1e-12)
    assert pushes.spare == 0


def test_what_is_no_number_gives_none_and_spoils_no_other_sample() -> None:
    for driven in (True, False):
        pushes = joint_pushes(SCENE, HINGES, gains(3), driven=driven)
        assert np.isnan(pushes.hinges[HINGES[2]][2]).all()
        assert np.isfinite(pushes.hinges[HINGES[2]][:2]).all()
    assert not pushes.torque.any()  # where nothing drives
