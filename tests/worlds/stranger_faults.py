"""The logs of a stranger with a fault in each: ten faults on three linkages.

They are planted in a log that is right, whatever its columns are called, but for two: a linkage put
together the other way, and one whose coupler is 1 % longer than the drawing says.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tests.worlds.stranger import LINKAGES, Array, Linkage
from tests.worlds.stranger_log import DEG, MM, Column, Log, logged

AT = 0.37
"""Where in a log the fault of a moment is, as a part of its rows."""
LATE = 2.5
"""Samples."""


def _bar(name: str) -> list[Column]:
    return [Column(f"{name}_deg", name, "angle", DEG), Column(f"{name}_omega_rad_s", name, "omega")]


def _pin(name: str) -> list[Column]:
    return [
        Column(f"{name}_x_mm", name, "x", MM),
        Column(f"{name}_y_mm", name, "y", MM),
        Column(f"{name}_vx_m_s", name, "vx"),
        Column(f"{name}_vy_m_s", name, "vy"),
    ]


COLUMNS: dict[str, list[Column]] = {
    "fourbar-lecture-1": [*_bar("crank"), *_bar("coupler"), *_bar("rocker"), *_pin("C")],
    "slider-crank-central": [
        *_bar("crank"), *_bar("rod"), *_pin("B"), Column("C_slider_displacement_mm", "C", "x", MM),
        Column("C_slider_speed_m_s", "C", "vx")],
    "sixbar-watt": [
        *(column for bar in ("crank", "coupler", "rod", "lever") for column in _bar(bar)),
        *_pin("F")],
}  # fmt: skip
"""A plain log of each linkage, whose headers say it all."""


@dataclass(frozen=True)
class Culprits:
    """The columns of a linkage's log that the faults are planted in, the pin at which it is put
    together the other way, and the bar that is longer."""

    swapped: tuple[str, str]
    unit: tuple[str, float]
    sign: str
    late: str
    branch: str
    longer: str
    stuck: str
    turn: str
    filtered: str


CULPRITS = {
    "fourbar-lecture-1": Culprits(
        swapped=("coupler_deg", "rocker_deg"),
        unit=("rocker_deg", 1.0 / DEG),  # radians
        sign="coupler_omega_rad_s",
        late="rocker_omega_rad_s",
        branch="C",
        longer="coupler",
        stuck="C_x_mm",
        turn="crank_deg",
        filtered="rocker_omega_rad_s",
    ),
    "slider-crank-central": Culprits(
        swapped=("B_x_mm", "B_y_mm"),
        unit=("C_slider_displacement_mm", 1e-3),  # metres
        sign="rod_deg",
        late="C_slider_speed_m_s",
        branch="C",
        longer="rod",
        stuck="rod_deg",
        turn="crank_deg",
        filtered="C_slider_speed_m_s",
    ),
    "sixbar-watt": Culprits(
        swapped=("rod_omega_rad_s", "lever_omega_rad_s"),
        unit=("F_vx_m_s", 1e3),  # millimetres per second
        sign="F_y_mm",
        late="lever_deg",
        branch="F",
        longer="rod",
        stuck="lever_omega_rad_s",
        turn="coupler_deg",
        filtered="F_vx_m_s",
    ),
}


@dataclass(frozen=True)
class Planted:
    """A log with a fault, the columns that are spoilt (none where all are), and what else is to be
    named."""

    log: Log
    columns: tuple[str, ...]
    named: str = ""


def swapped(log: Log, one: str, other: str) -> Log:
    return {**log, one: log[other], other: log[one]}


def in_other_unit(log: Log, column: str, factor: float) -> Log:
    """Numbers in another unit than the header says."""
    return {**log, column: log[column] * factor}


def of_other_sign(log: Log, column: str) -> Log:
    """Clockwise positive, in one column."""
    return {**log, column: -log[column]}


def late(columns: Sequence[Column], header: str, by_s: float) -> list[Column]:
    """The columns, one of which shows what was so long ago [s]."""
    return [
        replace(column, later_s=column.later_s - by_s) if column.header == header else column
        for column in columns
    ]


def drifted(log: Log, share: float) -> Log:
    clock = next(iter(log))
    return {**log, clock: log[clock] * (1.0 + share)}


def stuck(log: Log, column: str, rows: int = 1) -> Log:
    """A reading that was not renewed, for so many rows."""
    series = log[column].copy()
    at = _at(series)
    series[at : at + rows] = series[at - 1]
    return {**log, column: series}


def lost_turn(log: Log, column: str, turn: float = 360.0) -> Log:
    """A counter of turns that missed one."""
    series = log[column].copy()
    series[_at(series) :] -= turn
    return {**log, column: series}


def smoothed(log: Log, column: str, rows: float) -> Log:
    """A low-pass of the first order, with a time constant of so many rows, of which some may be
    longer than others."""
    series, clock = log[column].copy(), next(iter(log.values()))
    steps = np.diff(clock)
    shares = 1.0 - np.exp(-steps / (rows * np.mean(steps)))
    for k, share in enumerate(shares, 1):
        series[k] = series[k - 1] + share * (series[k] - series[k - 1])
    return {**log, column: series}


def averaged(log: Log, column: str, rows: int) -> Log:
    """The mean of so many rows about each; where they are not all there, those that are."""
    ones = np.ones(rows)
    number = np.convolve(np.ones(log[column].size), ones, "same")
    return {**log, column: np.convolve(log[column], ones, "same") / number}


def _at(series: Array) -> int:
    return round(AT * series.size)


def planted(
    scene: str, time_s: Array, columns: Sequence[Column] | None = None
) -> dict[str, Callable[[], Planted]]:
    """The ten faults in the log of a linkage at those times [s], by name."""
    linkage, culprits = LINKAGES[scene], CULPRITS[scene]
    columns = columns or COLUMNS[scene]
    delay_s = LATE * float(np.ptp(time_s)) / (time_s.size - 1)

    def log(of: Linkage = linkage, columns: Sequence[Column] = columns) -> Log:
        return logged(of, time_s, columns)

    def column(change: Callable[..., Log], name: str, *rest: float) -> Callable[[], Planted]:
        return lambda: Planted(change(log(), name, *rest), (name,))

    return {
        "swapped columns": lambda: Planted(swapped(log(), *culprits.swapped), culprits.swapped),
        "wrong unit": column(in_other_unit, *culprits.unit),
        "wrong sign": column(of_other_sign, culprits.sign),
        "late channel": lambda: Planted(
            log(columns=late(columns, culprits.late, delay_s)), (culprits.late,)
        ),
        "drifted clock": lambda: Planted(drifted(log(), 1e-3), ()),
        "other branch": lambda: Planted(log(linkage.otherwise()), (), culprits.branch),
        "scaled length": lambda: Planted(
            log(linkage.stretched(culprits.longer, 1.01)), (), culprits.longer
        ),
        "stuck sample": column(stuck, culprits.stuck),
        "lost turn": column(lost_turn, culprits.turn),
        "filtered signal": column(smoothed, culprits.filtered, 20.0),
    }
