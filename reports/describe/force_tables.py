"""Reactions and driving torque as tables on the terminal: at one position, and over time."""

import math
from dataclasses import dataclass

import numpy as np
from rich.table import Table

from analytic.forces.efficiency import Efficiency, PowerFlow, efficiency, friction_power, power_flow
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Forces, Motion
from models.scene import Scene
from models.scene.driver import driver_course, driver_place, driver_shown, driver_unit
from reports.describe.free_motion import (
    Columns,
    acted_on,
    add_numbers,
    head_table,
    tables_over_time,
)
from reports.output.console import plain_table
from reports.output.numbers import listed


def position_friction_tables(scene: Scene, motion: Motion, acting: Forces) -> list[Table]:
    """Return tables at one position: power of the drive with its loss; and friction of each joint.
    None without friction."""
    flow = flow_of(scene, motion, acting)
    if flow is None:
        return []
    drive = head_table("power of", ("drive W", "friction W", "efficiency "))
    add_numbers(drive, scene.driver.joint, flow.put_in[0], -flow.lost[0], flow.efficiency[0])
    joints = head_table("friction on", ("from ", "couple N m", "force N", "power W"))
    watts = friction_power(scene, motion, acting.friction)
    for joint, series in acting.friction.items():
        first, second = _bodies(scene, joint)
        pair = (math.nan, series[0]) if joint in scene.sliders else (series[0], math.nan)
        add_numbers(joints, f"{joint} {second}", first, *pair, watts[joint][0])
    return [drive, joints]


def friction_over_time(scene: Scene, motion: Motion, acting: Forces) -> list[tuple[str, Columns]]:
    """Return columns of the instantaneous efficiency, and of friction by joint."""
    flow = flow_of(scene, motion, acting)
    if flow is None:
        return []
    power = [("drive\nW", flow.put_in), ("lost\nW", flow.lost), ("effi-\nciency", flow.efficiency)]
    columns: list[tuple[str, Columns]] = [("power", power)]
    for joint, series in acting.friction.items():
        head = f"friction\n{unit_of(scene, joint)}"
        columns.append((friction_name(scene, joint), [(head, series)]))
    return columns


def friction_name(scene: Scene, joint: str) -> str:
    """Return the name of a joint with friction in tables of forces."""
    return f"slider {joint}" if joint in scene.sliders else f"{joint} on {_bodies(scene, joint)[1]}"


def unit_of(scene: Scene, joint: str) -> str:
    """Return the unit of friction: a force in a slider, a couple in a pin."""
    return "N" if joint in scene.sliders else "N m"


def flow_of(scene: Scene, motion: Motion, acting: Forces) -> PowerFlow | None:
    """Return the power in and lost; None without friction, or for a motion that lacks a body."""
    whole = (
        motion.links.keys() == scene.links.keys() and motion.sliders.keys() == scene.sliders.keys()
    )
    return power_flow(scene, motion, acting) if acting.friction and whole else None


def cycle_of(scene: Scene) -> Efficiency | None:
    """Return the efficiency of a scene with friction; None without, or where there is no cycle."""
    if not scene.friction:
        return None
    try:
        return efficiency(scene)
    except CrankcheckError:
        return None


def friction_words(scene: Scene) -> list[str]:
    """Return the loss by friction over a cycle, and the ranges where it locks, in sentences."""
    return cycle_words(scene, cycle_of(scene))


def cycle_words(scene: Scene, cycle: Efficiency | None) -> list[str]:
    """Return `friction_words` of an earlier result."""
    if cycle is None:
        return []
    words = []
    if math.isfinite(cycle.put_in):
        taken = f"Friction takes {cycle.wasted:.6g} J in a cycle"
        useful = f"{cycle.useful:.6g} J of the {cycle.put_in:.6g} J that the drive puts in"
        if math.isfinite(cycle.cycle):
            words.append(f"{taken}; {useful} are useful work: efficiency {cycle.cycle:.6g}.")
        else:
            words.append(f"{taken}; no useful work is done in it, so it has no efficiency.")
    for locks, what, why in (
        (True, "locks itself", "no finite torque keeps it moving, and its cycle has no efficiency"),
        (False, "may jam", "the load helps, and a second equilibrium exists, with more friction"),
    ):
        if ranges := [each.ends for each in cycle.locked if each.locks == locks]:
            words.append(f"It {what} with {scene.driver.joint} {listed(ranges)}: there {why}.")
    return words


def _bodies(scene: Scene, joint: str) -> tuple[str, str]:
    """Return the body that exerts friction, and the one on which it acts."""
    if joint in scene.sliders:
        slider = scene.sliders[joint]
        return slider.on, slider.link or "block"
    first, second = analyse(scene).pins[joint]
    return first, second


