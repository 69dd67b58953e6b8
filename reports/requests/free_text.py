"""A free motion on the terminal: what is let go, how it moves, and what is special."""

from __future__ import annotations

import numpy as np
from rich.console import Console

from analytic.free.free_motion import FreeMotion
from analytic.structure.mobility import analyse
from models.motion import Motion
from reports.describe.frame import cleaned
from reports.describe.free_motion import free_notes, free_tables
from reports.describe.law import describe_law
from reports.describe.tables import motion_tables
from reports.output.console import say
from reports.plan.singular import continued_note
from reports.requests.solution_text import heading


def show_free(console: Console, free: FreeMotion, motion: Motion) -> None:
    """Print the mechanism, every sample of its motion, and the notes."""
    scene = free.scene
    told = heading(scene, analyse(scene)) if free.by_dyads else _without_dyads(free)
    say(console, told)
    shown = cleaned(motion)
    tables = motion_tables(scene, shown, console.width)
    if scene.driver.link in motion.links:
        tables = [*free_tables(free, shown, console.width), *tables]
    for table in tables:
        console.print(table, "")
    notes = [*free_notes(free, float(np.max(motion.time_s))), continued_note(scene, motion)]
    for note in filter(None, notes):
        say(console, note, "yellow")


def _without_dyads(free: FreeMotion) -> str:
    """What a mechanism of other freedoms than one, or of other groups than dyads, is."""
    scene = free.scene
    return (
        f"{scene.name}: {scene.source}\nmobility {free.freedoms}; driver {scene.driver.link}, "
        f"{describe_law(scene)}; by the equations of motion of all bodies\n"
    )
