"""A family of mechanisms that differ in one number, side by side in one table of formulas."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from analytic.kinematics import driven_chunk, repeats_after, solve
from analytic.structure.mobility import refuse_other_than_cranked
from models.array import Array
from models.errors import CrankcheckError, ReachError, suggestion
from models.motion import Motion
from models.scene import GROUND, Scene, span
from models.scene.laws import ConstantSpeed
from reports.lectures.drawing.workbook.formulas import (
    ASSEMBLED,
    NAME,
    STATE,
    Column,
    FormulaTable,
    Input,
    evaluated,
)
from reports.output.numbers import readable

MOST_MEMBERS = 20
CLOSE_DEG = 0.1
"""Largest step of the crank between two tried positions."""
SHARED = ("n", "time", "phi")
"""Columns of the drive, which all members share, unless they differ in its speed."""
OF_ROWS = ("start_deg", "step_deg")
"""Inputs that define the rows alone, and nothing of the mechanism."""


def varied(table: FormulaTable, name: str, values: Sequence[float]) -> Input:
    """The input that members differ in, by its name or by the link whose length it is.

    Raises CrankcheckError for an unknown name; too few, too many or equal values; one out of range.
    """
    inputs = [each for each in table.inputs if each.name not in OF_ROWS]
    one = next((each for each in inputs if name and name in (each.name, each.link)), None)
    if one is None:
        names = [*(i.name for i in inputs), *(i.link for i in inputs if i.link)]
        raise CrankcheckError(f"--family {name}: {suggestion(name, names, 'it has')}")
    check_values(name, values)
    wrong = next((value for value in values if not one.allows(value)), None)
    if wrong is not None:
        raise CrankcheckError(
            f"--family {name}={wrong:g}: {one.told}; give numbers that are {one.range}"
        )
    return one


def check_values(name: str, values: Sequence[float]) -> None:
    """Refuse too few, too many and equal values. Raises CrankcheckError."""
    if not 1 < len(values) <= MOST_MEMBERS:
        raise CrankcheckError(
            f"--family {name}: {len(values)} values; give 2 to {MOST_MEMBERS}, such as "
            f"{name}=3.5,2.5"
        )
    twice = next((value for k, value in enumerate(values) if value in values[:k]), None)
    if twice is not None:
        raise CrankcheckError(f"--family {name}: {twice:g} is given twice; give it once")


def member_columns(
    table: FormulaTable, one: Input, values: Sequence[float], asked: str
) -> list[dict[str, Array]]:
    """The columns of each member, (rows,). Raises CrankcheckError for a member without position or
    rates somewhere on the path of the crank; ``asked`` is the user's name for ``one``."""
    found = []
    for value in values:
        member = table.with_input(one, value=value)
        _check_way(member, asked, value)
        found.append(evaluated(member))
    return found


def _check_way(member: FormulaTable, name: str, value: float) -> None:
    """Refuse a member that the crank can not be brought all the way with: between rows, too."""
    (step,) = (each for each in member.inputs if each.name == "step_deg")
    way_deg = min(step.value * (member.count - 1), 360.0)
    count = math.ceil(way_deg / CLOSE_DEG)
    closely = replace(member.with_input(step, value=way_deg / count), count=count + 1)
    columns = evaluated(closely)
    wrong = columns[STATE] != ASSEMBLED
    if wrong.any():
        at = int(np.argmax(wrong))
        why = "cannot be assembled"
        if columns[STATE][at] != why:
            why = "has no determined rates"
        raise CrankcheckError(
            f"--family {name}={value:g}: this member {why} with its crank at "
            f"{np.degrees(columns['phi'][at]):.4g} deg; leave it out, or choose another {name}"
        )


