"""What elastic links are not followed through, and laws of the driver that they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.discretisation import Polynomials
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.elastic import Shape
from models.errors import CrankcheckError
from models.files import load_scene
from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.scene import Scene
from tests.analytic.elastic.driven import fourbar
from tests.worlds.tiers import few


def following(law: Law, scene: Scene | None = None) -> Scene:
    scene = scene or fourbar()
    return replace(scene, driver=replace(scene.driver, law=law))


def driven(
    scene: Scene, start: Shape = "quasi-static", until_s: float = 0.4
) -> DrivenElasticMotion:
    return DrivenElasticMotion(scene, until_s, Polynomials(4), start, stiffened=True)


@pytest.mark.parametrize(
    "law",
    few(
        [
            ConstantSpeed(1.5, -7.37),
            Oscillating(1.5, 0.5, 9.0),
            FromRest(1.5, 9.0, 0.2),
            Accelerating(1.5, 9.0, -40.0),
            SpeedChange(1.5, 3.0, 6.0, 0.1, 0.2),
        ],
        {SpeedChange(1.5, 3.0, 6.0, 0.1, 0.2)},
        "half a second each: the one whose law has kinks",
    ),
)
def test_a_smooth_law_is_followed(law: Law) -> None:
    motion, time_s = driven(following(law)), np.linspace(0.0, 0.4, 21)
    middle = np.abs(motion.at(time_s).elastic["coupler"].middle).max()
    assert middle > 1e-4
    assert motion.doubt(time_s).middle_m["coupler"].max() < 1e-3 * middle


def test_what_oscillates_has_a_periodic_motion() -> None:
    motion = driven(following(Oscillating(1.5, 0.5, 9.0)), "periodic")
    period = motion.scene.driver.law.period_s
    ends = motion.at(np.array([0.1, 0.1 + period])).elastic["coupler"].middle
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)


@pytest.mark.parametrize(
    ("scene", "says"),
    [
        (following(SpeedChange(1.5, 3.0, 6.0, 0.1, 0.0)), r"jumps from 3 to 6 rad/s.*rise_s"),
        (load_scene("fourbar-lecture-1"), r"no link of it is elastic"),
        (replace(fourbar(), ground={"A": (0.0, 0.0), "D": (1.35, 0.0)}), "through a change point"),
        (
            replace(load_scene("fourbar-by-coupler"), elastic=fourbar().elastic),
            "takes a driver that is a link pinned to the ground.*pin B of crank and coupler",
        ),
    ],
    ids=["jump", "rigid", "change point", "inner driver"],
)
def test_what_is_not_followed_is_named(scene: Scene, says: str) -> None:
    with pytest.raises(CrankcheckError, match=says):
        _ = driven(scene, "straight", 1.0).form


def test_times_beyond_the_end_and_endless_ones_are_refused() -> None:
    motion = driven(fourbar())
    with pytest.raises(CrankcheckError, match=r"followed up to 0\.4 s"):
        motion.at(np.array([0.5]))
    with pytest.raises(CrankcheckError, match="50000 are the most"):
        driven(fourbar(), until_s=1e4).at(np.array([0.0]))
    assert driven(fourbar(), "periodic").at(np.array([1e4])).elastic
