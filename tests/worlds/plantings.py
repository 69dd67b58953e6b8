"""Faults to plant in a log of a scene: what each is, and by which names a cause may tell it.

Each takes a healthy sheet and a generator, and returns the sheet with the fault and the columns
that have it (none for all that the fault reaches); None where the sheet has nothing to plant it in.
"""

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.random import Generator

from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.logs.channel import Channel
from reports.logs.kinds import KINDS, TYPICAL, UNITS
from tests.worlds.sheets import Sheet, wrapped

T = TypeVar("T")
Planted = tuple[Sheet, list[str]] | None
Plant = Callable[[Sheet, Generator], Planted]


@dataclass(frozen=True)
class Planting:
    """How to plant a fault, the names of causes that tell it, and whether it needs even steps."""

    plant: Plant
    names: tuple[str, ...]
    even: bool = False


PLANTINGS: dict[str, Planting] = {}


def planting(*names: str, even: bool = False) -> Callable[[Plant], Plant]:
    """Put a fault into `PLANTINGS` under the name of its function."""

    def put(plant: Plant) -> Plant:
        def planted(sheet: Sheet, rng: Generator) -> Planted:
            try:
                return plant(sheet, rng)
            except NothingError:
                return None

        PLANTINGS[plant.__name__] = Planting(planted, names, even)
        return plant

    return put


class NothingError(Exception):
    """There is nothing in a sheet to plant a fault in."""


def one(rng: Generator, choice: Sequence[T]) -> T:
    if not choice:
        raise NothingError
    return choice[int(rng.integers(len(choice)))]


def either(rng: Generator) -> float:
    return float(rng.choice([-1.0, 1.0]))


def decades(rng: Generator, low: float, high: float) -> float:
    return float(10.0 ** rng.uniform(low, high))


def truth(sheet: Sheet, time_s: Array) -> Motion:
    return solve(sheet.scene, time_s, bound=False)


def size_of(channel: Channel) -> float:
    return UNITS[channel.kind.dimension][channel.unit]


def numbers(sheet: Sheet, column: str) -> Array:
    channel = sheet.channels[column]
    return channel.sign * sheet.values[column] / size_of(channel)


def read(sheet: Sheet, column: str, written: Array) -> Array:
    """What the map makes of numbers that stand in a column."""
    channel = sheet.channels[column]
    return channel.sign * written * size_of(channel)


def of_scene(sheet: Sheet, scene: Scene) -> Planted:
    try:
        return sheet.of(solve(scene, sheet.time_s, bound=False)), []
    except CrankcheckError:
        return None


def exchanged(sheet: Sheet, columns: Sequence[str]) -> Planted:
    others = (*columns[1:], columns[0])
    written = {
        column: read(sheet, column, numbers(sheet, other))
        for column, other in zip(columns, others, strict=True)
    }
    return sheet.put(written), list(columns)


def changed(sheet: Sheet, column: str, change: Callable[[Array], Array]) -> Planted:
    values = wrapped(sheet.channels[column], change(sheet.values[column]))
    return sheet.put({column: values}), [column]


def places(channel: Channel) -> bool:
    return channel.kind.order == 0


def unwrapped(channel: Channel) -> bool:
    return not channel.wrapped


@planting("swapped")
def two_swapped(sheet: Sheet, rng: Generator) -> Planted:
    dimension = {c: sheet.channels[c].kind.dimension for c in sheet.channels}
    moving = sheet.moving()
    pairs = [(a, b) for a in moving for b in moving if a < b and dimension[a] == dimension[b]]
    return exchanged(sheet, one(rng, pairs))


@planting("swapped")
def three_swapped(sheet: Sheet, rng: Generator) -> Planted:
    angles = sheet.moving(lambda channel: channel.kind.turns)
    lengths = sheet.moving(lambda channel: channel.kind.dimension == "length")
    among = angles if len(angles) > 2 else lengths
    if len(among) < 3:
        return None
    return exchanged(sheet, [among[place] for place in rng.permutation(len(among))[:3]])


