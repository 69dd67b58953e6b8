"""Differentiation and integration of a graph with ruler and pole: the points that are plotted.

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

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from models.array import Array
from models.motion import Order

Method = Literal["chords", "tangents", "integration"]
METHODS: tuple[Method, ...] = get_args(Method)
ORDERS: tuple[Order, ...] = get_args(Order)
Readings = Callable[[Order, Array], Array]
"""Source of a plotted graph: a quantity (0), its rate (1) or the rate of that (2) at places."""


@dataclass(frozen=True)
class Plotted:
    """Points of a graph at ``x`` (n,), rising: ``y`` (n,)."""

    x: Array
    y: Array


@dataclass(frozen=True)
class ThreeGraphs:
    """Quantity, its rate and the rate of that, two of them drawn from the third. ``slopes`` are the
    axis sections of rays from the poles of the second and third graph: those of the chords
    (tangents, steps) of the graph of the order before."""

    graphs: tuple[Plotted, Plotted, Plotted]
    slopes: tuple[Plotted, Plotted]


def by_chords(graph: Plotted) -> Plotted:
    """Return the derivative in the middles of the parts, of second order there."""
    return Plotted(_middles(graph.x), np.diff(graph.y) / np.diff(graph.x))


def by_tangents(graph: Plotted) -> Plotted:
    """Return the derivative at the divisions between the ends, by the tangent of the parabola
    through a division and its neighbours; of second order."""
    left, right = np.diff(graph.x)[:-1], np.diff(graph.x)[1:]
    chords = np.diff(graph.y) / np.diff(graph.x)
    return Plotted(graph.x[1:-1], (right * chords[:-1] + left * chords[1:]) / (left + right))


def integrated(x: Array, mean_ordinates: Array, start: float) -> Plotted:
    """Return the integral at the divisions ``x`` (n + 1,), from ``start`` at the first on, of
    second order where the mean ordinates of the parts (n,) are those in their middles."""
    steps = mean_ordinates * np.diff(x)
    return Plotted(x, start + np.concatenate([[0.0], np.cumsum(steps)]))


def three_graphs(
    method: Method, x: Array, readings: Readings, start: tuple[float, float]
) -> ThreeGraphs:
    """Return a quantity and both of its rates, as drawn.

    Parameters
    ----------
    method : Method
        By chords or tangents the quantity is read at the divisions, and differentiated twice; by
        integration the second rate is, in the middles of the parts, and is integrated twice.
    x : Array
        The divisions (n + 1,), rising.
    readings : Readings
        Function that reads the graph, of order 0, or, for integration, of order 2.
    start : (float, float)
        Quantity and rate at the first division: the constants of integration.
    """
    if method == "integration":
        second = Plotted(_middles(x), readings(2, _middles(x)))
        first = integrated(x, second.y, start[1])
        # The mean ordinate of a part of the first integral is that of its chord.
        means = Plotted(second.x, 0.5 * (first.y[1:] + first.y[:-1]))
        return ThreeGraphs((integrated(x, means.y, start[0]), first, second), (means, second))
    differentiated = by_chords if method == "chords" else by_tangents
    graph = Plotted(x, readings(0, x))
    first = differentiated(graph)
    second = differentiated(first)
    return ThreeGraphs((graph, first, second), (first, second))


def derivative_scale(pole_mm: float, scale_x: float, scale_y: float) -> float:
    """Return mu_y = mu_Y / (H mu_x) of a derivative, from the scales of the graph and H [mm]."""
    return scale_y / (pole_mm * scale_x)


def _middles(x: Array) -> Array:
    return 0.5 * (x[1:] + x[:-1])
