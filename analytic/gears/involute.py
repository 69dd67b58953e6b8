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

    All tuples have a value per gear, lengths in m. Raises CrankcheckError for shifts that no centre
    distance goes with.
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
    def _signs(self) -> tuple[int, int]:
        return 1, -1 if self.pair.internal else 1

    @property
    def pitch_m(self) -> float:
        """Pitch along the pitch circle."""
        return math.pi * self.module_m

    @property
    def base_pitch_m(self) -> float:
        """Pitch along the line of action."""
        return self.pitch_m * math.cos(self.pair.pressure_angle_rad)

    @property
    def pitch_radii_m(self) -> tuple[float, float]:
        """Radii of the pitch circles of generation."""
        first, second = self.pair.teeth
        return 0.5 * self.module_m * first, 0.5 * self.module_m * second

    @property
    def base_radii_m(self) -> tuple[float, float]:
        """Radii of the base circles."""
        c = math.cos(self.pair.pressure_angle_rad)
        return self.pitch_radii_m[0] * c, self.pitch_radii_m[1] * c

    def _from_pitch(self, height: float) -> tuple[float, float]:
        radii = zip(self.pitch_radii_m, self.shifts, self._signs, strict=True)
        first, second = (r + (x + s * height) * self.module_m for r, x, s in radii)
        return first, second

    @property
    def tip_radii_m(self) -> tuple[float, float]:
        """Radii of the addendum circles. The tip of a ring is shortened where it would reach the
        pinion below its base circle, as usual."""
        first, second = self._from_pitch(ADDENDUM)
        if self.pair.internal:
            second = max(second, math.hypot(self.base_radii_m[1], self._line_m))
        return first, second

    @property
    def root_radii_m(self) -> tuple[float, float]:
        """Radii of the dedendum circles."""
        return self._from_pitch(-DEDENDUM)

    @property
    def thicknesses_m(self) -> tuple[float, float]:
        """Tooth thicknesses on the pitch circles, as arcs; of a ring that of its tooth."""
        lean = 2.0 * math.tan(self.pair.pressure_angle_rad)
        first, second = (
            (math.pi / 2.0 + s * x * lean) * self.module_m
            for x, s in zip(self.shifts, self._signs, strict=True)
        )
        return first, second

    @property
    def _working_involute(self) -> float:
        """Involute of the working pressure angle: inv a + 2 tan a (x0 + x1)/(z0 + z1)."""
        angle, s = self.pair.pressure_angle_rad, self._signs[1]
        shifted = (self.shifts[0] + s * self.shifts[1]) / (self.pair.teeth[0] + self.pair.second)
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
        first, second = self.base_radii_m
        return abs(first + self._signs[1] * second) / math.cos(self.working_angle_rad)

    @property
    def _line_m(self) -> float:
        """Length of the line of action between the base circles: of a ring, to its own."""
        return self.distance_m * math.sin(self.working_angle_rad)

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio: path of contact over the base pitch. Shigley, eq. 13-8."""
        ends = [
            math.sqrt(max(ra * ra - rb * rb, 0.0))
            for ra, rb in zip(self.tip_radii_m, self.base_radii_m, strict=True)
        ]
        # External: e0 + e1 - a sin; internal: e0 - e1 + a sin (KHK, Gear Technical Reference, 4.2).
        return (ends[0] + self._signs[1] * (ends[1] - self._line_m)) / self.base_pitch_m

    @property
    def interferes(self) -> tuple[bool, bool]:
        """True by gear whose tip reaches the flank of the other below its base circle, beyond the
        end of the line of action (Shigley, 13-7); never of a ring, whose tip is shortened."""
        if self.pair.internal:
            return False, False
        limits = [math.hypot(base, self._line_m) for base in self.base_radii_m]
        return self.tip_radii_m[0] > limits[0], self.tip_radii_m[1] > limits[1]

    @property
    def tips_collide(self) -> bool:
        """True if tips of a pinion run into those of its ring outside the contact (trochoidal
        interference: too few teeth less). Source: KHK, Gear Technical Reference, 4.2."""
        if not self.pair.internal:
            return False
        (r0, r1), a = self.tip_radii_m, self.distance_m
        if r1 >= r0 + a:  # the circles of the tips do not cross
            return False
        cosines = (r1**2 - r0**2 - a**2) / (2.0 * a * r0), (a**2 + r1**2 - r0**2) / (2.0 * a * r1)
        if max(map(abs, cosines)) > 1.0:
            return True
        own, other = (
            involute(math.acos(min(base / tip, 1.0)))
            for base, tip in zip(self.base_radii_m, self.tip_radii_m, strict=True)
        )
        inv, ratio = involute(self.working_angle_rad), self.pair.teeth[0] / self.pair.teeth[1]
        first = math.acos(cosines[0]) + own - inv
        return first * ratio + inv - other < math.acos(cosines[1])

    def check(self, distance_m: float | None = None) -> None:
        """Raise CrankcheckError for teeth that undercut, interfere, lose contact, or do not mesh at
        a centre distance."""
        if faults := list(self._faults(distance_m)):
            raise CrankcheckError(f"gears.{self.pair.name}: {'; '.join(faults)}")

    def _faults(self, distance_m: float | None) -> list[str]:
        faults, angle, found = [], self.pair.pressure_angle_rad, self.distance_m
        at = f"{math.degrees(angle):g} degrees"
        for body, z, x, s in zip(
            self.pair.bodies, self.pair.teeth, self.shifts, self._signs, strict=True
        ):
            if s > 0 and x < least_shift(z, angle):
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
        if any(self.interferes) or self.tips_collide:
            less = self.pair.teeth[1] - self.pair.teeth[0]
            faults.append(
                f"tips of the ring ({less} teeth more) run into the pinion; use more teeth in both "
                "of them, or in the ring"
                if self.pair.internal
                else "tips reach below the base circle of the other gear; use more teeth in the "
                "smaller gear, or shift its profile outwards"
            )
        return faults
