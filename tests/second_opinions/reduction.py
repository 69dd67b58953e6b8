"""The inertia of a link as one force, or as two masses: reductions of the problem book.

::

    rotation about A          plane motion                     two masses
    A ---- S ---- K --P-->    P' = -m a_A in S                 m1      m2
                              P'' = -m a_SA in K               A - S - B
    l_AK = l_AS + J/(m l_AS)  both meet in T                   l1   l2

Places are vectors from A in the ground's frame, (T, 2), and forces, masses and couples those of the
link. Source: problem book "Bai tap co hoc may", appendix "Reduction of inertia forces".
"""

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.errors import CrankcheckError


@dataclass(frozen=True)
class Resultant:
    """One force [N] and a place on its line of action [m] from A, (T, 2) each."""

    force: Array
    place: Array


@dataclass(frozen=True)
class TwoMasses:
    """Masses in A and in B [kg], on a line through the centre of mass, and the moment of inertia
    [kg m^2], m (l1 l2 - k^2), that they have more than the link. They are the link where it is 0;
    else the couple ``excess`` times alpha goes with them."""

    first: float
    second: float
    excess: float


def oscillation_length(mass: float, inertia: float, centre_m: float) -> float:
    """The distance l_AK [m] of the centre of oscillation from A, about which the link turns.

    Of m [kg], J about the centre of mass [kg m^2], and its distance l_AS from A [m]. Raises
    CrankcheckError for no mass, or a centre in A: the inertia is a couple then, and no force.
    """
    _check_mass(mass)
    if not centre_m > 0.0:
        raise CrankcheckError(
            f"centre_m is {centre_m:g}: the centre of mass lies in the pivot, so inertia is the "
            "couple -J alpha alone and no force through a centre of oscillation; use that couple"
        )
    return centre_m + inertia / (mass * centre_m)


def rotation(mass: float, inertia: float, centre: Array, omega: Array, alpha: Array) -> Resultant:
    """The inertia of a link that turns about A at rest: -m a_S through the centre of oscillation.

    ``centre`` is the way from A to S [m], (T, 2). Raises CrankcheckError as `oscillation_length`.
    """
    length = math.hypot(*centre[0])
    factor = oscillation_length(mass, inertia, length) / length
    return Resultant(-mass * _turning(centre, omega, alpha), factor * centre)


def plane_motion(
    mass: float, inertia: float, centre: Array, of_a: Array, omega: Array, alpha: Array
) -> Resultant:
    """The inertia of a link in plane motion: -m a_S through the inertia centre T.

    ``centre`` is the way from A to S [m], ``of_a`` the acceleration of A [m/s^2], (T, 2). T is
    where the parallel to a_A through S meets that to a_SA through K. Where the two are parallel it
    is the place on the line SK through which both together go; nowhere (NaN) where they are a
    couple.
    """
    length = math.hypot(*centre[0])
    k = oscillation_length(mass, inertia, length) / length * centre
    of_s = _turning(centre, omega, alpha)
    force, away = -mass * (of_a + of_s), k - centre
    across = _cross(of_a, of_s)
    with np.errstate(divide="ignore", invalid="ignore"):
        # S + u a_A = K + w a_SA, crossed with a_SA.
        crossing = centre + of_a * (_cross(away, of_s) / across)[:, None]
        share = mass * -np.sum(of_s * force, axis=1) / np.sum(force * force, axis=1)
        beside = centre + away * share[:, None]
    return Resultant(force, np.where(across[:, None] == 0.0, beside, crossing))


def two_masses(mass: float, inertia: float, first_m: float, second_m: float) -> TwoMasses:
    """A link as two masses at the distances l1 and l2 [m] from its centre, to either side.

    Raises CrankcheckError for no mass, or a distance that is not above 0.
    """
    _check_mass(mass)
    if not (first_m > 0.0 and second_m > 0.0):
        raise CrankcheckError(
            f"distances {first_m:g} m and {second_m:g} m from the centre of mass: it lies between "
            "the two masses; give distances above 0"
        )
    span = first_m + second_m
    excess = mass * first_m * second_m - inertia
    return TwoMasses(mass * second_m / span, mass * first_m / span, excess)


def _check_mass(mass: float) -> None:
    if not mass > 0.0:
        raise CrankcheckError(f"mass is {mass:g} kg: without mass there is no inertia; give more")


def _turning(arm: Array, omega: Array, alpha: Array) -> Array:
    """The acceleration of the end of an arm that turns about its start."""
    perp = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return np.asarray(alpha[:, None] * perp - omega[:, None] ** 2 * arm)


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
