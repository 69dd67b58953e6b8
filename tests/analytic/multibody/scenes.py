"""Scenes of free motion whose motion, or whose start, is known by hand; and some that are not."""

import numpy as np

from analytic.kinematics import solve
from analytic.multibody.as_motion import as_motion
from analytic.multibody.multibody_motion import MultibodyMotion
from analytic.multibody.release_multibody import ready, release_multibody
from models.files.reading import parse_scene
from models.motion import State
from models.scene import Scene

G = 9.81


def scene(text: str, gravity: float = G) -> Scene:
    """A scene of a file without name and source, let go in a vertical plane."""
    head = f'name = "free"\nsource = "ours"\ngravity_m_s2 = [0.0, {-gravity}]\n'
    return parse_scene(head + text, "free.toml")


def by_bodies(mechanism: Scene, until_s: float) -> MultibodyMotion:
    """Its motion by the multibody form, from the assembly that the closed form has."""
    near = solve(mechanism, np.zeros(1), bound=False).state()
    return release_multibody(mechanism, until_s, near=near)


def start_state(mechanism: Scene, near: State | None = None) -> State:
    """Its state when it is in free motion, with accelerations."""
    dynamics, q, rates = ready(mechanism, near)
    now, at = dynamics.assembly.at_rates(q[None], rates[None]), np.zeros(1)
    return as_motion(dynamics.assembly, at, now, dynamics.solve(at, now)[0]).state()


ROTOR = """
ground = { points = { A = [0.0, 0.0] } }
[links.rod]
bar = ["A", "B"]
length_m = 0.5
mass_kg = 1.2
centre_m = [0.2, 0.05]
inertia_kg_m2 = 0.03
[driver]
link = "rod"
law = "free"
"""
ROTOR_J = 0.03 + 1.2 * (0.2**2 + 0.05**2)
"""About A."""

DOUBLE_PENDULUM = """
ground = { points = { A = [0.0, 0.0] } }
[links]
upper = { bar = ["A", "B"], length_m = 0.3 }
lower = { bar = ["B", "C"], length_m = 0.2 }
[driver]
link = "upper"
law = "free"
start_deg = 10.0
speed_rad_s = 1.0
[start]
angles_deg = { lower = -40.0 }
rates_rad_s = { lower = 2.0 }
"""

SLIDER_CRANK = """
ground = { points = { A = [0.0, 0.0] } }
sliders = { C = { on = "ground", mass_kg = 0.5 } }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "C"], length_m = 0.3 }
[driver]
link = "crank"
law = "free"
"""

THESIS = """
ground = { points = { A = [0.0, 0.0], D = [1.0, 0.0] } }
[links]
crank = { bar = ["A", "B"], length_m = 0.15 }
coupler = { bar = ["B", "C"], length_m = 0.75 }
rocker = { bar = ["D", "C"], length_m = 0.75 }
[driver]
link = "crank"
law = "free"
start_deg = 90.0
[loads]
motor = { link = "crank", law = "pulse", torque_n_m = 0.03, period_s = 1.0 }
[start]
angles_deg = { coupler = 39.0, rocker = 124.0 }
"""

PARALLELOGRAM = """
ground = { points = { A = [0.0, 0.0], E = [0.4, 0.0], D = [1.0, 0.0] } }
[links]
crank = { bar = ["A", "B"], length_m = 0.3, mass_kg = 0.5 }
coupler = { bar = ["B", "C"], length_m = 1.0, points = { F = [0.4, 0.0] }, mass_kg = 2.0 }
rocker = { bar = ["D", "C"], length_m = 0.3, mass_kg = 0.5 }
spare = { bar = ["E", "F"], length_m = 0.3, mass_kg = 0.5 }
[driver]
link = "crank"
law = "free"
start_deg = 60.0
speed_rad_s = 1.0
[start]
angles_deg = { coupler = 0.0, rocker = 60.0 }
"""
"""Three rods alike carry a coupler that only shifts; one of them is redundant."""

FIVE_BAR = """
ground = { points = { A = [0.0, 0.0], E = [0.3, 0.0] } }
[links]
left = { bar = ["A", "B"], length_m = 0.2 }
first = { bar = ["B", "C"], length_m = 0.25 }
second = { bar = ["D", "C"], length_m = 0.25 }
right = { bar = ["E", "D"], length_m = 0.2 }
[driver]
link = "left"
law = "free"
start_deg = 110.0
speed_rad_s = 0.5
[start]
angles_deg = { right = 70.0, first = 29.0, second = 151.0 }
rates_rad_s = { right = -0.5 }
"""
