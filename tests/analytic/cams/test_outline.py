"""Outlines of cams in their links: touched by the follower of the solved motion alone."""

from typing import Any

import numpy as np
import pytest

from analytic.cams.outline import outlined
from analytic.kinematics import solve
from models.scene.cam_contacts import follower_shape
from tests.sim.test_cams_by_contact import KINDS
from tests.worlds.touching_cams import sprung


@pytest.mark.parametrize("kind", KINDS)
def test_each_point_is_touched_once_in_a_turn_and_never_entered(kind: str) -> None:
    """By the places of roller or face in the frame of the cam, from the solved motion alone."""
    scene = outlined(sprung(**KINDS[kind]), 24)
    motion = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 20_001), bound=False)
    shape = follower_shape(scene, scene.cams["disc"])
    own, cam = (
        next(motion.links[n] for n in ("lifter", "lever") if n in scene.links),
        motion.links["cam"],
    )
    pin = "R" if "lifter" in scene.links else "P"
    local = complex(*scene.links["lifter" if pin == "R" else "lever"].points[pin])

    def placed(point: tuple[float, float]) -> Any:
        track = motion.points[pin].position
        return track @ [1, 1j] + (complex(*point) - local) * np.exp(1j * own.theta)

    origin = 0.02j - complex(*scene.links["cam"].points["O"]) * np.exp(1j * cam.theta)
    away = complex(*shape.away) * np.exp(1j * own.theta)
    for corner in scene.cams["disc"].outline:
        point = origin + complex(*corner) * np.exp(1j * cam.theta)
        off = placed(shape.place) - point
        gap = (off * away.conj()).real if not shape.roller_m else np.abs(off) - shape.roller_m
        assert abs(gap.min()) < 2e-8
