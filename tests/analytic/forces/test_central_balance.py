"""Forces of class III groups and of any driver: by groups, by multipliers, by virtual power."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.check import multipliers
from analytic.forces.free_body import free_bodies
from analytic.forces.kinetostatics import forces
from analytic.forces.virtual_power import torque_by_power
from analytic.kinematics import chunks, solve, unit_chunk
from analytic.prepared import prepared
from models.array import Array
from models.files import load_scene, parse_scene, shipped
from models.scene import Scene
from tests.analytic.assur.triad_scenes import KINDS, triad
from tests.analytic.forces.beside import AGREED, apart
from tests.worlds.tiers import few

CYLINDER = """
name = "cylinder"
source = "test"
[ground]
points = { A = [0.0, 0.0], D = [0.6, -0.05], G = [0.45, 0.6] }
[links]
barrel = { points = { A = [0.0, 0.0], K = [0.15, 0.0] } }
piston = { points = { P = [0.0, 0.0], C = [0.15, 0.01] } }
leg2 = { bar = ["D", "E"], length_m = 0.3 }
leg3 = { bar = ["G", "F"], length_m = 0.3 }
plate = { points = { C = [0.0, 0.0], E = [0.25, -0.05], F = [0.12, 0.18] } }
[sliders.S]
link = "piston"
point = "P"
on = "barrel"
[driver]
slider = "S"
law = "oscillating"
centre_m = 0.17
amplitude_m = 0.04
frequency_rad_s = 10.0
"""
DRIVEN = {name: load_scene(name) for name in shipped("structure")}
DRIVEN["cylinder in a leg"] = parse_scene(CYLINDER, "test")


def by_power(scene: Scene, time_s: Array) -> tuple[Array, Array]:
    """Torque and its bound, of a few samples."""
    ((_, chunk),) = chunks(scene, time_s, bound=True)
    unit = unit_chunk(scene, chunk.theta, bound=True)
    torque = torque_by_power(free_bodies(scene, chunk), unit, chunk)
    return torque.value, torque.error


@pytest.mark.parametrize("name", DRIVEN)
def test_whatever_drives_has_the_forces_of_the_multipliers(name: str) -> None:
    scene = DRIVEN[name]
    time_s = np.linspace(0.0, 0.9 * scene.driver.law.period_s, 7)
    found = forces(scene, time_s)
    assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED
    torque, off = by_power(scene, time_s)
    assert np.all(np.abs(found.torque - torque) <= found.bound.torque + off)


QUICK = {("RR", "PR", "RP"), ("PR", "PR", "PP")}


@pytest.mark.parametrize(
    "kinds", few(KINDS, QUICK, "legs of each kind are among the few"), ids="-".join
)
def test_every_kind_of_triad_has_the_forces_of_the_multipliers(kinds: tuple[str, str, str]) -> None:
    scene, _ = triad(kinds, 4, crank_m=0.05)
    ends = prepared(scene).stretched(np.linspace(-0.3, 0.3, 61) + prepared(scene).start)
    short = np.ravel(ends.shortage["platform"])
    time_s = np.linspace(0.0, 0.02, 3) if short.max() > 0.0 else np.linspace(0.0, 0.25, 5)
    found = forces(scene, time_s)
    assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED
