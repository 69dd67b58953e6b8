"""The logs of a stranger: a plain one of each linkage, and guises that a right one may come in."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from tests.worlds.stranger import FOURBAR, LINKAGES, Array, Linkage
from tests.worlds.stranger_log import (
    DEG,
    MM,
    RPM,
    Column,
    Dress,
    Log,
    even,
    logged,
    map_text,
    uneven,
)


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
PER_TURN = 60
STEP_S = FOURBAR.period_s / PER_TURN


@dataclass(frozen=True)
class Guise:
    """The columns of a log, its clock and times, its dress, and what the map says of the file; a
    log whose names say it all has no map."""

    columns: Sequence[Column]
    clock: tuple[str, str] = ("time_s", "s")
    times: Callable[..., Array] = even
    dress: Dress = field(default_factory=Dress)
    mapped: bool = False
    file: str = ""
    name: str = "log.csv"

    def log(self, linkage: Linkage, turns: float = 2.0) -> Log:
        per_second = {"s": 1.0, "ms": 1e3, "us": 1e6}[self.clock[1]]
        time_s = self.times(linkage, turns, PER_TURN)
        return logged(linkage, time_s, self.columns, self.clock[0], per_second)

    def map(self, linkage: Linkage) -> str:
        if self.mapped:
            return map_text(linkage, self.columns, self.clock, self.file)
        return f"[file]\n{self.file}\n" if self.file else ""


DOTTED = [
    Column("crank.theta_rad", "crank", "angle"),
    Column("rocker.theta_rad", "rocker", "angle"),
    Column("C.x_mm", "C", "x", MM),
    Column("C.vx_m_s", "C", "vx"),
]
BRACKETS = [
    Column("rocker angle [deg]", "rocker", "angle", DEG),
    Column("Rocker angular velocity [deg/s]", "rocker", "omega", DEG),
    Column("rocker angular acceleration [rad/s^2]", "rocker", "alpha"),
    Column("C y [mm]", "C", "y", MM),
    Column("crank speed (rpm)", "crank", "omega", RPM),
]
SHORT = [
    Column("crank_deg", "crank", "angle", DEG),
    Column("rocker_deg", "rocker", "angle", DEG),
    Column("C.x_mm", "C", "x", MM),
]
UNITLESS = [
    Column("rocker angle", "rocker", "angle", DEG),
    Column("C x", "C", "x", MM),
    Column("C vy", "C", "vy"),
]
SENSORS = [
    Column("ch 1", "crank", "angle", -DEG, offset=90.0),  # clockwise, from the vertical
    Column("ch 2", "rocker", "angle", DEG, parent="coupler", turn_from=-180.0),
    Column("ch 3", "rocker", "omega", DEG, parent="coupler", later_s=-STEP_S / 2.0),
    Column("Weg, x", "C", "x", MM, on="rocker", offset=-300.0),
]
GERMAN = Dress(separator=";", point=",", newline="\r\n", mark=True, quoted=True)
GUISES = {
    "dots": Guise(DOTTED, ("time_ms", "ms")),
    "units in brackets": Guise(BRACKETS, ("t [s]", "s"), uneven),
    "tabs and remarks": Guise(
        SHORT, dress=Dress(separator="\t", comments=("# rig 3", "# 1,2;3", "#"), newline="\r\n"),
        name="log.txt"),
    "a row of units": Guise(
        UNITLESS, ("time", "ms"), dress=Dress(separator=";", units=("ms", "deg", "mm", "m/s"))),
    "decimal commas": Guise(SHORT, dress=GERMAN, file='decimal = ","'),
    "names that say nothing": Guise(
        SENSORS, ("Zeit", "us"), uneven, Dress(quoted=True), mapped=True),
}  # fmt: skip
"""Of the four-bar."""


def disguised(scene: str) -> Guise:
    """Degrees and mm, wrapped, at uneven times, angles of joints, rates half a sample late."""
    linkage = LINKAGES[scene]
    delay_s = -linkage.period_s / PER_TURN / 2.0
    bars = list(linkage.bars)
    columns = []
    for number, old in enumerate(COLUMNS[scene]):
        new = replace(old, header=f"signal {number}")
        if old.what == "angle":
            turn_from = -180.0 if number % 4 else 0.0
            parent = bars[bars.index(old.of) - 1] if old.of != "crank" else ""
            new = replace(new, turn_from=turn_from, parent=parent)
        elif old.what == "omega":
            new = replace(new, per=DEG if number % 4 == 1 else -RPM, later_s=delay_s)
        columns.append(new)
    return Guise(columns, ("clock", "ms"), uneven, mapped=True)
