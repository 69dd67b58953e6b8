"""Gauss' collocation for u'' = a(t, u, u'): what a window of time takes, for any number of nodes.

::

    t0   o    o      o      o    o   t0 + h      the polynomial of degree n - 1 that is a(t, u, u')
                                                 at the n nodes; u and u' are its integrals

The end of a window is of order 2 n, what is in between of order n. Polynomials are kept by their
coefficients in Legendre's, which tell by their decay whether a window is short enough. Source:
E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, section II.7.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from models.array import Array


@dataclass(frozen=True)
class Gauss:
    """For n nodes in (0, 1), ``places``: ``once`` and ``twice`` (n, n) integrate values at the
    nodes from 0 to the nodes, ``end_once`` and ``end_twice`` (n,) to 1; ``series`` (n, n) makes
    coefficients of them, which ``lift_once`` (n + 1, n) and ``lift_twice`` (n + 2, n) integrate."""

    places: Array
    once: Array
    twice: Array
    end_once: Array
    end_twice: Array
    series: Array
    lift_once: Array
    lift_twice: Array

    @property
    def count(self) -> int:
        return len(self.places)


@lru_cache(maxsize=8)
def gauss(count: int) -> Gauss:
    """The rule of ``count`` nodes."""
    x, w = legendre.leggauss(count)
    orders = np.arange(count)
    # Gauss' rule is exact for products of two of these polynomials.
    series = (orders[:, None] + 0.5) * legendre.legvander(x, count - 1).T * w
    lift_once = _integral(count)
    lift_twice = _integral(count + 1) @ lift_once
    once = legendre.legvander(x, count) @ lift_once @ series
    twice = legendre.legvander(x, count + 1) @ lift_twice @ series
    end_once = lift_once.sum(axis=0) @ series  # each polynomial is 1 at the end
    end_twice = lift_twice.sum(axis=0) @ series
    return Gauss(0.5 * (x + 1.0), once, twice, end_once, end_twice, series, lift_once, lift_twice)


def _integral(count: int) -> Array:
    """From coefficients in Legendre's polynomials over [0, 1] to those of the integral from 0."""
    table = np.zeros((count + 1, count))
    for k in range(count):
        table[: k + 2, k] = 0.5 * legendre.legint(np.eye(count)[k], lbnd=-1)[: k + 2]
    return table


def sums(coefficients: Array, share: Array) -> Array:
    """The values of series (..., n) at shares of their windows that broadcast with (...,), by
    Clenshaw's recurrence."""
    x = 2.0 * share - 1.0
    one, two = np.zeros_like(x), np.zeros_like(x)
    for k in range(coefficients.shape[-1] - 1, 0, -1):
        one, two = (
            coefficients[..., k] + (2 * k + 1) / (k + 1) * x * one - (k + 1) / (k + 2) * two,
            one,
        )
    return np.asarray(coefficients[..., 0] + x * one - 0.5 * two)
