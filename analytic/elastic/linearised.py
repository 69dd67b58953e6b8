"""The equations of elastic links, linearised about the motion of the rigid mechanism.

    M(t) y'' + C(t) y' + K(t) y = h(t)

y are the coefficients of the shapes; all four are periodic where the driver's speed is constant.
The derivatives are taken of the whole equations, by differences of a step at which truncation and
rounding are alike, once extrapolated. Source: Thesis on vibration of planar mechanisms with elastic
links (2018), chapter 4.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from analytic.elastic.reduced import ReducedForm
from models.array import Array


@dataclass(frozen=True)
class LinearForm:
    """M, C, K (T, m, m) and h (T, m) at times [s], (T,)."""

    time_s: Array
    mass: Array
    damping: Array
    stiffness: Array
    force: Array


def linearise(
    form: ReducedForm,
    time_s: Array,
    scale_m: float,
    about: tuple[Array, Array, Array] | None = None,
) -> LinearForm:
    """The equations next to the rigid mechanism at times (T,), or next to coefficients with their
    rates and second derivatives ``about``, (T, m) each.

    Derivatives are differences over ``scale_m`` [m], and over that at the driver's speed.
    """
    count, m = len(time_s), form.size
    z, rates, seconds = about or (np.zeros((count, m)),) * 3
    near, nothing = form.near(time_s), np.zeros(m)

    def left(dz: Array, drates: Array) -> Array:
        now = form.at(time_s, z + dz, rates + drates, near)
        return np.asarray((now.mass @ seconds[:, :, None])[:, :, 0] - now.force)

    speed = scale_m * float(np.abs(form.law.at(time_s)[1]).max())
    base = form.at(time_s, z, rates, near)
    stiffness, damping = np.empty((count, m, m)), np.empty((count, m, m))
    for k, one in enumerate(np.eye(m)):
        stiffness[:, :, k] = _slope(partial(left, drates=nothing), scale_m * one) / scale_m
        damping[:, :, k] = _slope(partial(left, nothing), speed * one) / speed
    force = base.force - (base.mass @ seconds[:, :, None])[:, :, 0]
    return LinearForm(time_s, base.mass, damping, stiffness, force)


def _slope(left: Callable[[Array], Array], by: Array) -> Array:
    """The derivative along a change of the coefficients at 0, by central differences of two
    steps."""
    far, near = ((left(h * by) - left(-h * by)) / (2.0 * h) for h in (1.0, 0.5))
    return np.asarray((4.0 * near - far) / 3.0)
