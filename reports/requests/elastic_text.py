"""A motion with elastic links on the terminal: what is elastic, how it moves, and how far it is to
be trusted."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console

from analytic.elastic.sampled import ElasticHistory
from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.scene import Scene
from reports.describe.elastic_course import (
    ElasticCourse,
    elastic_tables,
    extremes,
    extremes_table,
    largest_deflections,
    start_of,
)
from reports.describe.elastic_words import elastic_facts, elastic_warnings, start_words
from reports.describe.force_tables import motion_force_tables
from reports.describe.frame import cleaned
from reports.describe.law import describe_law
from reports.output.console import say
from reports.requests.solution_text import heading


def show_elastic(
    console: Console,
    motion: ElasticHistory,
    shown: ElasticCourse,
    fine: ElasticCourse,
    certainty: Sequence[str],
    *,
    forces: bool,
) -> None:
    """Print the mechanism, the samples that are ``shown``, and the largest of a motion closely
    sampled, ``fine``."""
    scene = motion.scene
    facts = elastic_facts(scene, motion.by, stiffened=motion.stiffened)
    say(console, _heading(scene) + "\n".join(facts) + "\n")
    for table in elastic_tables(shown, console.width):
        console.print(table, "")
    if forces and shown.motion.forces is not None:
        acting = shown.motion.forces
        for table in motion_force_tables(scene, cleaned(shown.motion), acting, console.width):
            console.print(table, "")
    console.print(extremes_table(scene, extremes(fine)), "")
    for line in (start_words(scene, start_of(motion)), *certainty):
        say(console, line)
    for line in elastic_warnings(scene, largest_deflections(fine)):
        say(console, line, "yellow")


def _heading(scene: Scene) -> str:
    """What the mechanism is; of one of more freedoms, or of no dyads, its start."""
    try:
        return heading(scene, analyse(scene))
    except StructureError:
        return f"{scene.name}: {scene.source}\ndriver {scene.driver.link}, {describe_law(scene)}\n"
