"""The branch of a scene that has it stand as a motion does."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from analytic.kinematics import solve
from analytic.structure.groups import Group, Triad
from analytic.structure.mobility import Structure, analyse
from models.errors import ReachError, StructureError
from models.motion import Motion
from models.names import MOST_ASSEMBLIES
from models.scene import Scene

SAME = 1e-9
"""Of the longest length: two places that are one."""
MOST_SIDES = 8
"""Assemblies of dyads that are tried in every combination."""


def in_assembly(scene: Scene, motion: Motion) -> Scene | None:
    """The scene with the branch by which its points at time 0 are where those of a motion are at
    its first sample; None where there is none, or no solution of the scene."""
    try:
        structure = analyse(replace(scene, branch={}))
    except StructureError:
        return None
    for branch in branches(structure):
        held = replace(scene, branch=branch)
        try:
            places = solve(held, np.zeros(1), links=(), sliders=(), bound=False).points
        except (ReachError, StructureError):
            continue
        apart = (
            math.dist(motion.points[p].position[0], at.position[0]) for p, at in places.items()
        )
        if max(apart) <= SAME * scene.longest_m:
            return held
    return None


def chosen_groups(structure: Structure) -> list[Group | Triad]:
    """The groups that have more than one assembly, in solving order."""
    return [
        part
        for part in structure.order
        if isinstance(part, Triad) or (isinstance(part, Group) and part.assemblies > 1)
    ]


def choices(scene: Scene, group: Group | Triad) -> tuple[int, ...]:
    """What the branch of a group may be, first that of the scene; of class III also numbers that
    there may not be."""
    own = scene.branch.get(group.branch_key, 1)
    if isinstance(group, Group):
        return own, -own
    return own, *(number for number in range(1, MOST_ASSEMBLIES + 1) if number != own)


def branches(structure: Structure) -> Iterator[dict[str, int]]:
    """Every choice of assemblies; of class III groups also numbers that there may not be."""
    sides = [group.branch_key for group in structure.groups if group.assemblies == 2][:MOST_SIDES]
    numbers = [triad.branch_key for triad in structure.triads]
    choices = [*([1, -1] for _ in sides), *(range(1, MOST_ASSEMBLIES + 1) for _ in numbers)]
    for chosen in itertools.product(*choices):
        yield dict(zip([*sides, *numbers], chosen, strict=True))