def family(table: FormulaTable, name: str, values: Sequence[float]) -> FormulaTable:
    """The table with a group of columns for each value of the input ``name``. Raises
    CrankcheckError as `varied` and `member_columns`."""
    one = varied(table, name, values)
    member_columns(table, one, values, name)
    shared = SHARED[:1] if one.name == "omega" else SHARED
    members = range(1, len(values) + 1)
    inputs = [each for each in table.inputs if each is not one]
    inputs[:0] = [
        replace(one, name=f"{one.name}_{k}", value=value, told=f"{one.told}, member {k}")
        for k, value in zip(members, values, strict=True)
    ]
    own = [column for column in table.columns if column.name not in shared]
    columns = [column for column in table.columns if column.name in shared]
    columns += [_of_member(column, one.name, k, shared) for k in members for column in own]
    charts = {
        title: [f"{column}_{k}" for k in members for column in drawn]
        for title, drawn in table.charts.items()
    }
    return FormulaTable(inputs, columns, table.count, charts)


def _of_member(column: Column, name: str, k: int, shared: Sequence[str]) -> Column:
    """A column of the member ``k``, with the member's own inputs and columns in its formula."""

    def own(formula: str) -> str:
        return NAME.sub(
            lambda m: (
                f"{{{m[1]}_{k}}}" if m[1] == name
                else m[0] if m[1] or m[2] in shared
                else f"[{m[2]}_{k}{m[3] or ''}]"
            ),
            formula,
        )  # fmt: skip

    first = None if column.first is None else own(column.first)
    head = f'="{column.head}, {name} = "&{{{name}_{k}}}'
    return Column(f"{column.name}_{k}", head, own(column.formula), first)


KINDS = ("position", "velocity", "acceleration")


@dataclass(frozen=True)
class FamilyChart:
    """One quantity of all members: its ``kind``, its name with its unit, and a curve a member."""

    kind: str
    label: str
    curves: Sequence[Array]


@dataclass(frozen=True)
class FamilyCurves:
    """The charts of a family whose members differ in ``name``; ``angles_deg`` are the crank's,
    (rows,) for each member, and ``charts`` are in order of kind, as many of each."""

    name: str
    unit: str
    values: Sequence[float]
    angles_deg: Sequence[Array]
    charts: Sequence[FamilyChart]

    @property
    def members(self) -> list[str]:
        """The names of the members: L = 3.5 m."""
        return [f"{self.name} = {readable(v, 6)} {self.unit}".rstrip() for v in self.values]

    def of_kind(self, kind: str) -> list[FamilyChart]:
        """The charts of a kind."""
        return [chart for chart in self.charts if chart.kind == kind]


def family_curves(table: FormulaTable, name: str, values: Sequence[float]) -> FamilyCurves:
    """The curves of a family of formulas. Raises CrankcheckError as `family`."""
    one = varied(table, name, values)
    members = member_columns(table, one, values, name)
    heads = {each.name: each.head for each in table.columns}
    charts = [
        FamilyChart(kind, with_unit(heads[column]), [member[column] for member in members])
        for kind, columns in zip(KINDS, table.charts.values(), strict=True)
        for column in columns
    ]
    angles = [np.degrees(member["phi"]) for member in members]
    return FamilyCurves(one.name, one.unit, values, angles, charts)


def with_unit(head: str) -> str:
    """The label X' [m/s] of a head X' m/s."""
    words, _, unit = head.rpartition(" ")
    return f"{words} [{unit.replace('^2', '²')}]"


def extremes(curves: FamilyCurves) -> list[Mapping[str, object]]:
    """Each member with the smallest and the largest of each chart, and the crank's angles there."""
    rows: list[Mapping[str, object]] = []
    for k, (member, angle) in enumerate(zip(curves.members, curves.angles_deg, strict=True)):
        own = [chart.curves[k] for chart in curves.charts]
        ends = [(curve, at) for curve in own for at in (np.argmin(curve), np.argmax(curve))]
        cells = [(float(curve[at]), float(angle[at])) for curve, at in ends]
        rows.append({"member": member, "cells": cells})
    return rows


OMEGA = "omega"
AXES = ("x", "y")
CLOSE_RAD = math.radians(CLOSE_DEG)
MOST_CLOSE = 20_000
"""Most instants at which the law of a driver is sampled for its range."""


@dataclass(frozen=True)
class SceneFamily:
    """The motions of scenes that differ in ``name``, each over the same share of its period."""

    scene: Scene
    name: str
    unit: str
    values: Sequence[float]
    motions: Sequence[Motion]


