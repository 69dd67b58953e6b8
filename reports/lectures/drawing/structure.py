"""`crankcheck structure`: the parts of a scene, and all its assemblies."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import numpy as np
from rich.console import Console

from analytic.lectures.chains.assur_groups import ClassedGroup, by_drivers, classed
from analytic.lectures.drawings.polygon import DriverState, PlacedMechanism
from analytic.structure.gear_groups import GearGroup
from analytic.structure.groups import Bridge, Following
from analytic.structure.mobility import Structure, analyse
from models.errors import CrankcheckError, ReachError, StructureError
from models.files.body_table import MOST_ASSEMBLIES
from models.files.reading import find_scene, load_scene
from models.scene import Scene
from models.scene.cut_links import with_rigid_links
from models.scene.laws import ConstantSpeed
from reports.describe.facts import place_at
from reports.lectures.drawing.sheet_requests import ENDINGS, save_sheet
from reports.lectures.drawing.sheets.paper import Paper, sheet_note
from reports.lectures.drawing.sheets.position_sheet import draw_assemblies
from reports.output.console import grid, say
from reports.output.numbers import count, roman
from reports.output.write import check_file
from reports.requests.options import PaperSize, SceneName, option, output_option

MOST_CHOICES = 1024
"""Largest number of combinations of branches."""
SAME = 1e-6
"""Distance of points that coincide, as a share of the longest length."""


@dataclass(frozen=True)
class SceneAssembly:
    """One assembly: the mechanism as placed, its ``branch`` there, and True for the assembly that
    the scene itself moves in."""

    placement: PlacedMechanism
    branch: Mapping[str, int]
    is_own: bool

    @property
    def words(self) -> str:
        """The text of the assembly's branch for a scene file; class II groups have signs."""
        signed = {group.branch_key for group in self.placement.structure.groups}
        numbers = (
            f"{key} {number:+d}" if key in signed else f"{key} {number}"
            for key, number in self.branch.items()
        )
        return ", ".join(numbers) or "the only one"


def all_assemblies(scene: Scene, structure: Structure, coordinate: float) -> list[SceneAssembly]:
    """Every assembly with the driver at a coordinate [rad, or m of a slider], in the order of the
    branches, each with the numbers of a motion that starts there.

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
    way = float(rigid.driver.law.at(np.zeros(1))[1][0]) or 1.0  # 1 where it starts from rest
    speed = math.copysign(rigid.driver.law.peak_speed_rad_s, way)
    state = DriverState(coordinate, speed)
    own = _placed(rigid, state)  # None where the scene's motion does not reach it
    there = replace(rigid, driver=replace(rigid.driver, law=ConstantSpeed(coordinate, speed)))
    every = []
    for chosen in itertools.product(*choices):
        branch = dict(zip([*keys, *triads], chosen, strict=True))
        placement = _placed(replace(there, branch=branch), state)
        if placement is not None:
            every.append(SceneAssembly(placement, branch, own is not None and _is(placement, own)))
    return every


def _placed(scene: Scene, state: DriverState) -> PlacedMechanism | None:
    """The scene there; None where this assembly can not close."""
    try:
        return PlacedMechanism.of(scene, state)
    except (ReachError, StructureError):
        return None


def _is(one: PlacedMechanism, other: PlacedMechanism) -> bool:
    """True if all points coincide."""
    apart = max(float(np.hypot(*(at - other.points[name]))) for name, at in one.points.items())
    return apart < SAME * one.scene.longest_m


@dataclass(frozen=True)
class StructureRequest:
    """Arguments of `structure`, as given."""

    scene: SceneName
    at_deg: Annotated[
        float | None, option("The driver's angle; default: the scene's start.", "DEG")
    ] = None
    at_m: Annotated[float | None, option("The displacement of a driving slider.", "M")] = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None, output_option("Draw all assemblies: .svg in layers, or .pdf.")
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Show or draw the structure. Raises CrankcheckError for a faulty request."""
        paper = Paper.of(self.paper)
        check_file(self.output, "-o", ENDINGS, inputs=[find_scene(self.scene)])
        scene = load_scene(self.scene)
        structure = analyse(scene)
        coordinate = float(scene.driver.law.at(np.zeros(1))[0][0])
        if self.at_deg is not None or self.at_m is not None:
            coordinate = place_at(scene, self.at_deg, self.at_m)
        every = all_assemblies(scene, structure, coordinate)
        at = f"{scene.driver.joint} at {_told(scene, coordinate)}"
        if self.output is not None:
            if not every:
                raise CrankcheckError(
                    f"{scene.name}: no assembly with {at}; nothing can be drawn, take another "
                    "place of the driver"
                )
            told = f"{scene.name}: {_counted(every)} with {at}"
            drawn = [
                (one.placement, f"branch: {one.words}" + "; this scene's" * one.is_own, one.is_own)
                for one in every
            ]
            canvas = draw_assemblies(drawn, told, sheet_note(scene), paper)
            save_sheet(console, canvas, self.output, told)
            return 0
        say(console, f"{scene.name}: {scene.source}")
        say(console, _count_in_words(structure))
        _show_groups(console, structure)
        _show_drivers(console, scene, structure)
        _show_assemblies(console, every, at)
        return 0


