"""Fourier descriptors of closed curves, that do not change with place, size, turn and start.

A curve drawn at constant speed is z(s) = sum of c_k exp(2 pi i k s), s its share of the length. A
descriptor is the coefficients c_k of -H..H but for c_0, which is the place, over the root of the
sum of all squares, which is the size. A turn by rho and a start later by sigma make of c_k the
number c_k exp(i rho + 2 pi i k sigma). The similarity of two curves is

    max over sigma of | sum of conj(c_k) d_k exp(2 pi i k sigma) |      from 0 to 1,

which no turn and no start changes. With coefficients normalised one by one to a phase of 0, as in
the sources, a nearly round curve, whose c_-1 is nearly 0, would have a descriptor by chance.

Source: J. R. McGarva and G. Mullineux, Harmonic representation of closed curves, Applied
Mathematical Modelling 17 (1993), pages 213 to 218; I. Ullah and S. Kota, Optimal synthesis of
mechanisms for path generation using Fourier descriptors and global search methods, Journal of
Mechanical Design 119 (1997), pages 504 to 510.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis.path.arc_length import at_shares, shares
from analytic.lectures.synthesis.path.unit_four_bar import Complexes
from models.array import Array

HARMONICS = 10
"""Coefficients on either side: of a four-bar's coupler curve the rest is below a hundredth."""
SAMPLES = 64
"""Places on a curve that they are found from."""
STARTS = 128
"""That are compared."""
ORDERS = np.concatenate([np.arange(1, HARMONICS + 1), np.arange(-HARMONICS, 0)])


@dataclass(frozen=True)
class Match:
    """How well a curve meets each of others: the similarity, (E,), and the start [share of the
    length], (E,), to which the curve's own start belongs on them."""

    similarity: Array
    start: Array


def descriptors(curves: Complexes) -> Complexes:
    """Those of closed curves (E, M), whose last point is the first again, (E, 2 HARMONICS)."""
    even = np.tile(np.arange(SAMPLES) / SAMPLES, (len(curves), 1))
    drawn = at_shares(shares(curves), curves, even)
    every = np.fft.fft(drawn, axis=1)
    every[:, 0] = 0.0
    # With the size of all that a curve has, one of finer waves than are kept is like none.
    size = np.sqrt(np.sum(np.abs(every) ** 2, axis=1, keepdims=True))
    return np.asarray(every[:, ORDERS] / np.maximum(size, np.finfo(np.float64).tiny))


def match(one: Complexes, others: Complexes) -> Match:
    """One descriptor (2 HARMONICS,) beside others (E, 2 HARMONICS), over all starts."""
    product = np.zeros((len(others), STARTS), dtype=np.complex64)
    product[:, ORDERS] = one.conj() * others
    # The inverse transform sums the products at all starts at once.
    value = np.abs(np.fft.ifft(product, axis=1)) * STARTS
    best = np.argmax(value, axis=1)
    return Match(np.asarray(value[np.arange(len(others)), best], dtype=np.float64), best / STARTS)
