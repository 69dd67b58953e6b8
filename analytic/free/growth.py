"""How a small change of the start grows: the variation of an integrated motion.

Each window knows the derivative of its end by its start; their product is that of the motion. Where
the acceleration jumps at a place, whoever comes there later is pushed later; where it jumps as the
machine comes to rest, the rates before and after are as the accelerations. Source: M. di Bernardo
et al., Piecewise-smooth Dynamical Systems, section 2.5 (saltation matrices).
"""

from __future__ import annotations

import math

import numpy as np

from analytic.free.chart import Chart
from analytic.free.coordinate_history import CoordinateHistory, Window
from analytic.free.gauss import gauss
from models.array import Array

STEEP = 0.1
"""Nearer to a limit of the driver than where its angle changes by this per unit of the coordinate,
a start is changed in the coordinate, as the angle is at its end there."""

AT_REST = 1e-10
"""Of the rates in a window: what is slower at its end has come to rest."""


def growth(history: CoordinateHistory, omega: float) -> tuple[Array, Array]:
    """Times [s], and by how much a small change of the start has grown until then at most.

    What has grown is the change of the driver's angle. It is the larger one of what comes of a
    changed angle, per rad, and of a changed speed, per ``omega`` [rad/s]; at least 1.
    """
    chart = history.windows[0].chart
    u0, v0 = (float(row[0]) for row in history.state(np.zeros(1))[:2])
    _, first, second = (float(row[0]) for row in chart.driver(np.array([u0])))
    steep = math.copysign(max(abs(first), STEEP), first)
    # The angle changed by 1 at the same speed; the speed changed by omega.
    change = np.array([[1.0 / steep, 0.0], [-second * v0 / steep**2, omega / steep]])
    times, sizes = [np.zeros(1)], [np.ones(1)]
    for k, window in enumerate(history.windows):
        at = window.start_s + window.long_s * gauss(window.swing.shape[1]).places
        turned = window.chart.driver(history.state(at)[0])[1]
        sizes.append(np.abs(turned * (window.swing.T @ change).T).max(axis=0))
        times.append(at)
        change = window.change @ change
        if k + 1 < len(history.windows):
            change = _across(window, history.windows[k + 1]) @ change
    time_s, size = np.concatenate(times), np.concatenate(sizes)
    return time_s, np.maximum.accumulate(np.maximum(size, 1.0))


def _across(before: Window, after: Window) -> Array:
    """The derivative from the end of a window to the start of the next one."""
    matrix = np.eye(2)
    v = float(before.v.sum())
    if before.bends and before.chart is after.chart:
        start = (-1.0) ** np.arange(max(len(after.v), len(after.a)))
        a, b = float(before.a.sum()), float(after.a @ start[: len(after.a)])
        v = float(after.v @ start[: len(after.v)])
        if abs(v) > AT_REST * float(np.abs(before.v).sum() + np.abs(after.v).sum()):
            matrix[1, 0] = (b - a) / v
        elif a:
            matrix[1, 1] = b / a
    if before.chart is not after.chart:
        matrix = _between(before.chart, after.chart, float(before.u.sum()), v) @ matrix
    return matrix


def _between(old: Chart, new: Chart, u: float, v: float) -> Array:
    """The derivative of the coordinate and the rate of one chart by those of another."""
    phi, first, second = (float(row[0]) for row in old.driver(np.array([u])))
    assert new.limit is not None
    x = np.array([new.limit.coordinate(phi)])
    _, own, bent = (float(row[0]) for row in new.driver(x))
    ratio = first / own
    return np.array([[ratio, 0.0], [(second - ratio * ratio * bent) * v / own, ratio]])
