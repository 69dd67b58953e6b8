"""A scene that is free with everything that may act on one, and how what is free starts."""

import numpy as np

from analytic.free.machine import Machine
from analytic.kinematics import solve_driven
from models.motion import State
from models.scene import Scene

EVERYTHING = """
name = "everything"
source = "a test"
gravity_m_s2 = [0.5, -9.81]
[ground]
points = { A = [0.0, 0.0], G = [0.0, 0.5], H = [0.1, 0.5] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1, flywheel_kg_m2 = 0.01 }
rod = { bar = ["B", "C"], points = { S = [0.1, 0.05] }, length_m = 0.3 }
[sliders.C]
on = "ground"
through_m = [0.0, -0.02]
mass_kg = 0.5
[driver]
link = "crank"
law = "free"
start_deg = 30.0
speed_rad_s = 2.0
duration_s = 4.0
[start]
angles_deg = { crank = 30.0 }
rates_rad_s = { crank = 2.0 }
[springs]
line = { points = ["G", "S"], rate_n_m = 50.0, free_m = 0.1 }
turning = { pin = "B", rate_n_m_rad = 0.3, damping_n_m_s = 0.01, free_deg = -20.0 }
along = { slider = "C", damping_n_s_m = 0.2 }
[friction]
A = { torque_n_m = 0.004 }
[loads]
pulse = { link = "rod", law = "pulse", period_s = 0.2, start_s = 0.1, torque_n_m = 0.3 }
switch = { block = "C", law = "steps", at_s = [0.0, 0.25, 0.5], force_n = [0.5, 1.0, 0.0] }
[loads.motor]
link = "crank"
law = "table"
over = "omega"
interpolation = "linear"
at_rad_s = [-40.0, 60.0]
torque_n_m = [0.5, -0.5]
[loads.drag]
block = "C"
law = "polynomial"
over = "speed"
slider = "C"
direction_deg = 180.0
force_n = [0.0, 0.5]
[loads.waves]
link = "crank"
law = "fourier"
over = "angle"
period_deg = 360.0
torque_n_m = 0.05
cosines = [0.1]
sines = [0.2, 0.03]
"""


def released(scene: Scene) -> tuple[State, float]:
    """The state of the start, and the acceleration of the driver by the equation of the machine."""
    law = scene.driver.law
    theta, omega = np.array([law.start_rad]), np.array([law.speed_rad_s])  # type: ignore[attr-defined]  # Released
    alpha = Machine(scene).acceleration(np.zeros(1), theta, omega)
    motion = solve_driven(scene, theta, omega, alpha, np.zeros(1), bound=False)
    return motion.state(), float(alpha[0])
