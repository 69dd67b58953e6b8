"""A mechanism of two freedoms in MuJoCo: a double pendulum with springs, dampers and a pulse."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]  # ships no stubs

from models.array import Array
from models.loads import Load
from models.motion import State
from models.released import Released
from models.scene import Driver, Link, Point, Scene
from models.springs import LineSpring, PinSpring
from models.waves import Pulse
from sim.run import run

PULSE = Pulse(1.0, 0.31, 0.1)
START = np.array([0.3, -0.8, 0.5, 1.0])
END_S = 0.6


def rod(name: str, first: str, second: str) -> Link:
    return Link(name, {first: (0.0, 0.0), second: (1.0, 0.0)}, 1.0, (0.5, 0.0), 1.0 / 12.0)


SCENE = Scene(
    "double-pendulum",
    "test",
    {"A": (0.0, 0.0)},
    {"upper": rod("upper", "A", "B"), "lower": rod("lower", "B", "C")},
    {},
    Driver("upper", Released(START[0], START[2], END_S)),
    gravity_m_s2=(0.0, -9.81),
    springs={
        "knee": PinSpring("knee", 3.0, 0.1, 0.2, "B", ("upper", "lower")),
        "line": LineSpring("line", 5.0, 0.1, 0.5, ("A", "C")),
    },
    loads={"pulse": Load("pulse", "lower", None, PULSE)},
)


def rates(time_s: float, y: Array) -> Array:
    """Of angles and speeds of both rods, by Lagrange's equations for rods of 1 kg and 1 m."""
    a, b, da, db = y
    apart = math.cos(a - b), math.sin(a - b)
    mass = np.array([[4.0 / 3.0, 0.5 * apart[0]], [0.5 * apart[0], 1.0 / 3.0]])
    push = 0.5 * apart[1] * np.array([-(db**2), da**2])
    push -= 9.81 * np.array([1.5 * math.cos(a), 0.5 * math.cos(b)])
    knee = 3.0 * (b - a - 0.2) + 0.1 * (db - da)
    push += np.array([knee, -knee])
    push[1] += PULSE.at(np.array([time_s]))[0]
    along = np.array([math.cos(a) + math.cos(b), math.sin(a) + math.sin(b)])
    ways = np.array([[-math.sin(a), math.cos(a)], [-math.sin(b), math.cos(b)]])
    length = math.hypot(*along)
    unit = along / length
    line = 5.0 * (length - 0.5) + 0.1 * unit @ (da * ways[0] + db * ways[1])
    return np.concatenate([[da, db], np.linalg.solve(mass, push - line * ways @ unit)])


def start() -> State:
    a, b, da, db = START
    alpha = rates(0.0, START)[2:]
    place, speed, push = (np.zeros(2),), (np.zeros(2),), (np.zeros(2),)
    for angle, omega, spin in ((a, da, alpha[0]), (b, db, alpha[1])):
        arm = np.array([math.cos(angle), math.sin(angle)])
        across = np.array([-arm[1], arm[0]])
        place += (place[-1] + arm,)
        speed += (speed[-1] + omega * across,)
        push += (push[-1] + spin * across - omega**2 * arm,)

    def named(vectors: tuple[Array, ...]) -> dict[str, Point]:
        return {p: (float(v[0]), float(v[1])) for p, v in zip("ABC", vectors, strict=True)}

    by_rod = (
        dict(zip(SCENE.links, map(float, pair), strict=True)) for pair in ((a, b), (da, db), alpha)
    )
    return State(0.0, *by_rod, named(place), named(speed), named(push), {}, {})


def test_it_moves_as_lagrange_s_equations_say_to_fourth_order() -> None:
    """Where no loop is closed, nothing is soft."""
    state, kinks = START, (0.0, 0.1, 0.41, END_S)
    for first, last in pairwise(kinks):
        done = solve_ivp(rates, (first, last), state, method="DOP853", rtol=1e-11, atol=1e-11)
        state = done.y[:, -1]
    errors = []
    for dt_s in (4e-3, 2e-3):
        ran = run(SCENE, start(), "mujoco", dt_s=dt_s, steps=round(END_S / dt_s), drive="free")
        assert (ran.status, ran.reason) == ("ok", "")
        ends = np.array([ran.motion.links[rod].theta[-1] for rod in SCENE.links])
        errors.append(np.abs(ends - state[:2]).max())
    assert errors[1] < 5e-9
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.7)
