"""All assemblies of a scene at one place of its driver."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.drawings.placed_mechanism import DriverState, PlacedMechanism
from analytic.structure.mobility import Structure
from models.errors import CrankcheckError, ReachError, StructureError
from models.files.names import MOST_ASSEMBLIES
from models.scene import Scene
from models.scene.cut_links import with_rigid_links
from models.scene.laws import ConstantSpeed

MOST_CHOICES = 1024
"""Combinations of branches that are tried."""
SAME = 1e-6
"""Points that are nearer than this share of the longest length are the same."""


@dataclass(frozen=True)
class Assembled:
    """One assembly: the mechanism as it stands, its ``branch`` there, and whether it is the one
    that the scene itself moves in."""

    placement: PlacedMechanism
    branch: Mapping[str, int]
    is_own: bool

    @property
    def words(self) -> str:
        """What to write into a scene for it."""
        if not self.branch:
            return "the only one"
        return ", ".join(
            f"{key} {number:+d}" if key in self.signed else f"{key} {number}"
            for key, number in self.branch.items()
        )

    @property
    def signed(self) -> set[str]:
        """The keys of class II groups."""
        return {group.branch_key for group in self.placement.structure.groups}


def all_assemblies(scene: Scene, structure: Structure, coordinate: float) -> list[Assembled]:
    """Every assembly with the driver at a coordinate [rad, or m of a slider], in the order of the
    branches, each with the numbers that it has where a motion starts there.

    Raises CrankcheckError where there are too many combinations to try.
    """
    keys = [group.branch_key for group in structure.groups if group.assemblies == 2]
    numbers = [(1, -1)] * len(keys)
    triads = [triad.branch_key for triad in structure.triads]
    choices = [*numbers, *[range(1, MOST_ASSEMBLIES + 1)] * len(triads)]
    many = math.prod(map(len, choices))
    if many > MOST_CHOICES:
        raise CrankcheckError(
            f"{scene.name}: its {len(choices)} groups make {many} combinations of branches, more "
            f"than the {MOST_CHOICES} that are tried; `solve` shows the scene's own assembly"
        )
    rigid = with_rigid_links(scene)
    speed = math.copysign(rigid.driver.law.peak_speed_rad_s, _way(rigid))
    state = DriverState(coordinate, speed)
    own = _own(rigid, state)
    there = replace(rigid, driver=replace(rigid.driver, law=ConstantSpeed(coordinate, speed)))
    every = []
    for chosen in itertools.product(*choices):
        branch = dict(zip([*keys, *triads], chosen, strict=True))
        placement = _placed(replace(there, branch=branch), state)
        if placement is not None:
            every.append(Assembled(placement, branch, own is not None and _is(placement, own)))
    return every


def _way(scene: Scene) -> float:
    """The sense in which the driver starts, 1 where it starts from rest."""
    return float(scene.driver.law.at(np.zeros(1))[1][0]) or 1.0


def _own(scene: Scene, state: DriverState) -> PlacedMechanism | None:
    """The scene where its own motion comes to, None where it does not."""
    return _placed(scene, state)


def _placed(scene: Scene, state: DriverState) -> PlacedMechanism | None:
    """The scene there; None where this assembly can not close."""
    try:
        return PlacedMechanism.of(scene, state)
    except (ReachError, StructureError):
        return None


def _is(one: PlacedMechanism, other: PlacedMechanism) -> bool:
    """Whether all points stand at the same places."""
    apart = max(float(np.hypot(*(at - other.points[name]))) for name, at in one.points.items())
    return apart < SAME * one.scene.longest_m