@planting("swapped")
def rate_and_place_swapped(sheet: Sheet, rng: Generator) -> Planted:
    pairs = [
        (place, rate)
        for place in sheet.moving(places)
        for rate in sheet.moving(lambda channel: channel.kind.order == 1)
        if sheet.channels[place].of == sheet.channels[rate].of
    ]
    return exchanged(sheet, one(rng, pairs))


@planting("misnamed")
def of_another_link(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.moving(lambda channel: channel.kind.body_kind == "link"))
    channel = sheet.channels[column]
    other = one(rng, [link for link in sheet.scene.links if link != channel.of])
    values = replace(channel, of=other).expected(truth(sheet, sheet.time_s))
    return changed(sheet, column, lambda _: values) if np.ptp(values) > 1e-6 else None


@planting("relative")
def of_a_joint(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.moving(lambda c: c.kind.body_kind == "link" and c.kind.order < 2))
    channel = sheet.channels[column]
    other = one(rng, [link for link in sheet.scene.links if link != channel.of])
    values = replace(channel, relative_to=other).expected(truth(sheet, sheet.time_s))
    return changed(sheet, column, lambda _: values)


@planting("kind")
def another_kind(sheet: Sheet, rng: Generator) -> Planted:
    si = ("rad", "rad/s", "m", "m/s")
    column = one(rng, [c for c in sheet.uneven() if sheet.channels[c].unit in si])
    channel = sheet.channels[column]
    kinds = [
        kind
        for kind in KINDS.values()
        if (kind.body_kind, kind.axis) == (channel.kind.body_kind, channel.kind.axis)
        and kind.order != channel.kind.order
    ]
    kind = kinds[int(rng.integers(len(kinds)))]
    values = replace(channel, kind=kind).expected(truth(sheet, sheet.time_s))
    return (sheet.put({column: values}), [column]) if np.ptp(values) > 1e-6 else None


@planting("unit")
def another_unit(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.telling())
    channel = sheet.channels[column]
    units = UNITS[channel.kind.dimension]
    unit = one(rng, [unit for unit in TYPICAL[channel.kind.dimension] if unit != channel.unit])
    return sheet.put({column: sheet.values[column] * units[channel.unit] / units[unit]}), [column]


@planting("sign")
def another_sign(sheet: Sheet, rng: Generator) -> Planted:
    return changed(sheet, one(rng, sheet.moving()), lambda values: -values)


@planting("offset")
def another_zero(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.columns())
    off = sheet.limits[column] * either(rng) * decades(rng, 0.7, 2.5)
    return changed(sheet, column, lambda values: values + off)


@planting("sign")
def another_sign_and_zero(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.moving(places))
    off = sheet.limits[column] * decades(rng, 1.0, 2.5)
    return changed(sheet, column, lambda values: off - values)


@planting("scaled")
def another_gain(sheet: Sheet, rng: Generator) -> Planted:
    gain = 1.0 + either(rng) * decades(rng, -2.0, -0.5)
    return changed(sheet, one(rng, sheet.moving(unwrapped)), lambda values: gain * values)


@planting("delay")
def one_late(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.bending())
    return _later(sheet, column, sheet.step_s * either(rng) * decades(rng, -0.3, 1.2))


@planting("delay")
def one_very_late(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.bending())
    return _later(sheet, column, sheet.scene.driver.law.period_s * rng.uniform(-0.45, 0.45))


def _later(sheet: Sheet, column: str, by_s: float) -> Planted:
    return sheet.of(truth(sheet, sheet.time_s - by_s), [column]), [column]


@planting("delay")
def rates_half_a_sample_late(sheet: Sheet, rng: Generator) -> Planted:
    rates = sheet.bending(lambda channel: channel.kind.order > 0)
    return sheet.of(truth(sheet, sheet.time_s - 0.5 * sheet.step_s), rates), rates


