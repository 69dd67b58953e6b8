"""Involute teeth of two spur gears in mesh: circles, contact ratio, shifted profiles, undercut.

::

    inv alpha = tan alpha - alpha            base circle r_b = r cos alpha

       o 0 ---- a ---- 1 o                   working pressure angle a_w, a cos a_w = r_b0 +- r_b1

Lengths are those of the basic rack of ISO 53: addendum 1, dedendum 1.25 modules. Signs of an
internal pair: the ring's teeth count negative in sums, so that one formula serves both. Sources:
Shigley, Mechanical Engineering Design, 13-3 to 13-8; Norton, Design of Machinery, ch. 9; of shifted
profiles and rings, KHK, Gear Technical Reference, ch. 4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.scene.pairs import FITS, Gear

ADDENDUM, DEDENDUM = 1.0, 1.25


def involute(angle_rad: float) -> float:
    """Return inv alpha = tan alpha - alpha [rad]."""
    return math.tan(angle_rad) - angle_rad


def inverse_involute(value: float) -> float:
    """Return the angle alpha >= 0 whose involute is ``value`` >= 0 [rad], to rounding."""
    angle = (3.0 * value) ** (1.0 / 3.0) if value < 1.0 else math.atan(value + 1.5)
    for _ in range(50):  # Newton's method; the derivative is tan^2
        if angle == 0.0:
            return 0.0
        step = (involute(angle) - value) / math.tan(angle) ** 2
        angle -= step
        if abs(step) <= 1e-15 * angle:
            break
    return angle


def least_teeth(pressure_angle_rad: float, shift: float = 0.0) -> float:
    """Return the number of teeth below which a rack undercuts: 2 (1 - x)/sin^2 alpha, 17.1 of 20
    degrees. Source: Shigley, eq. 13-13."""
    return 2.0 * (ADDENDUM - shift) / math.sin(pressure_angle_rad) ** 2


def least_shift(teeth: int, pressure_angle_rad: float) -> float:
    """Return the profile shift, in modules, from which on a rack does not undercut the teeth."""
    return ADDENDUM - 0.5 * teeth * math.sin(pressure_angle_rad) ** 2


@dataclass(frozen=True)
class TeethPair:
    """Teeth of two gears in mesh. ``pair`` has teeth and kind, ``module_m`` is that of the rack,
    ``shifts`` the profile shifts in modules (of a ring positive where its teeth move outwards).

    Arrays (2,) have a value per gear, lengths are in m. Raises CrankcheckError for shifts that no
    centre distance goes with.
    """

    pair: Gear
    module_m: float
    shifts: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if self._working_involute < 0.0:
            raise CrankcheckError(
                f"gears.{self.pair.name}: profile shifts of {self.shifts[0]:g} and "
                f"{self.shifts[1]:g} bring the teeth nearer than their base circles allow; use "
                "larger ones, or more teeth"
            )

    @property
    def _signs(self) -> Array:
        return np.array([1, -1 if self.pair.internal else 1])

    @property
    def pitch_radii_m(self) -> Array:
        """Radii of the pitch circles of generation."""
        return 0.5 * self.module_m * np.array(self.pair.teeth)

    @property
    def base_radii_m(self) -> Array:
        """Radii of the base circles."""
        return self.pitch_radii_m * math.cos(self.pair.pressure_angle_rad)

    def _from_pitch(self, height: float) -> Array:
        return self.pitch_radii_m + (self.shifts + self._signs * height) * self.module_m

    @property
    def tip_radii_m(self) -> Array:
        """Radii of the addendum circles. The tip of a ring is shortened where it would reach the
        pinion below its base circle, as usual."""
        radii = self._from_pitch(ADDENDUM)
        if self.pair.internal:
            radii[1] = max(radii[1], self._ends_m[1])
        return radii

    @property
    def root_radii_m(self) -> Array:
        """Radii of the dedendum circles."""
        return self._from_pitch(-DEDENDUM)

    @property
    def thicknesses_m(self) -> Array:
        """Tooth thicknesses on the pitch circles, as arcs; of a ring that of its tooth."""
        lean = 2.0 * math.tan(self.pair.pressure_angle_rad)
        return (math.pi / 2.0 + self._signs * self.shifts * lean) * self.module_m

    @property
    def _working_involute(self) -> float:
        """Involute of the working pressure angle: inv a + 2 tan a (x0 + x1)/(z0 + z1)."""
        angle, signs = self.pair.pressure_angle_rad, self._signs
        shifted = float(signs @ self.shifts) / (self.pair.teeth[0] + self.pair.second)
        return involute(angle) + 2.0 * math.tan(angle) * shifted

    @cached_property
    def working_angle_rad(self) -> float:
        """Working pressure angle, without backlash."""
        if self.shifts == (0.0, 0.0):
            return self.pair.pressure_angle_rad
        return inverse_involute(self._working_involute)

    @property
    def distance_m(self) -> float:
        """Centre distance without backlash."""
        return abs(float(self._signs @ self.base_radii_m)) / math.cos(self.working_angle_rad)

    @property
    def _line_m(self) -> float:
        """Length of the line of action between the base circles: of a ring, to its own."""
        return self.distance_m * math.sin(self.working_angle_rad)

    @property
    def _ends_m(self) -> Array:
        """Radii at which the line of action ends, on the base circle of the other gear."""
        return np.hypot(self.base_radii_m, self._line_m)

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio: path of contact over the base pitch. Shigley, eq. 13-8."""
        base_pitch_m = math.pi * self.module_m * math.cos(self.pair.pressure_angle_rad)
        first, second = np.sqrt(np.maximum(self.tip_radii_m**2 - self.base_radii_m**2, 0.0))
        # External: e0 + e1 - a sin; internal: e0 - e1 + a sin (KHK, Gear Technical Reference, 4.2).
        return float(first + self._signs[1] * (second - self._line_m)) / base_pitch_m

    @property
    def interferes(self) -> bool:
        """Whether tips run into the other gear: below its base circle, beyond the end of the line
        of action (Shigley, 13-7), or, of a pinion, into those of its ring outside the contact
        (trochoidal interference: too few teeth less; KHK, Gear Technical Reference, 4.2)."""
        if not self.pair.internal:
            return bool((self.tip_radii_m > self._ends_m).any())
        (r0, r1), a = self.tip_radii_m, self.distance_m
        if r1 >= r0 + a:  # the circles of the tips do not cross
            return False
        cosines = (r1**2 - r0**2 - a**2) / (2.0 * a * r0), (a**2 + r1**2 - r0**2) / (2.0 * a * r1)
        if max(map(abs, cosines)) > 1.0:
            return True
        shares = np.minimum(self.base_radii_m / self.tip_radii_m, 1.0)
        own, other = (involute(math.acos(share)) for share in shares)
        inv, ratio = involute(self.working_angle_rad), self.pair.teeth[0] / self.pair.teeth[1]
        first = math.acos(cosines[0]) + own - inv
        return bool(first * ratio + inv - other < math.acos(cosines[1]))

    def check(self, distance_m: float | None = None) -> None:
        """Raise CrankcheckError for teeth that undercut, interfere, lose contact, or do not mesh at
        a centre distance."""
        faults, angle, found = [], self.pair.pressure_angle_rad, self.distance_m
        at = f"{math.degrees(angle):g} degrees"
        own = zip(self.pair.bodies, self.pair.teeth, self.shifts, self._signs, strict=True)
        for body, z, x, sign in own:
            if sign > 0 and x < least_shift(z, angle):
                faults.append(
                    f"{z} teeth of {body} undercut at {at}; {math.ceil(least_teeth(angle, x))} or "
                    f"more do not, or a profile shift of {least_shift(z, angle):.4f} or more"
                )
        if distance_m is not None and abs(distance_m - found) > FITS * found:
            faults.append(
                f"the teeth do not mesh at a centre distance of {1e3 * distance_m:.6g} mm; theirs "
                f"is {1e3 * found:.6g} mm"
            )
        if self.contact_ratio < 1.0:
            faults.append(f"contact ratio {self.contact_ratio:.3g}; teeth in mesh need 1 or more")
        if self.interferes:
            less = self.pair.teeth[1] - self.pair.teeth[0]
            faults.append(
                f"tips of the ring ({less} teeth more) run into the pinion; use more teeth in both "
                "of them, or in the ring"
                if self.pair.internal
                else "tips reach below the base circle of the other gear; use more teeth in the "
                "smaller gear, or shift its profile outwards"
            )
        if faults:
            raise CrankcheckError(f"gears.{self.pair.name}: {'; '.join(faults)}")
