"""Elastic mechanisms of any size: coefficients that are slopes or angles count as those that are
lengths."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.elastic.discretisation import Discretisation, Elements, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.files import parse_scene

SIMILAR = """
name = "similar"
source = "ours"
[ground]
points = {{ A = [0.0, 0.0], D = [{0}, 0.0] }}
[links]
crank = {{ bar = ["A", "B"], length_m = {1}, mass_kg = 0.4 }}
coupler = {{ bar = ["B", "C"], length_m = {2}, mass_kg = 2.4 }}
rocker = {{ bar = ["D", "C"], length_m = {3}, mass_kg = 0.5 }}
[elastic.coupler]
flexural_n_m2 = {4}
[driver]
link = "crank"
speed_rad_s = 5.0
start_deg = 200.0
[start]
shape = "periodic"
[branch]
C = 1
"""


def deflection(size: float, by: Discretisation) -> float:
    """The largest over that size, of a four-bar of 0.84 of it whose frequency is the same."""
    lengths = (0.84 * size, 0.28 * size, 0.56 * size, 0.62 * size)
    scene = parse_scene(SIMILAR.format(*lengths, 8.0 * size**3), "similar")
    motion = DrivenElasticMotion(scene, 1.0, by, "periodic", stiffened=True)
    middle = motion.at(np.linspace(0.0, scene.driver.law.period_s, 20)).elastic["coupler"].middle
    return float(np.abs(middle).max()) / size


@pytest.mark.parametrize("by", [Elements(1), Segments(3)])
def test_similar_mechanisms_of_any_size_bend_alike(by: Discretisation) -> None:
    assert deflection(1e-4, by) == pytest.approx(deflection(1.0, by), rel=1e-6)