def scene_family(scene: Scene, name: str, values: Sequence[float], time_s: Array) -> SceneFamily:
    """The members over the instants of the ``scene``; each has its own where they differ in speed.

    Raises CrankcheckError for a driver that is no crank, for a name that the scene has not, and for
    a member that can not be assembled.
    """
    refuse_other_than_cranked(scene, "--family")
    check_values(name, values)
    turns = time_s / scene.driver.law.period_s
    motions = []
    members = [varied_scene(scene, name, value) for value in values]
    for value, member in zip(values, members, strict=True):
        own_s = turns * member.driver.law.period_s
        try:
            _close_all_the_way(member, own_s)
            motions.append(solve(member, own_s, bound=False))
        except ReachError as error:
            raise CrankcheckError(
                f"--family {name}={value:g}: this member cannot be assembled: {error}"
            ) from None
    return SceneFamily(scene, name, "rad/s" if name == OMEGA else "m", values, motions)


def _close_all_the_way(member: Scene, time_s: Array) -> None:
    """Assemble a member at small steps of its driver: between instants, too. Raises ReachError."""
    count = math.ceil(float(time_s[-1]) * member.driver.law.peak_speed_rad_s / CLOSE_RAD)
    angles = member.driver.law.at(np.linspace(0.0, time_s[-1], min(count, MOST_CLOSE) + 1))[0]
    low, high = float(angles.min()), float(angles.max())
    way = min(high - low, repeats_after(member))
    theta = np.linspace(low, low + way, math.ceil(way / CLOSE_RAD) + 1)
    driven_chunk(member, theta, np.ones_like(theta))


def varied_scene(scene: Scene, name: str, value: float) -> Scene:
    """The scene with the length of a link of two points, a coordinate of a pin on the ground, or
    the speed of its driver set to ``value`` [m, rad/s]. Raises CrankcheckError."""
    law = scene.driver.law
    pin, _, axis = name.partition(".")
    if name in scene.links and len(scene.links[name].points) == 2:
        if value <= 0.0:
            raise CrankcheckError(f"--family {name}={value:g}: a length; give numbers above 0")
        link = scene.links[name]
        factor = value / span(link.points)
        points = {each: (factor * x, factor * y) for each, (x, y) in link.points.items()}
        return replace(scene, links=dict(scene.links) | {name: replace(link, points=points)})
    if pin in scene.ground and axis in AXES:
        x, y = scene.ground[pin]
        moved = (value, y) if axis == "x" else (x, value)
        return replace(scene, ground=dict(scene.ground) | {pin: moved})
    if name == OMEGA and isinstance(law, ConstantSpeed):
        if value == 0.0:
            raise CrankcheckError(f"--family {name}=0: a speed; give numbers that are not 0")
        driver = replace(scene.driver, law=replace(law, speed_rad_s=value))
        return replace(scene, driver=driver)
    names = [each.name for each in scene.links.values() if len(each.points) == 2]
    names += [f"{each}.{axis}" for each in scene.ground for axis in AXES]
    names += [OMEGA] if isinstance(law, ConstantSpeed) else []
    raise CrankcheckError(f"--family {name}: {suggestion(name, names, 'it has')}")


def scene_curves(family: SceneFamily) -> FamilyCurves:
    """The curves of the output: the last slider on the ground, else the last link."""
    scene, motions = family.scene, family.motions
    sliders = [each.name for each in scene.sliders.values() if each.on == GROUND]
    name = sliders[-1] if sliders else list(scene.links)[-1]
    if sliders:
        heads = {"displacement": "[m]", "speed": "[m/s]", "acceleration": "[m/s²]"}
    else:
        heads = {"theta": "[rad]", "omega": "[rad/s]", "alpha": "[rad/s²]"}
    moved = [(motion.sliders if sliders else motion.links)[name] for motion in motions]
    charts = [
        FamilyChart(kind, f"{name}: {rate} {unit}", [getattr(each, rate) for each in moved])
        for kind, (rate, unit) in zip(KINDS, heads.items(), strict=True)
    ]
    angles = [np.degrees(motion.links[scene.driver.link].theta) for motion in motions]
    return FamilyCurves(family.name, family.unit, family.values, angles, charts)