@planting("start")
def all_late(sheet: Sheet, rng: Generator) -> Planted:
    by_s = sheet.step_s * either(rng) * decades(rng, -0.3, 1.5)
    return sheet.of(truth(sheet, sheet.time_s + by_s)), []


@planting("drift")
def slow_clock(sheet: Sheet, rng: Generator) -> Planted:
    pace = 1.0 + either(rng) * decades(rng, -3.0, -1.0)
    return sheet.of(truth(sheet, pace * sheet.time_s)), []


@planting("drift")
def fast_driver(sheet: Sheet, rng: Generator) -> Planted:
    return _driven(sheet, 1.0 + either(rng) * decades(rng, -3.0, -0.3))


@planting("reversed")
def backwards_driver(sheet: Sheet, rng: Generator) -> Planted:
    return _driven(sheet, -1.0)


def _driven(sheet: Sheet, times: float) -> Planted:
    """The sheet of a driver that is so many times as fast."""
    scene, law = sheet.scene, sheet.scene.driver.law
    assert isinstance(law, ConstantSpeed)
    law = replace(law, speed_rad_s=times * law.speed_rad_s)
    return of_scene(sheet, replace(scene, driver=replace(scene.driver, law=law)))


@planting("time unit")
def another_unit_of_time(sheet: Sheet, rng: Generator) -> Planted:
    pairs = [("ms", "s"), ("s", "ms"), ("us", "ms"), ("min", "s"), ("s", "min")]
    unit, told = pairs[int(rng.integers(len(pairs)))]
    ratio = UNITS["time"][told] / UNITS["time"][unit]
    return replace(sheet, time_s=sheet.time_s * ratio, stamp=("t", told)), []


@planting("time stamps", even=True)
def rounded_times(sheet: Sheet, rng: Generator) -> Planted:
    digit = 10.0 ** math.floor(math.log10(0.4 * sheet.step_s))
    return replace(sheet, time_s=np.round(sheet.time_s / digit) * digit), []


@planting("time stamps", even=True)
def shaken_times(sheet: Sheet, rng: Generator) -> Planted:
    shaken = sheet.time_s + sheet.step_s * rng.uniform(-0.3, 0.3, sheet.time_s.size)
    return replace(sheet, time_s=shaken), []


@planting("branch")
def another_assembly(sheet: Sheet, rng: Generator) -> Planted:
    scene = sheet.scene
    keys = [group.branch_key for group in analyse(scene).groups if group.assemblies == 2]
    key = one(rng, keys)
    return of_scene(sheet, replace(scene, branch={**scene.branch, key: -scene.branch.get(key, 1)}))


@planting("length")
def another_length(sheet: Sheet, rng: Generator) -> Planted:
    """A bar of another length, a pivot elsewhere, or the line of a slider beside where it is."""
    scene = sheet.scene
    by = scene.longest_m * either(rng) * decades(rng, -2.0, -1.0)
    choice = [*scene.links, *(pin for pin in scene.ground if pin != scene.driver_pivot)]
    name = one(rng, [*choice, *scene.sliders])
    if name in scene.ground:
        x, y = scene.ground[name]
        place = (x + by, y) if rng.random() < 0.5 else (x, y + by)
        return of_scene(sheet, replace(scene, ground={**scene.ground, name: place}))
    if name in scene.sliders:
        line = scene.sliders[name]
        x, y = line.through_m
        sine, cosine = math.sin(line.direction_rad), math.cos(line.direction_rad)
        line = replace(line, through_m=(x - by * sine, y + by * cosine))
        return of_scene(sheet, replace(scene, sliders={**scene.sliders, name: line}))
    link = scene.links[name]
    first, second = list(link.points)[:2]
    (x0, y0), (x1, y1) = link.points[first], link.points[second]
    longer = 1.0 + by / math.hypot(x1 - x0, y1 - y0)
    place = (x0 + longer * (x1 - x0), y0 + longer * (y1 - y0))
    link = replace(link, points={**link.points, second: place})
    return of_scene(sheet, replace(scene, links={**scene.links, name: link}))


