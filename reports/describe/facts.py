"""What the theory of machines says of a mechanism as a whole, in lines to be read."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from analytic.kinematics import reach
from analytic.mechanism.cycle import Along, Output
from analytic.mechanism.fourbar import FourBar
from analytic.mechanism.travel import ExtremeSpeed, Travel, extreme_speeds, travels
from analytic.structure.mobility import Structure
from models.errors import CrankcheckError, StructureError
from models.laws import ConstantSpeed, FromRest, Law, Oscillating
from models.scene import Scene

FULL_TURN = math.tau - 1e-9


def facts(scene: Scene, structure: Structure, along: Sequence[Along] = ()) -> list[str]:
    """Grashof class and transmission angles of a four-bar; the driver's range where it cannot turn
    fully; swing or stroke and time ratio of every link and slider, and of points along directions,
    between their limit positions."""
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
    """Extreme speeds: a title, and what each output has, by the name that it is called by."""

    title: str
    rows: Mapping[str, str]


def speed_facts(
    scene: Scene, along: Sequence[Along] = (), *, clockwise: bool = False
) -> SpeedFacts | None:
    """The largest and smallest speeds of links, sliders and points along directions, at the
    driver's angles at which they have no acceleration; None where a cycle of the mechanism has
    none. ``clockwise`` turns a driver of one speed round, as in `models.driver`."""
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
    """What speeds by the driver's phase are multiplied with, how that is said, and their units."""

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
    """One line per output that goes back and forth, and per point that was asked for."""
    try:
        every = travels(scene, _outputs(scene, along))
    except CrankcheckError:
        why = "the driver goes through no whole cycle, or a singular position lies in it"
        yield from (f"{_called(one)}: no stroke: {why}" for one in dict.fromkeys(along))
        return
    for output, travel in every.items():
        if isinstance(output, Along) and not isinstance(travel, Travel):
            yield f"{_called(output)}: does not move"  # what moves along a line turns back on it
        if not isinstance(travel, Travel) or _is_driver(scene, output):
            continue  # it turns fully, stands still, or is told of as the driver
        turns = _turns(scene, output)
        size = f"{_deg(travel.stroke)} deg" if turns else f"{travel.stroke:.6g} m"
        line = f"{_called(output)}: {'swing' if turns else 'stroke'} {size}"
        line += f", time ratio {travel.time_ratio:.6g}"
        yield line + (f", turns back {travel.limits} times" if travel.limits > 2 else "")


def _is_driver(scene: Scene, output: Output) -> bool:
    """Whether it is told of as the driver."""
    driver = scene.driver
    return output == (driver.link if driver.is_crank else driver.slider)


def _outputs(scene: Scene, along: Sequence[Along]) -> list[Output]:
    return [*scene.links, *scene.sliders, *along]


def _turns(scene: Scene, output: Output) -> bool:
    """Whether its place is an angle."""
    return isinstance(output, str) and output in scene.links


def _called(output: Output) -> str:
    if isinstance(output, str):
        return output
    return f"{output.point} along {_deg(output.direction_rad)} deg"


def _deg(angle_rad: float) -> str:
    """To six digits; what is less than rounding of a turn is 0."""
    return f"{round(math.degrees(angle_rad), 9) + 0.0:.6g}"
