"""A solved mechanism on the terminal: what it is, its position or motion, and what is special."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console

from analytic.mechanism.cycle import Along
from analytic.structure.groups import Bridge
from analytic.structure.mobility import Structure
from models.driver_course import driver_place
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.describe.facts import SpeedFacts, facts
from reports.describe.force_tables import (
    largest_table,
    motion_force_tables,
    position_force_tables,
)
from reports.describe.frame import cleaned
from reports.describe.friction import friction_words
from reports.describe.law import describe_law
from reports.describe.tables import certainty, motion_tables, position_tables, speed_table
from reports.describe.with_forces import (
    cleaned_forces,
    force_certainty,
    force_notes,
    left_out_notes,
    turn_with_forces,
)
from reports.output.console import say
from reports.plan.singular import continued_note, singular_note


def show_heading(
    console: Console,
    scene: Scene,
    structure: Structure,
    along: Sequence[Along] = (),
    speeds: SpeedFacts | None = None,
) -> None:
    """Print what the mechanism is, and its extreme speeds, where there are any."""
    say(console, heading(scene, structure, along))
    if speeds and speeds.rows:
        console.print(speed_table(speeds), "")


def heading(scene: Scene, structure: Structure, along: Sequence[Along] = ()) -> str:
    """What the mechanism is, and what the theory says of it as a whole."""
    groups = ", ".join(
        f"{part.kind} ({', '.join(part.bodies)})"
        for part in structure.order
        if not isinstance(part, Bridge)
    )
    lines = [
        f"{scene.name}: {scene.source}",
        f"{structure.words}; driver {scene.driver.joint}, {describe_law(scene)}; "
        f"groups in solving order: {groups}",
        *facts(scene, structure, along),
    ]
    return "\n".join(lines) + "\n"


def show_position(console: Console, scene: Scene, motion: Motion) -> None:
    """Print a single position in full, and how certain it is."""
    for table in position_tables(scene, cleaned(motion)):
        console.print(table, "")
    told = [certainty(motion)]
    if motion.forces is not None:
        told.append(force_certainty(scene, motion.forces))
        for table in position_force_tables(scene, motion, cleaned_forces(motion.forces)):
            console.print(table, "")
    say(console, "\n".join(filter(None, told)), "dim")


def show_motion(console: Console, scene: Scene, motion: Motion) -> None:
    """Print every sample of a motion."""
    for table in motion_tables(scene, cleaned(motion), console.width):
        console.print(table, "")
    if motion.forces is not None:
        acting = cleaned_forces(motion.forces)
        for table in motion_force_tables(scene, motion, acting, console.width):
            console.print(table, "")


def show_largest(console: Console, scene: Scene) -> None:
    """Print the largest forces over a turn, closely sampled, and their means over time, where the
    driver goes through a turn."""
    try:
        turn = turn_with_forces(scene)
    except CrankcheckError:
        return
    assert turn.forces is not None
    console.print(largest_table(scene, turn, cleaned_forces(turn.forces)), "")
    for note in left_out_notes(scene, turn):
        say(console, note, "yellow")


def show_friction(console: Console, scene: Scene) -> None:
    """Print what friction takes over a cycle, and where it locks, where it does."""
    for words in friction_words(scene):
        say(console, words)


def show_notes(console: Console, scene: Scene, motion: Motion) -> None:
    """Print what change points and singular positions are on the way, if any, and what of forces
    is not determined."""
    told = driver_place(scene, motion) is not None
    singular = singular_note(scene, motion) if told else ""
    notes = (continued_note(scene, motion), singular, *force_notes(scene, motion))
    for note in filter(None, notes):
        say(console, note, "yellow")
