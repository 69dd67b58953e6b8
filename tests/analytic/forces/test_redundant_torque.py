"""The torque where redundant links leave the reactions open."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import kinetostatics, virtual_power
from models.files import load_scene
from models.laws import Accelerating
from models.scene import Driver
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.analytic.forces.beside import AGREED, out_of_balance
from tests.worlds.loading import loaded


@pytest.mark.parametrize("number", range(6))
def test_redundant_links_leave_the_torque(number: int) -> None:
    """The balance of power holds for it, to rounding."""
    rng = random.Random(number)
    scene = parallelogram(2) if number % 2 else with_strut(parallelogram(1), "B0", "B1")
    scene = replace(loaded(scene, rng), loads={}, gravity_m_s2=(0.0, -9.81))
    time_s = np.linspace(0.0, 1.0, 9)
    found = kinetostatics.forces(scene, time_s)
    assert not found.pins
    assert not found.sliders
    assert "redundant links" in found.undetermined
    assert "stiffness" in found.undetermined
    assert out_of_balance(scene, time_s, found) <= AGREED
    assert np.all(found.bound.torque < 1e-9 * np.abs(found.torque).max())


def test_a_redundant_link_without_mass_changes_no_torque() -> None:
    """Within both bounds, which go on along two ways."""
    scene = replace(loaded(parallelogram(1), random.Random(5)), gravity_m_s2=(0.0, -9.81))
    strutted = with_strut(scene, "B0", "B1")
    strut = replace(strutted.links["strut"], mass_kg=0.0, inertia_kg_m2=0.0)
    strutted = replace(strutted, links={**strutted.links, "strut": strut})
    time_s = np.linspace(0.0, 1.0, 9)
    plain, spare = (kinetostatics.forces(each, time_s) for each in (scene, strutted))
    most = plain.bound.torque + spare.bound.torque
    assert np.all(np.abs(plain.torque - spare.torque) <= most)
    assert np.all(most < 1e-9 * np.abs(plain.torque).max())


@pytest.mark.parametrize("name", ["shaper", "sixbar-watt", "tangent"])
def test_virtual_power_gives_the_torque_of_the_reactions(name: str) -> None:
    """Within the bounds of both; at rest too, where power says nothing."""
    scene = loaded(load_scene(name), random.Random(name))
    loads = {n: one for n, one in scene.loads.items() if one.stroke == "both"}
    law = Accelerating(0.3, 0.0, 5.0)
    scene = replace(scene, driver=Driver(scene.driver.link, law), loads=loads)
    time_s = np.linspace(0.0, 0.3, 7)
    found = kinetostatics.forces(scene, time_s)
    parts = list(kinetostatics.chunks(scene, time_s, bound=True))
    (_, chunk), unit = parts[0], kinetostatics.unit_chunk(scene, parts[0][1].theta, bound=True)
    free = kinetostatics.free_bodies(scene, chunk)
    kinetostatics.apply_loads(scene, chunk, time_s, free)
    own = virtual_power.torque_by_power(free, unit, chunk)
    assert np.all(np.abs(own.value - found.torque) <= own.error + found.bound.torque)
    assert np.all(own.error < 1e-10 * np.abs(found.torque).max())
