"""Largest errors of a link angle [rad] that real runs had, as numbers that tests read.

Each is ``check(Cell(scene, engine, profile, period / n, 2 n, converge=False))
.errors.worst("angle").pure`` with mujoco 4.0.0 and pymunk 7.3.1: two turns, prescribed drive.
"""

from __future__ import annotations

STEPS = (90, 180, 360, 720, 1440, 2880)
"""Steps per turn of all tuples below."""

MUJOCO_AS_SHIPPED = {
    "fourbar-lecture-1": ((0.01029, 0.005021, 0.002231, 0.001027, 7.414e-4, 7.339e-4), 8.694e-4),
    "fourbar-lecture-2": ((0.01028, 0.005023, 0.002325, 0.00107, 4.909e-4, 3.93e-4), 4.896e-4),
    "fourbar-crossed": ((0.01073, 0.005079, 0.002222, 0.001087, 7.132e-4, 8.521e-4), 0.001155),
    "fourbar-double-crank": ((0.01789, 0.007313, 0.002784, 0.004069, 0.005208, 0.005853), 0.006362),
    "fourbar-double-rocker": ((0.003979, 0.00168, 0.001113, 9.698e-4, 9.082e-4, 8.79e-4), 8.541e-4),
    "shaper": ((0.02725, 0.03076, 0.03252, 0.0334, 0.03384, 0.03406), 0.03425),
    "sixbar-stephenson": ((0.01022, 0.004949, 0.002037, 0.001003, 0.001004, 0.001042), 0.001081),
    "sixbar-watt": ((0.01001, 0.00473, 0.002181, 0.001225, 0.001051, 0.001247), 0.001535),
    "slider-crank-central": ((0.004608, 0.002363, 0.00136, 9.076e-4, 6.964e-4, 5.925e-4), 5.026e-4),
    "slider-crank-offset": ((0.004639, 0.002369, 0.001406, 9.467e-4, 7.226e-4, 6.247e-4), 5.427e-4),
    "slotted-lever": ((0.006712, 0.003281, 0.001469, 5.827e-4, 2.154e-4, 2.399e-4), 4.201e-4),
    "whitworth": ((0.01474, 0.007613, 0.004164, 0.003677, 0.003768, 0.003891), 0.004043),
}
"""MuJoCo as shipped: the errors at `STEPS`, and that at 23040 steps per turn, eight times finer."""

ORDERS = {
    "fourbar-lecture-1, mujoco tuned": (
        (6.383e-6, 1.496e-6, 3.734e-7, 9.345e-8, 2.333e-8, 5.827e-9),
        2.0,
    ),
    "fourbar-lecture-1, pymunk as-shipped": (
        (0.02415, 0.01182, 0.00585, 0.00291, 0.001451, 7.248e-4),
        1.0,
    ),
    "fourbar-lecture-1, pymunk tuned": (
        (0.002175, 5.444e-4, 1.362e-4, 3.407e-5, 8.521e-6, 2.131e-6),
        2.0,
    ),
    "shaper, pymunk as-shipped": ((0.1248, 0.01974, 0.005373, 0.002348, 0.001108, 5.415e-4), 1.0),
    "shaper, mujoco tuned": ((1.183e-4, 3.363e-5, 8.707e-6, 2.213e-6, 5.631e-7, 1.417e-7), 2.0),
    "slider-crank-excel-210, mujoco tuned": (
        (3.735e-5, 1.159e-5, 3.48e-6, 9.529e-7, 2.459e-7, 6.199e-8),
        2.0,
    ),
}
"""Errors at `STEPS`, and the order to which their slope settles (seen at 5760 steps per turn)."""

THIRD_THEN_SECOND = (3.356e-5, 4.104e-6, 4.954e-7, 5.747e-8, 1.044e-8, 2.614e-9)
"""fourbar-double-rocker, mujoco tuned: third order that becomes second; 6.6e-10 at 5760."""

DIPS = (0.01709, 0.005277, 0.001436, 2.964e-4, 6.968e-5, 1.412e-4)
"""slider-crank-excel-210, mujoco as-shipped: 2.1e-4 at 5760, 2.6e-4 at 23040."""

LEAVES_ITS_BRANCH = (12.99, 0.2707, 0.2385, 0.2238, 0.2167, 0.2132, 0.2115)
"""slider-crank-excel-210, pymunk as-shipped, at 45 (branch-changed) and at `STEPS` (ok)."""