def position_force_tables(scene: Scene, motion: Motion, acting: Forces) -> list[Table]:
    """Return the driving torque with its power, the force in every pin, and that of every guide, at
    one position; of a guide also the distance along its line from the slider's point at which the
    normal force acts alone."""
    drive = head_table("drive on", (_effort(scene), "power W"))
    power = math.nan
    if driver_place(scene, motion) is not None:
        power = acting.torque[0] * driver_course(scene, motion)[1][0]
    add_numbers(drive, scene.driver.joint, acting.torque[0], power)
    pins = head_table("pin, force on", ("from ", "x N", "y N", "size N", "direction deg"))
    for point, body, source, force in acted_on(acting):
        x, y = force[0]
        add_numbers(pins, f"{point} {body}", source, x, y, math.hypot(x, y), _direction(x, y))
    guides = head_table("slider, force on", ("from ", "normal N", "moment N m", "offset m"))
    for name, reaction in acting.sliders.items():
        slider, normal, moment = scene.sliders[name], reaction.normal[0], reaction.moment[0]
        offset = moment / normal if normal else math.nan
        label = f"{name} {slider.link or 'block'}"
        add_numbers(guides, label, slider.on, normal, moment, offset)
    tables = [table for table in (drive, pins, guides) if table.row_count]
    return tables + position_friction_tables(scene, motion, acting)


def motion_force_tables(scene: Scene, motion: Motion, acting: Forces, width: int) -> list[Table]:
    """Return torque, pins and sliders over time, as many to a table as the terminal can hold."""
    drive = ("drive", [(_effort(scene).replace(" ", "\n", 1), acting.torque)])
    bodies: list[tuple[str, Columns]] = [drive] * bool(acting.drive_unit)
    for point, body, _, force in acted_on(acting):
        x, y = force.T
        columns = [("x\nN", x), ("y\nN", y), ("size\nN", np.hypot(x, y))]
        bodies.append((f"{point} on {body}", columns))
    for name, slider in acting.sliders.items():
        both = [("normal\nN", slider.normal), ("moment\nN m", slider.moment)]
        bodies.append((f"slider {name}", both))
    bodies += friction_over_time(scene, motion, acting)
    return tables_over_time(scene, motion, bodies, width)


def _effort(scene: Scene) -> str:
    return f"{scene.driver.effort} {scene.driver.effort_unit}"


@dataclass(frozen=True)
class Largest:
    """The largest value over a turn, with its sign, in ``unit``; the place of the driver there [deg
    or m], and the mean over time, NaN where friction locks in part of it."""

    name: str
    value: float
    unit: str
    at: float
    mean: float


def largest_of(scene: Scene, turn: Motion, acting: Forces) -> list[Largest]:
    """Return the torque, each pin by the size of its force, and each slider; a row for each
    determined series. ``turn`` has both its ends."""
    places = driver_shown(scene, turn)
    places = places % 360.0 if driver_unit(scene) == "deg" else places
    drive = (f"driving {scene.driver.effort}", acting.torque, scene.driver.effort_unit)
    series: list[tuple[str, Array, str]] = [drive] * bool(acting.drive_unit)
    for point, body, _, force in acted_on(acting):
        series.append((f"{point} on {body}", np.hypot(force[:, 0], force[:, 1]), "N"))
    for name, slider in acting.sliders.items():
        series.append((f"slider {name}, normal", slider.normal, "N"))
        series.append((f"slider {name}, moment", slider.moment, "N m"))
    for joint, rubbing in acting.friction.items():
        unit = unit_of(scene, joint)
        series.append((f"{friction_name(scene, joint)}, friction", rubbing, unit))
    flow = flow_of(scene, turn, acting)
    if flow is not None:
        series.append(("power lost in friction", flow.lost, "W"))
    rows = []
    for name, values, unit in series:
        if not np.isfinite(values).any():
            continue
        at = int(np.nanargmax(np.abs(values)))
        value = float(values[at]) + 0.0
        mean = math.nan
        if not acting.has_equilibria(0).any():
            mean = float(np.nanmean(values[:-1]))
            # A series that comes and goes alike has no mean but rounding.
            mean = mean if abs(mean) > 1e-9 * abs(value) else 0.0
        rows.append(Largest(name, value, unit, float(places[at]) if value else math.nan, mean))
    return rows


def largest_table(scene: Scene, turn: Motion, acting: Forces, over: str = "over a turn") -> Table:
    """Return a table of `largest_of`."""
    table = plain_table(gap=2)
    for k, head in enumerate((over, "largest", "", f"{scene.driver.joint} at", "mean")):
        table.add_column(head, justify="right" if k and head else "left", no_wrap=True)
    for row in largest_of(scene, turn, acting):
        at = "-" if math.isnan(row.at) else f"{row.at:.4g} {driver_unit(scene)}"
        mean = "-" if math.isnan(row.mean) else f"{row.mean:.6g}"
        table.add_row(row.name, f"{row.value:.6g}", row.unit, at, mean)
    return table


def _direction(x: float, y: float) -> float:
    """Return the angle of a force [deg], 0 to 360; none where there is no force."""
    if x == y == 0.0:
        return math.nan
    return math.degrees(math.atan2(y, x)) % 360.0
