"""Facts of the theory of machines on a mechanism as a whole, in lines to be read."""

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from analytic.kinematics import reach
from analytic.mechanism.cycle import Along, ExtremeSpeed, Output, Travel, extreme_speeds, travels
from analytic.mechanism.fourbar import FourBar
from analytic.structure.mobility import Structure
from models.errors import CrankcheckError, StructureError
from models.scene import Scene
from models.scene.driver import Controlled, Released, passing
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from reports.protocol.way import way_of

FULL_TURN = math.tau - 1e-9


def facts(scene: Scene, structure: Structure, along: Sequence[Along] = ()) -> list[str]:
    """Return Grashof class and transmission angles of a four-bar; the driver's range where it
    cannot turn fully; swing or stroke and time ratio of every link and slider, and of points along
    directions, between their limit positions."""
    lines = []
    kinds = [group.kind for group in structure.groups]
    if scene.driver.is_crank and kinds == ["RRR"] and not structure.triads:
        with contextlib.suppress(StructureError):  # two links that stand still, or turn as one
            lines.append(_grashof(FourBar.of(scene)))
    spans = reach(scene)
    if scene.driver.slider is not None:
        words = " and ".join(f"{a:.6g} to {b:.6g} m" for a, b in spans)
        lines.append(f"{scene.driver.joint} can stand at {words}")
    elif sum(end - start for start, end in spans) < FULL_TURN:
        words = " and ".join(f"{_deg(a)} to {_deg(b)} deg" for a, b in spans)
        lines.append(f"{scene.driver.joint} can stand at {words}")
    return lines + list(_travels(scene, along))


@dataclass(frozen=True)
class SpeedFacts:
    """Extreme speeds: a title, and the words for each output, by its name."""

    title: str
    rows: Mapping[str, str]


def speed_facts(
    scene: Scene, along: Sequence[Along] = (), *, clockwise: bool = False
) -> SpeedFacts | None:
    """Return the largest and smallest speeds of links, sliders and points along directions, at the
    driver's angles at which they have no acceleration; None where a cycle of the mechanism has
    none. ``clockwise`` reverses a driver of one speed, as in `models.scene.driver`."""
    try:
        every = extreme_speeds(scene, _outputs(scene, along))
    except CrankcheckError:
        return None  # it does not turn fully, or passes a singular position
    pace = _pace(scene.driver.law, clockwise=clockwise)
    slides = scene.driver.slider is not None
    rows = {
        _called(output): ", ".join(
            _speed(one, pace, _turns(scene, output), slides) for one in found
        )
        for output, found in every.items()
        if found and not _is_driver(scene, output)
    }
    return SpeedFacts(f"extreme speeds{pace.words}, where the acceleration is 0", rows)


@dataclass(frozen=True)
class _Pace:
    """Factor on speeds by the driver's phase, its words, and their units."""

    factor: float
    words: str
    units: tuple[str, str] = (" rad/s", " m/s")


def _pace(law: Law, *, clockwise: bool) -> _Pace:
    if isinstance(law, ConstantSpeed | FromRest):
        speed = -abs(law.speed_rad_s) if clockwise else law.speed_rad_s
        return _Pace(speed, f", driver at {speed:g} rad/s")
    if isinstance(law, Oscillating):
        return _Pace(abs(law.frequency_rad_s), "")
    return _Pace(1.0, " over that of a driver of constant speed", ("", " m"))


def _speed(one: ExtremeSpeed, pace: _Pace, turns: bool, slides: bool) -> str:
    unit = pace.units[0 if turns else 1]
    where = f"{one.driver_rad:.6g} m" if slides else f"{_deg(one.driver_rad)} deg"
    return f"{one.rate * pace.factor:.6g}{unit} at {where}"


def _grashof(bar: FourBar) -> str:
    low, high = bar.transmission_rad
    rocks = bar.grashof_class == "crank-rocker" and bar.driver > bar.rocker
    driven = " driven at its rocker" if rocks else ""
    return (
        f"{bar.grashof_class}{driven} (s + l - p - q = {bar.excess_m:.6g} m), "
        f"transmission angle {_deg(low)} to {_deg(high)} deg"
    )


def _travels(scene: Scene, along: Sequence[Along]) -> Iterator[str]:
    """Yield one line per output that goes back and forth, and per requested point."""
    try:
        every = travels(scene, _outputs(scene, along))
    except CrankcheckError:
        why = "the driver goes through no whole cycle, or a singular position lies in it"
        yield from (f"{_called(one)}: no stroke: {why}" for one in dict.fromkeys(along))
        return
    for output, travel in every.items():
        if isinstance(output, Along) and not isinstance(travel, Travel):
            yield f"{_called(output)}: does not move"  # a motion along a line turns back on it
        if not isinstance(travel, Travel) or _is_driver(scene, output):
            continue  # it turns fully, stands still, or is described as the driver
        turns = _turns(scene, output)
        size = f"{_deg(travel.stroke)} deg" if turns else f"{travel.stroke:.6g} m"
        line = f"{_called(output)}: {'swing' if turns else 'stroke'} {size}"
        line += f", time ratio {travel.time_ratio:.6g}"
        yield line + (f", turns back {travel.limits} times" if travel.limits > 2 else "")