def _told(scene: Scene, coordinate: float) -> str:
    if scene.driver.slider is not None:
        return f"{coordinate:.6g} m"
    return f"{math.degrees(coordinate):.6g} deg"


def _count_in_words(structure: Structure) -> str:
    n, p = len(structure.bodies), structure.pairs
    sliders = len(structure.prismatics)
    return (
        f"{n} moving links ({', '.join(structure.bodies)}); {p} joints of class 5: "
        f"{p - sliders} pins, {sliders} sliders; {structure.higher or 'none'} of class 4\n"
        f"W = 3 n - 2 p5 - p4 = 3*{n} - 2*{p} - {structure.higher} = {structure.count}; "
        f"{structure.words}"
    )


def _show_groups(console: Console, structure: Structure) -> None:
    heads = ("group", "links", "class", "order")
    rows, highest = [], 1
    for part in structure.order:
        if isinstance(part, Bridge):
            rows.append(("redundant", part.link, "", ""))
            continue
        if isinstance(part, GearGroup | Following):
            rows.append((part.kind, ", ".join(part.bodies), "", ""))
            continue
        group = classed(part)
        highest = max(highest, group.class_number)
        number = roman(group.class_number)
        rows.append((group.kind, ", ".join(group.links), number, str(group.order)))
    console.print("", grid(heads, rows, "Assur groups in solving order"), sep="\n")
    say(console, f"the mechanism is of class {roman(highest)}")


def _show_drivers(console: Console, scene: Scene, structure: Structure) -> None:
    rows = []
    for one in by_drivers(scene, structure):
        if one.class_number is None:
            number, told = "", f"none: it can not move, or leaves {', '.join(one.left)} loose"
        else:
            number = roman(one.class_number)
            told = "; ".join(map(_group_in_words, one.groups)) or "the driver alone"
        rows.append(("*" * one.is_own, one.joint.words, number, told))
    heads = ("", "driver", "class", "groups")
    console.print("", grid(heads, rows, "Driven at another joint (* this scene's)"), sep="\n")


def _group_in_words(group: ClassedGroup) -> str:
    kind = group.kind or f"class {roman(group.class_number)}, order {group.order}"
    return f"{kind} ({', '.join(group.links)})"


def _show_assemblies(console: Console, every: list[SceneAssembly], at: str) -> None:
    say(console, f"\n{_counted(every)} with {at}" + (" (* this scene's)" if every else ""))
    if not every:
        return
    links = list(every[0].placement.scene.links)
    rows = []
    for one in every:
        angles = (math.degrees(math.remainder(one.placement.angles[n], math.tau)) for n in links)
        rows.append(("*" * one.is_own, one.words, *(f"{round(a, 9) + 0.0:.6g}" for a in angles)))
    heads = ("", "branch", *(f"{name} deg:" for name in links))
    console.print(grid(heads, rows, cut=("",), wraps=True))


def _counted(every: list[SceneAssembly]) -> str:
    return count(len(every), "assembly", "assemblies") if every else "no assemblies"