@planting("size")
def all_lengths(sheet: Sheet, rng: Generator) -> Planted:
    columns = sheet.columns(lambda channel: channel.kind.body_kind != "link")
    size = 1.0 + either(rng) * decades(rng, -2.0, -0.5)
    if len(columns) < 2:
        return None
    return sheet.put({column: size * sheet.values[column] for column in columns}), columns


@planting("mirrored")
def from_behind(sheet: Sheet, rng: Generator) -> Planted:
    turn = math.pi if rng.random() < 0.5 else 0.0
    return _seen(sheet, cmath.rect(1.0, turn), mirrored=True)


@planting("turned")
def turned_axes(sheet: Sheet, rng: Generator) -> Planted:
    turns = [0.5 * math.pi, -0.5 * math.pi, math.pi, rng.uniform(0.02, 3.0)]
    return _seen(sheet, cmath.rect(1.0, float(rng.choice(turns))))


@planting("turned")
def points_of_a_tilted_camera(sheet: Sheet, rng: Generator) -> Planted:
    """Points in axes of their own, among them one that does not go round the origin."""
    crank = sheet.scene.links[sheet.scene.driver.link].points
    points = sheet.moving(lambda channel: channel.kind.body_kind == "point")
    if len(points) < 2 or all(sheet.channels[column].of in crank for column in points):
        return None
    turn, frame = either(rng) * decades(rng, -2.3, -0.3), int(rng.integers(3))
    shift = complex(*rng.uniform(0.02, 0.3, 2)) if frame else 0.0
    seen = _seen(sheet, cmath.rect(1.0, turn), shift, mirrored=frame == 2)
    found = sheet.columns(lambda channel: channel.kind.body_kind == "point")
    return seen and (sheet.put({column: seen[0].values[column] for column in found}), found)


@planting("moved", "offset")
def another_origin(sheet: Sheet, rng: Generator) -> Planted:
    return _seen(sheet, 1.0, complex(*rng.uniform(0.02, 0.3, 2)))


def _seen(sheet: Sheet, turn: complex, shift: complex = 0.0, *, mirrored: bool = False) -> Planted:
    """The sheet with the plane of complex numbers mirrored at the real axis, turned and moved."""
    motion, found = truth(sheet, sheet.time_s), {}
    for column, channel in sheet.channels.items():
        kind = channel.kind
        values = kind.of(motion, channel.of)
        if kind.body_kind == "link":
            values = (-values if mirrored else values) + (cmath.phase(turn) if kind.turns else 0.0)
        elif kind.axis is not None:
            both = getattr(motion.points[channel.of], kind.field)
            z = both[:, 0] + (-1j if mirrored else 1j) * both[:, 1]
            z = turn * z + (shift if kind.order == 0 else 0.0)
            values = (z.real, z.imag)[kind.axis]
        found[column] = wrapped(channel, values)
    return sheet.put(found), []


@planting("stuck")
def stuck_sample(sheet: Sheet, rng: Generator) -> Planted:
    steps = {c: np.abs(np.diff(sheet.values[c])) for c in sheet.moving()}
    places = [(c, k) for c in steps for k in np.flatnonzero(steps[c] > 4 * sheet.limits[c])]
    column, place = one(rng, places)
    return _held(sheet, column, int(place) + 1, 1)