def _is_driver(scene: Scene, output: Output) -> bool:
    driver = scene.driver
    return output == (driver.link if driver.is_crank else driver.slider)


def _outputs(scene: Scene, along: Sequence[Along]) -> list[Output]:
    return [*scene.links, *scene.sliders, *along]


def _turns(scene: Scene, output: Output) -> bool:
    return isinstance(output, str) and output in scene.links


def _called(output: Output) -> str:
    if isinstance(output, str):
        return output
    return f"{output.point} along {_deg(output.direction_rad)} deg"


def _deg(angle_rad: float) -> str:
    """Return degrees to six digits; a value below the rounding of a turn is 0."""
    return f"{round(math.degrees(angle_rad), 9) + 0.0:.6g}"


def describe_law(scene: Scene) -> str:
    """Return the driver's law in a few words."""
    law, slides = scene.driver.law, scene.driver.slider is not None
    unit = "m" if slides else "rad"

    def place(value: float) -> str:
        return f"{value:g}" if slides else f"{math.degrees(value):g}"

    where = "m" if slides else "deg"
    if isinstance(law, Controlled):
        return (
            f"controlled to {law.speed_rad_s:g} rad/s from {math.degrees(law.start_rad):g} deg, by "
            f"kP = {law.kp_n_m_rad:g} N m/rad and kD = {law.kd_n_m_s:g} N m s/rad"
        )
    if isinstance(law, ConstantSpeed):
        return f"{law.speed_rad_s:g} {unit}/s from {place(law.start_rad)} {where}"
    if isinstance(law, Accelerating):
        return (
            f"{law.speed_rad_s:g} {unit}/s and {law.acceleration_rad_s2:g} {unit}/s^2 from "
            f"{place(law.start_rad)} {where}"
        )
    if isinstance(law, FromRest):
        return f"from rest to {law.speed_rad_s:g} {unit}/s in {law.rise_s:g} s"
    if isinstance(law, Oscillating):
        centre, swing = place(law.centre_rad), place(abs(law.amplitude_rad))
        return f"swings {centre} +- {swing} {where} at {law.frequency_rad_s:g} rad/s"
    if isinstance(law, Released):
        speed = f"at {law.speed_rad_s:g} {unit}/s" if law.speed_rad_s else "at rest"
        return f"released {speed} at {place(law.start_rad)} {where}, for {law.duration_s:g} s"
    return type(law).__name__


MOST_DEG = 1e6
"""Largest angle: beyond it too few digits of the angle within a turn are left."""


def angle_at(at_deg: float) -> float:
    """Return a user's angle [rad]. Raises CrankcheckError for an invalid one."""
    if not abs(at_deg) <= MOST_DEG:
        raise CrankcheckError(
            f"--at-deg {at_deg:g}: give an angle in degrees, such as 90, up to {MOST_DEG:g}"
        )
    return math.radians(at_deg)


def time_at(scene: Scene, at_s: float) -> float:
    """Return a user's time [s]. Raises CrankcheckError if invalid, or outside the motion."""
    latest = way_of(scene).latest_s(scene)
    if not 0.0 <= at_s <= latest:  # or no number
        raise CrankcheckError(
            f"--at-s {at_s:g}: {scene.name} moves from t = 0 on; give a time in seconds, such as "
            f"{0.25 * scene.driver.law.period_s:.3g}, up to {latest:.3g}"
        )
    return at_s


def place_at(scene: Scene, at_deg: float | None, at_m: float | None) -> float:
    """Return the requested place of the driver: an angle [rad] given in degrees, or a slider's
    displacement [m]. Raises CrankcheckError for an invalid one, or not the driver's."""
    if at_deg is not None and at_m is not None:
        raise CrankcheckError("--at-deg and --at-m: the driver stands at one place; give one")
    slides = scene.driver.slider is not None
    if at_m is not None:
        if not slides:
            raise CrankcheckError(
                f"--at-m: the driver of {scene.name} is {scene.driver.joint}, which turns; give "
                "its angle by --at-deg"
            )
        if not math.isfinite(at_m):
            raise CrankcheckError(f"--at-m {at_m:g}: give a displacement in metres")
        return at_m
    assert at_deg is not None
    theta = angle_at(at_deg)
    if slides:
        raise CrankcheckError(
            f"--at-deg {at_deg:g}: the driver of {scene.name} is {scene.driver.joint}, which has "
            "no angle; give its displacement by --at-m"
        )
    return theta


def driver_at(
    scene: Scene, at_deg: float | None, at_m: float | None = None, *, clockwise: bool = False
) -> tuple[float, float, float]:
    """Return place [rad or m], speed and acceleration as the driver's law moves it through an angle
    [deg] or a displacement [m]. Raises CrankcheckError for a place that it never has."""
    place = place_at(scene, at_deg, at_m)
    asked = f"--at-deg {at_deg:g}" if at_m is None else f"--at-m {at_m:g}"
    if clockwise and at_m is not None:
        raise CrankcheckError(
            f"{asked} --clockwise: {scene.driver.joint} does not turn; leave it out"
        )
    try:
        speed, rate = passing(scene.driver.law, place, clockwise=clockwise, slides=at_m is not None)
    except ValueError as error:
        raise CrankcheckError(f"{asked}: the driver of {scene.name} {error}") from None
    return place, speed, rate
