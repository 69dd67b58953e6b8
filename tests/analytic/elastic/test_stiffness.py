"""The fastest of what elastic links do, which a step has to follow."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from analytic.elastic.discretisation import Segments
from analytic.elastic.stiffness import fastest_rad_s
from models.files import load_scene


@pytest.mark.parametrize("damping_s", [1e-5, 1e-3])
def test_damping_of_a_stiff_chain_is_faster_than_its_vibration(damping_s: float) -> None:
    """Damping over stiffness leaves the modes what they are: each has its ratio of damping."""
    scene, by = load_scene("fourbar-elastic"), Segments(8)
    highest = fastest_rad_s(scene, by)
    links = {n: replace(link, damping_s=damping_s) for n, link in scene.elastic.items()}
    ratio = max(1.0, 0.5 * damping_s * highest)
    fastest = highest * (ratio + math.sqrt(ratio**2 - 1.0))
    assert fastest_rad_s(replace(scene, elastic=links), by) == pytest.approx(fastest, rel=1e-6)
