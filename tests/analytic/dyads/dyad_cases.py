"""Random dyads of each kind, in bunches that share their lengths, up to their toggle positions.

Every bunch can solve itself in floats (the solver under test, on arrays) and, sample by sample, in
fifty digits (the oracle) from the same inputs, or from inputs moved within their stated errors.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from mpmath import mp

from analytic.dyads import prp, rpp, rpr, rrp, rrr
from analytic.dyads.parts import Dyad
from analytic.dyads.plane import (
    Vec,
)
from models.array import Array
from tests.analytic import oracle
from tests.analytic.change_points.jets import Jet, Number
from tests.analytic.dyads.dyad_inputs import BUNCH, CLOSE, Draw, Exact, Moved


@dataclass(frozen=True)
class Bunch:
    """Dyads of one kind with the same lengths.

    ``truth`` gives both unknowns of a sample, ``short`` by how much it is short of closing [m],
    ``sine`` its conditioning; ``size`` is the largest length in the closure of each sample over
    the smallest link, the factor that rounding comes with.
    """

    dyad: Dyad
    truth: Callable[[int, Exact | Moved], tuple[Jet, Jet]]
    short: Callable[[int], Number]
    sine: Array
    size: Array
    scale: float
    rate: float


def _directed(angle: Array) -> Array:
    return np.array([np.cos(angle), np.sin(angle)])


def draw_rrr(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    l1, l2 = (float(scale * draw.log(0.1, 10.0)) for _ in range(2))
    branch = int(draw.sign())
    clear, near = draw.clearances()
    outer, inner = l1 + l2, abs(l1 - l2)
    at_outer = draw.rng.random(BUNCH) < 0.5
    d = np.where(at_outer, outer * (1.0 - clear), inner * (1.0 + clear))
    d = np.where(near, d, inner + (outer - inner) * clear)
    place = draw.origins(outer, near, clear < CLOSE)
    first = draw.points(place, scale, rate)
    away = d * _directed(draw.rng.uniform(-math.pi, math.pi, BUNCH))
    second = draw.points(place + away, scale, rate, rest=bool(draw.rng.random() < 0.3))
    dyad = rrr.solve(first.kinematics(), second.kinematics(), l1, l2, branch, certified=True)

    def ends(i: int, shift: Exact | Moved) -> tuple[oracle.Place, oracle.Place]:
        return first.place(i, shift), second.place(i, shift)

    sine = [float(oracle.sine_rrr(*ends(i, Exact()), l1, l2)) for i in range(BUNCH)]
    return Bunch(
        dyad,
        lambda i, shift: oracle.rrr(*ends(i, shift), l1, l2, branch),
        lambda i: oracle.rrr_short(*ends(i, Exact()), l1, l2),
        np.array(sine),
        (np.hypot(*place) + outer) / min(l1, l2),
        scale,
        rate,
    )


def draw_rrp(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    length, branch = float(scale * draw.log(0.1, 10.0)), int(draw.sign())
    clear, near = draw.clearances()
    height = length * (1.0 - clear) * draw.sign(BUNCH)
    theta = draw.rng.uniform(-math.pi, math.pi, BUNCH)
    home = clear < CLOSE
    theta = np.where(home, 0.0, theta)  # else the height is not what it should be exactly
    place = draw.origins(length, near, home)
    line = draw.lines(place, theta, scale, rate)
    ahead = length * draw.log(1e-9, 10.0, BUNCH) * draw.sign(BUNCH)
    e = _directed(theta)
    pin = draw.points(place + ahead * e + height * np.array([-e[1], e[0]]), scale, rate)
    dyad = rrp.solve(pin.kinematics(), line.kinematics(), length, branch, certified=True)

    def given(i: int, shift: Exact | Moved) -> tuple[oracle.Place, oracle.Line]:
        return pin.place(i, shift), line.line(i, shift)

    high = [float(oracle.rrp_short(*given(i, Exact()), length)) / length for i in range(BUNCH)]
    return Bunch(
        dyad,
        lambda i, shift: oracle.rrp(*given(i, shift), length, branch),
        lambda i: oracle.rrp_short(*given(i, Exact()), length),
        np.sqrt(np.maximum(0.0, -np.array(high) * (2.0 + np.array(high)))),
        (np.hypot(*place) + np.abs(ahead) + length) / length,
        scale,
        rate,
    )


def draw_rpr(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    offset = float(scale * draw.log(0.01, 10.0)) * int(draw.sign())
    central = bool(draw.rng.random() < 0.3)
    branch = int(draw.sign())
    clear, near = draw.clearances()
    if central:  # the line passes through its pin: nothing is singular before the pins meet
        offset, d = 0.0, scale * np.maximum(np.sqrt(clear), 1e-6)
        clear = np.maximum(clear, 1e-12)
    else:
        d = np.where(near, abs(offset) * (1.0 + clear), abs(offset) / (1.0 - clear * clear))
    place = draw.origins(float(np.max(d)) if central else abs(offset), near, clear < CLOSE)
    second = draw.points(place, scale, rate, rest=bool(draw.rng.random() < 0.3))
    away = d * _directed(draw.rng.uniform(-math.pi, math.pi, BUNCH))
    first = draw.points(place + away, scale, rate)
    dyad = rpr.solve(first.kinematics(), second.kinematics(), offset, branch, certified=True)

    def ends(i: int, shift: Exact | Moved) -> tuple[oracle.Place, oracle.Place]:
        return first.place(i, shift), second.place(i, shift)

    high = [
        float(oracle.rpr_short(*ends(i, Exact()), offset) / d[i]) for i in range(BUNCH)
    ]  # negative where it closes; the sine squared is (d^2 - h^2) / d^2
    near_to = -np.array(high)
    return Bunch(
        dyad,
        lambda i, shift: oracle.rpr(*ends(i, shift), offset, branch),
        lambda i: oracle.rpr_short(*ends(i, Exact()), offset),
        np.sqrt(np.maximum(0.0, near_to * (1.0 + abs(offset) / d))),
        (np.hypot(*place) + scale + d) / d,
        scale,
        rate,
    )


def _line_angles(draw: Draw) -> Array:
    """Angles between two lines: anything, or nearly (or but for rounding) parallel."""
    clear, near = draw.clearances()
    clear = np.maximum(clear, 1e-15)  # in floats no nearer: parallel lines do not close
    half = np.where(draw.rng.random(BUNCH) < 0.5, math.pi, 0.0)
    return np.where(near, half + clear * draw.sign(BUNCH), math.pi * clear * draw.sign(BUNCH))


def draw_prp(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    between = _line_angles(draw)
    theta = draw.rng.uniform(-1.0, 1.0, BUNCH)
    place = draw.origins(scale, np.abs(np.sin(between)) < 1e-5, np.zeros(BUNCH, dtype=bool))
    line1 = draw.lines(place, theta, scale, rate)
    away = scale * draw.rng.normal(size=(2, BUNCH))
    line2 = draw.lines(place + away, theta + between, scale, rate)
    dyad = prp.solve(line1.kinematics(), line2.kinematics(), certified=True)
    return Bunch(
        dyad,
        lambda i, shift: oracle.prp(line1.line(i, shift), line2.line(i, shift)),
        lambda i: mp.mpf(-1),
        np.abs(np.sin(between)),
        (np.hypot(*place) + np.hypot(*away)) / scale,
        scale,
        rate,
    )


def draw_rpp(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    near = draw.near and bool(draw.rng.random() < 0.5)  # the angle is one for the whole bunch
    angle = float(draw.log(1e-12, 1e-6)) if near else float(draw.rng.uniform(0.02, 3.12))
    inner = (angle if draw.rng.random() < 0.5 else math.pi - angle) * int(draw.sign())
    theta = draw.rng.uniform(-math.pi, math.pi, BUNCH)
    place = draw.origins(scale, np.full(BUNCH, near), np.zeros(BUNCH, dtype=bool))
    line = draw.lines(place, theta, scale, rate)
    away = scale * draw.rng.normal(size=(2, BUNCH))
    pin = draw.points(place + away, scale, rate)
    turn = Vec(math.cos(inner), math.sin(inner))
    dyad = rpp.solve(pin.kinematics(), line.kinematics(), turn, certified=True)
    return Bunch(
        dyad,
        lambda i, shift: oracle.rpp(pin.place(i, shift), line.line(i, shift), inner),
        lambda i: mp.mpf(-1),
        np.full(BUNCH, abs(math.sin(inner))),
        (np.hypot(*place) + np.hypot(*away)) / scale,
        scale,
        rate,
    )


KINDS: dict[str, Callable[[Draw], Bunch]] = {
    "RRR": draw_rrr,
    "RRP": draw_rrp,
    "RPR": draw_rpr,
    "PRP": draw_prp,
    "RPP": draw_rpp,
}
