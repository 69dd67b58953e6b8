"""Numbers of textbooks, and rolling base circles drawn point by point."""

import math

import numpy as np
import pytest

from analytic.gears.involute import (
    TeethPair,
    inverse_involute,
    involute,
    least_shift,
    least_teeth,
)
from models.errors import CrankcheckError
from models.scene.pairs import Gear

A20 = math.radians(20.0)


def pair(z: int, y: int, module: float = 1.0, x: tuple[float, float] = (0.0, 0.0), *,
         internal: bool = False, angle: float = A20) -> TeethPair:  # fmt: skip
    gear = Gear("g", ("a", "b"), (z, y), internal=internal, pressure_angle_rad=angle)
    return TeethPair(gear, module, x)


def test_shigley_example_13_1() -> None:
    """16 and 40 teeth of diametral pitch 2: lengths in inches."""
    teeth = pair(16, 40, 0.5)
    assert teeth.distance_m == pytest.approx(14.0)
    assert teeth.base_radii_m == pytest.approx((3.76, 9.40), abs=5e-3)
    # 1/4 in further apart the pressure angle is 22.56 degrees.
    wide = math.acos(sum(teeth.base_radii_m) / 14.25)
    assert math.degrees(wide) == pytest.approx(22.56, abs=0.05)  # of rounded radii


def test_norton_example_9_1() -> None:
    """19 and 37 teeth of diametral pitch 6: lengths in inches."""
    teeth = pair(19, 37, 1.0 / 6.0)
    assert teeth.distance_m == pytest.approx(4.667, abs=5e-4)
    assert teeth.contact_ratio == pytest.approx(1.62, abs=5e-3)
    assert teeth.contact_ratio * 0.492 == pytest.approx(0.798, abs=1e-3)  # the base pitch
    assert 2 * teeth.tip_radii_m[0] == pytest.approx(3.500, abs=1e-3)


def test_least_teeth_of_norton_table_9_4_and_shigley() -> None:
    """Racks: 32, 18 and 12 teeth of 14.5, 20 and 25 degrees."""
    found = [math.ceil(least_teeth(math.radians(a))) for a in (14.5, 20.0, 25.0)]
    assert found == [32, 18, 12]
    assert least_shift(10, A20) == pytest.approx((17.097 - 10) / 17.097, abs=1e-4)
    assert least_teeth(A20, least_shift(10, A20)) == pytest.approx(10.0)


def test_interference_is_that_of_shigley_13_7() -> None:
    """13 teeth run with 13 to 16, 14 to 26, 15 to 45 and 16 to 101 at 20 degrees, no further."""
    for z, most in ((13, 16), (14, 26), (15, 45), (16, 101)):
        assert not pair(z, most).interferes
        assert pair(z, most + 1).interferes
    assert pair(12, 12).interferes


def test_shifted_pair_of_khk() -> None:
    """12 and 24 teeth of 3 mm, shifts 0.6 and 0.36: 26.0886 degrees, centre distance 56.4999."""
    teeth = pair(12, 24, 3.0, (0.6, 0.36))
    assert math.degrees(teeth.working_angle_rad) == pytest.approx(26.0886, abs=1e-4)
    assert teeth.distance_m == pytest.approx(56.4999, abs=1e-4)


def test_shifted_ring_of_khk() -> None:
    """16 and 24 teeth of 3 mm, shifts 0 and 0.5: 31.0937 degrees, 13.1683 mm apart."""
    teeth = pair(16, 24, 3.0, (0.0, 0.5), internal=True)
    assert math.degrees(teeth.working_angle_rad) == pytest.approx(31.0937, abs=1e-4)
    assert teeth.distance_m == pytest.approx(13.1683, abs=1e-4)


@pytest.mark.parametrize("angle", [1e-3, 0.1, A20, 0.8, 1.3, 1.5])
def test_the_involute_is_inverted(angle: float) -> None:
    assert inverse_involute(involute(angle)) == pytest.approx(angle, rel=1e-9)


@pytest.mark.parametrize("shape", [(20, 33, False, (0.0, 0.0)), (18, 60, False, (0.3, -0.1)),
                                   (20, 60, True, (0.0, 0.0)),
                                   (25, 90, True, (0.2, 0.5))])  # fmt: skip
def test_contact_ratio_is_that_of_flanks_in_contact_along_the_line(
    shape: tuple[int, int, bool, tuple[float, float]],
) -> None:
    """The line of action drawn: its points between the addendum circles, over the base pitch."""
    z, y, internal, x = shape
    teeth = pair(z, y, 1.0, x, internal=internal)
    angle, a = teeth.working_angle_rad, teeth.distance_m
    rb = teeth.base_radii_m[0]
    tangent = rb * np.array([math.cos(angle), math.sin(angle)])
    way = np.array([math.sin(angle), -math.cos(angle)])
    s = np.linspace(0.0, 3.0 * z, 600_001)[:, None]
    points = tangent + s * way
    centre = np.array([a if not internal else -a, 0.0])
    first = np.hypot(*points.T) <= teeth.tip_radii_m[0]
    far = np.hypot(*(points - centre).T)
    second = far >= teeth.tip_radii_m[1] if internal else far <= teeth.tip_radii_m[1]
    length = (first & second).sum() * (s[1, 0] - s[0, 0])
    assert length / (math.pi * math.cos(A20)) == pytest.approx(teeth.contact_ratio, abs=4e-4)


def test_shifted_thicknesses_close_the_working_pitch_circle() -> None:
    """Both tooth thicknesses on the working circles fill one pitch: no backlash."""
    teeth = pair(14, 41, 2.0, (0.35, -0.12))
    whole = 0.0
    for n in (0, 1):
        r, rb = teeth.pitch_radii_m[n], teeth.base_radii_m[n]
        working = rb / math.cos(teeth.working_angle_rad)
        lean = involute(A20) - involute(teeth.working_angle_rad)
        whole += 2.0 * working * (teeth.thicknesses_m[n] / (2.0 * r) + lean)
    pitch = 2.0 * math.pi * teeth.base_radii_m[0] / math.cos(teeth.working_angle_rad) / 14
    assert whole == pytest.approx(pitch, rel=1e-12)


@pytest.mark.parametrize(("teeth", "distance", "message"), [
    (pair(12, 40), None, "gears.g: 12 teeth of a undercut at 20 degrees; 18 or more do not, or a "
     "profile shift of 0.2981 or more"),
    (pair(20, 40, 0.002), 0.061, "the teeth do not mesh at a centre distance of 61 mm; "
     "theirs is 60 mm"),
    (pair(20, 25, internal=True), None, "tips of the ring (5 teeth more) run into the pinion"),
    (pair(13, 40, angle=A20), None, "tips reach below the base circle of the other gear"),
])  # fmt: skip
def test_teeth_that_undercut_or_do_not_mesh_are_refused(
    teeth: TeethPair, distance: float | None, message: str
) -> None:
    with pytest.raises(CrankcheckError) as error:
        teeth.check(distance)
    assert message in str(error.value)


def test_teeth_that_mesh_are_not_refused() -> None:
    for teeth in (pair(18, 40), pair(12, 24, 3.0, (0.6, 0.36)), pair(20, 60, internal=True)):
        teeth.check(teeth.distance_m)
    with pytest.raises(CrankcheckError, match="nearer than their base circles"):
        pair(20, 20, x=(-3.0, -3.0))
