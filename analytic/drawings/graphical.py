"""Differentiation and integration of a graph with ruler and pole, and what they are off by.

::

      Y |        .                 differentiation: a ray from the pole P parallel to the chord
        |     .'  chord            between two divisions cuts off the derivative of their middle
        |  .'                      on the axis, mu_y = mu_Y / (H mu_x)
     ---+------------ x
    P---O  H                       integration: the mean ordinate of a part, carried to the axis,
                                   makes a ray whose parallel is the step of the integral over
                                   the part, mu_Y = H mu_x mu_y

Scales mu are units to the millimetre, the pole distance H is millimetres of paper. Source: lecture
"Phan tich dong hoc", part V; problem book "Bai tap co hoc may", appendix, graphical integration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.array import Array


@dataclass(frozen=True)
class Differentiated:
    """The derivative of a graph at ``x`` (n,): ``y`` (n,), and the ordinates that the rays cut off
    on the axis [mm], (n,), at the scale ``scale`` [unit of y to the mm]."""

    x: Array
    y: Array
    ordinates_mm: Array
    scale: float


@dataclass(frozen=True)
class Integrated:
    """The integral of a graph at the ends of its parts, ``x`` and ``y`` (n + 1,), from 0 on; the
    mean ordinates that made it (n,), and its scale [unit of Y to the mm]."""

    x: Array
    y: Array
    mean_ordinates: Array
    scale: float


def by_chords(x: Array, y: Array, pole_mm: float, scale_x: float, scale_y: float) -> Differentiated:
    """The derivative in the middles of the parts, of second order there.

    Parameters
    ----------
    x, y : Array
        The divisions of the graph and its values there, (n + 1,), x rising.
    pole_mm : float
        The distance H of the pole from the axis [mm].
    scale_x, scale_y : float
        mu_x and mu_Y of the graph [unit to the mm].
    """
    slopes = np.diff(y) / np.diff(x)
    return _with_rays(0.5 * (x[1:] + x[:-1]), slopes, pole_mm, scale_x, scale_y)


def by_tangents(
    x: Array, y: Array, pole_mm: float, scale_x: float, scale_y: float
) -> Differentiated:
    """The derivative at the divisions between the ends, the tangent there being that of the
    parabola through a division and its neighbours; of second order. As `by_chords`."""
    left, right = np.diff(x)[:-1], np.diff(x)[1:]
    chords = np.diff(y) / np.diff(x)
    slopes = (right * chords[:-1] + left * chords[1:]) / (left + right)
    return _with_rays(x[1:-1], slopes, pole_mm, scale_x, scale_y)


def _with_rays(
    x: Array, slopes: Array, pole_mm: float, scale_x: float, scale_y: float
) -> Differentiated:
    """The slopes as what the rays cut off on the axis."""
    scale = scale_y / (pole_mm * scale_x)
    return Differentiated(x, slopes, slopes / scale, scale)


def integrate(
    x: Array, middles: Array, pole_mm: float, scale_x: float, scale_y: float
) -> Integrated:
    """The integral from the first division on, of second order.

    Parameters
    ----------
    x : Array
        The divisions (n + 1,), rising.
    middles : Array
        The values of the graph in the middles of the parts (n,): their mean ordinates, as far as
        the graph is straight there.
    pole_mm, scale_x, scale_y : float
        As in `by_chords`.
    """
    steps = middles * np.diff(x)
    y = np.concatenate([[0.0], np.cumsum(steps)])
    return Integrated(x, y, middles, pole_mm * scale_x * scale_y)
