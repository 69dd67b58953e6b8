"""What friction takes, and where it locks, as tables and sentences to be read."""

from __future__ import annotations

import math

from rich.table import Table

from analytic.forces.efficiency import Efficiency, PowerFlow, efficiency, friction_power, power_flow
from analytic.structure.mobility import analyse
from models.errors import CrankcheckError
from models.motion import Forces, Motion
from models.scene import Scene
from reports.describe.tables import Columns, digits, head_table
from reports.output.numbers import listed


def position_friction_tables(scene: Scene, motion: Motion, acting: Forces) -> list[Table]:
    """At one position: of what the drive puts in, what friction takes; and what rubs in each joint.

    None without friction.
    """
    flow = flow_of(scene, motion, acting)
    if flow is None:
        return []
    drive = head_table("power of", ("drive W", "friction W", "efficiency "))
    numbers = (flow.put_in, -flow.lost, flow.efficiency)
    drive.add_row(scene.driver.joint, *(digits(float(each[0])) for each in numbers))
    joints = head_table("friction on", ("from ", "couple N m", "force N", "power W"))
    watts = friction_power(scene, motion, acting.friction)
    for joint, series in acting.friction.items():
        first, second = _bodies(scene, joint)
        is_slider = joint in scene.sliders
        pair = (math.nan, float(series[0])) if is_slider else (float(series[0]), math.nan)
        row = (first, *map(digits, (*pair, float(watts[joint][0]))))
        joints.add_row(f"{joint} {second}", *row)
    return [drive, joints]


def friction_over_time(scene: Scene, motion: Motion, acting: Forces) -> list[tuple[str, Columns]]:
    """Columns of the instantaneous efficiency, and of what rubs, by joint."""
    flow = flow_of(scene, motion, acting)
    if flow is None:
        return []
    columns: list[tuple[str, Columns]] = [
        (
            "power",
            [("drive\nW", flow.put_in), ("lost\nW", flow.lost), ("effi-\nciency", flow.efficiency)],
        )
    ]
    for joint, series in acting.friction.items():
        columns.append(
            (friction_name(scene, joint), [(f"friction\n{unit_of(scene, joint)}", series)])
        )
    return columns


def friction_name(scene: Scene, joint: str) -> str:
    """A joint that rubs, as tables of forces call it."""
    return f"slider {joint}" if joint in scene.sliders else f"{joint} on {_bodies(scene, joint)[1]}"


def unit_of(scene: Scene, joint: str) -> str:
    """Of what rubs: a force in a slider, a couple in a pin."""
    return "N" if joint in scene.sliders else "N m"


def flow_of(scene: Scene, motion: Motion, acting: Forces) -> PowerFlow | None:
    """The power in and lost; None without friction, or of a motion that lacks a body."""
    whole = (
        motion.links.keys() == scene.links.keys() and motion.sliders.keys() == scene.sliders.keys()
    )
    return power_flow(scene, motion, acting) if acting.friction and whole else None


def cycle_of(scene: Scene) -> Efficiency | None:
    """The efficiency of a scene with friction; None without, or where no cycle is."""
    if not scene.friction:
        return None
    try:
        return efficiency(scene)
    except CrankcheckError:
        return None


def friction_words(scene: Scene) -> list[str]:
    """What friction costs over a cycle, and where it locks, in sentences."""
    return cycle_words(scene, cycle_of(scene))


def cycle_words(scene: Scene, cycle: Efficiency | None) -> list[str]:
    """As `friction_words`, of what was worked out before."""
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
        (False, "may jam", "the load helps, and another equilibrium, of more friction, is as good"),
    ):
        if ranges := [each.ends for each in cycle.locked if each.locks == locks]:
            words.append(f"It {what} with {scene.driver.joint} {listed(ranges)}: there {why}.")
    return words


def _bodies(scene: Scene, joint: str) -> tuple[str, str]:
    """The body that friction comes from, and the one that it acts on."""
    if joint in scene.sliders:
        slider = scene.sliders[joint]
        return slider.on, slider.link or "block"
    first, second = analyse(scene).pins[joint]
    return first, second