@planting("stuck")
def stuck_stretch(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.moving())
    first = int(rng.integers(5, sheet.time_s.size // 2))
    return _held(sheet, column, first, int(rng.integers(10, 60)))


def _held(sheet: Sheet, column: str, first: int, count: int) -> Planted:
    """The sheet where a channel repeats the sample before ``first`` so many times."""
    values = sheet.values[column].copy()
    values[first : first + count] = values[first - 1]
    return sheet.put({column: values}), [column]


@planting("held")
def slow_sensor(sheet: Sheet, rng: Generator) -> Planted:
    every = int(rng.integers(2, 12))
    column = one(rng, sheet.moving(unwrapped))
    return changed(sheet, column, lambda values: np.repeat(values[::every], every)[: values.size])


@planting("spike")
def spikes(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.columns())
    values = sheet.values[column].copy()
    places = np.arange(3, values.size - 3, 7)
    for place in rng.choice(places, int(rng.integers(1, 6)), replace=False):
        values[place] += sheet.limits[column] * either(rng) * decades(rng, 1.0, 2.5)
    return changed(sheet, column, lambda _: values)


@planting("lost turn")
def lost_turn(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.columns(lambda c: c.kind.turns and not c.wrapped))
    values = sheet.values[column].copy()
    values[int(rng.integers(5, values.size - 5)) :] += either(rng) * math.tau
    return sheet.put({column: values}), [column]


@planting("wrapped")
def wrapped_angle(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.moving(lambda c: c.kind.turns and not c.wrapped))
    values = np.remainder(sheet.values[column] + math.pi, math.tau) - math.pi
    return sheet.put({column: values}), [column]


@planting("half turns")
def arc_tangent(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.moving(lambda channel: channel.kind.turns))
    return changed(sheet, column, lambda values: np.arctan(np.tan(values)))


@planting("unsigned")
def magnitude(sheet: Sheet, rng: Generator) -> Planted:
    both = [c for c in sheet.moving() if sheet.signals[c].min() * sheet.signals[c].max() < 0.0]
    column = one(rng, [c for c in both if not sheet.channels[c].kind.turns])
    return changed(sheet, column, np.abs)


@planting("low-pass")
def low_passed(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.bending(unwrapped))
    constant = sheet.step_s * decades(rng, 0.3, math.log10(sheet.time_s.size / 8))
    gains = 1.0 - np.exp(-np.diff(sheet.time_s) / constant)
    values = sheet.values[column].copy()
    for place, gain in enumerate(gains, start=1):
        values[place] = values[place - 1] + gain * (values[place] - values[place - 1])
    return sheet.put({column: values}), [column]


@planting("zero phase")
def low_passed_forth_and_back(sheet: Sheet, rng: Generator) -> Planted:
    from scipy.signal import butter, filtfilt  # type: ignore[import-untyped]  # ships no stubs

    cutoff = 2.0 * sheet.step_s / sheet.scene.driver.law.period_s * decades(rng, 0.3, 1.0)
    if cutoff > 0.8:
        return None
    filter_ = butter(int(rng.integers(1, 5)), cutoff)
    return changed(sheet, one(rng, sheet.uneven()), lambda values: filtfilt(*filter_, values))


@planting("mean", even=True)
def mean_of_both_sides(sheet: Sheet, rng: Generator) -> Planted:
    half = int(rng.integers(3, max(4, sheet.time_s.size // 20)))
    return _averaged(sheet, one(rng, sheet.uneven()), half, half)


@planting("mean", even=True)
def mean_of_the_last(sheet: Sheet, rng: Generator) -> Planted:
    count = int(rng.integers(3, max(4, sheet.time_s.size // 10)))
    return _averaged(sheet, one(rng, sheet.bending(unwrapped)), count - 1, 0)


def _averaged(sheet: Sheet, column: str, before: int, after: int) -> Planted:
    """The sheet with the mean over so many samples before and after each in a column."""
    steps = np.arange(-before, sheet.time_s.size + after) * sheet.step_s
    values = sheet.channels[column].expected(truth(sheet, sheet.time_s[0] + steps))
    count = before + after + 1
    means = np.convolve(values, np.full(count, 1.0 / count), mode="valid")
    return sheet.put({column: means}), [column]


@planting("rounded")
def few_decimals(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.moving())
    size = size_of(sheet.channels[column])
    decimals = math.floor(-math.log10(8.0 * sheet.limits[column] / size))
    written = np.round(numbers(sheet, column), decimals)
    return sheet.put({column: read(sheet, column, written)}), [column]


@planting("quantised")
def few_steps_a_turn(sheet: Sheet, rng: Generator) -> Planted:
    """An angle by an encoder, or another place by a converter, of so many bits."""
    column = one(rng, sheet.moving(places))
    whole = math.tau if sheet.channels[column].kind.turns else np.ptp(sheet.values[column])
    step = whole / 2.0 ** math.floor(math.log2(whole / (8.0 * sheet.limits[column])))
    zero, to = float(rng.choice([0.0, rng.uniform(-1.0, 1.0)])), one(rng, (np.floor, np.round))
    return changed(sheet, column, lambda values: zero + step * to((values - zero) / step))


@planting("quantised", even=True)
def rate_of_counts(sheet: Sheet, rng: Generator) -> Planted:
    """A rate by differences of the counts of an encoder."""
    column = one(rng, sheet.moving(lambda c: c.kind.body_kind == "link" and c.kind.order == 1))
    step = 8.0 * sheet.limits[column] * sheet.step_s
    step = math.tau / 2.0 ** math.floor(math.log2(math.tau / step))
    angle = replace(sheet.channels[column], kind=KINDS["link", "angle"], wrapped=False)
    instants = np.append(sheet.time_s, sheet.time_s[-1] + sheet.step_s) - 0.5 * sheet.step_s
    counts = np.floor(angle.expected(truth(sheet, instants)) / step)
    return changed(sheet, column, lambda _: np.diff(counts) * (step / sheet.step_s))


@planting("float16")
def half_precision(sheet: Sheet, rng: Generator) -> Planted:
    halves = {
        column: read(sheet, column, numbers(sheet, column).astype(np.float16).astype(float))
        for column in sheet.moving(unwrapped)
    }
    off = {
        c: np.max(np.abs(half - sheet.values[c])) / sheet.limits[c] for c, half in halves.items()
    }
    column = one(rng, [column for column, share in off.items() if share > 3.5])
    return changed(sheet, column, lambda _: halves[column])


@planting("lost rows", even=True)
def rows_lost(sheet: Sheet, rng: Generator) -> Planted:
    """Rows lost at up to three places, and the times of the others closed up."""
    rows = sheet.time_s.size
    lost = np.zeros(rows)
    for place in rng.choice(np.arange(10, rows - 10, 30), int(rng.integers(1, 4)), replace=False):
        lost[place:] += rng.integers(1, 20)
    return sheet.of(truth(sheet, sheet.time_s + sheet.step_s * lost)), []


@planting()
def healthy(sheet: Sheet, rng: Generator) -> Planted:
    return sheet, []


@planting()
def noise(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.columns())
    off = 20.0 * sheet.limits[column] * rng.normal(size=sheet.time_s.size)
    return changed(sheet, column, lambda values: values + off)


@planting()
def wandering(sheet: Sheet, rng: Generator) -> Planted:
    column = one(rng, sheet.columns())
    walk = np.cumsum(rng.normal(size=sheet.time_s.size))
    off = 20.0 * sheet.limits[column] * walk / np.max(np.abs(walk))
    return changed(sheet, column, lambda values: values + off)


@planting()
def waves_of_no_mechanism(sheet: Sheet, rng: Generator) -> Planted:
    turns = math.tau * sheet.time_s / sheet.scene.driver.law.period_s
    columns = [column for column in sheet.columns() if rng.random() < 0.5]
    waves: Mapping[str, Array] = {
        column: 10.0 * sheet.limits[column] * sum(
            rng.normal() / k * np.sin(rng.uniform(0.3, 6.0) * turns + rng.uniform(0.0, 6.0))
            for k in range(1, 5)
        )
        for column in columns
    }  # fmt: skip
    off = {column: sheet.values[column] + wave for column, wave in waves.items()}
    return sheet.put(off), columns
