"""The motion of a scene in closed form, as `solve` returns it, and on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console

from analytic.forces.efficiency import Efficiency, efficiency
from analytic.mechanism.cycle import Along
from analytic.structure.groups import Bridge
from analytic.structure.mobility import Structure, analyse
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene, driver
from reports.describe import force_tables, free_motion
from reports.describe.facts import describe_law, facts, speed_facts
from reports.describe.with_forces import (
    cleaned_forces,
    force_certainty,
    force_notes,
    left_out_notes,
    turn_with_forces,
)
from reports.output.console import print_each, say, say_each
from reports.plan.singular import continued_note, singular_note
from reports.requests.shown import Shown

if TYPE_CHECKING:
    import pandas as pd

ROWS = 13
"""Number of printed samples."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Solution(Shown, Motion):
    """The motion of a scene in closed form, with a bound of its own error at every sample.

    ``links``, ``points`` and ``sliders`` are the moving bodies, by name (`Motion`); ``forces`` the
    reactions and driving torque, where requested (`Forces`).
    """

    scene: Scene

    @cached_property
    def efficiency(self) -> Efficiency | None:
        """Loss by friction over a cycle of the scene, at its instants and as a whole, and places of
        locking; None without friction. Raises CrankcheckError for a driver that speeds up."""
        return efficiency(self.scene) if self.scene.friction else None

    def frame(self) -> pd.DataFrame:
        """Table of samples, a row each, with units: ``rocker_theta_rad``, ``C_x_m``."""
        from reports.describe.free_motion import motion_frame

        return motion_frame(self)

    def show(self, console: Console) -> None:
        acting = self.forces and cleaned_forces(self.forces)
        few = thinned(replace(self, forces=acting), ROWS)
        left = self._left_out(few)
        show_solution(console, self, few if self.time_s.size > 1 else None, left)

    def _left_out(self, few: Motion) -> str:
        """Words on the samples beside those that are printed; "" where all of them are."""
        shown, size = few.time_s.size, self.time_s.size
        return f"{shown} of {size} samples; all of them: frame()" if shown < size else ""

    def _drawn(self) -> str:
        return drawn(self.scene, with_forces=self.forces is not None)


def thinned(motion: Motion, most: int) -> Motion:
    """At most so many samples of a motion, evenly spread, the first and the last among them."""
    size = motion.time_s.size
    if size <= most:
        return motion
    kept = np.linspace(0, size - 1, most).round().astype(int)
    few = motion.each_series(lambda series: series[kept])
    acting, bound = motion.forces, motion.bound
    acting = acting and acting.stretch(kept)
    if bound is not None:
        whole = replace(motion, links=bound.links, points=bound.points, sliders=bound.sliders)
        parts = whole.each_series(lambda series: series[kept])
        bound = replace(bound, links=parts.links, points=parts.points, sliders=parts.sliders)
    return replace(few, time_s=motion.time_s[kept], bound=bound, forces=acting, conditioning={})


def drawn(scene: Scene, logged: Motion | None = None, *, with_forces: bool = False) -> str:
    """The mechanism as SVG, with the paths of a run or the reference's forces; "" where it can not
    go through a turn."""
    from reports.drawing.svg import svg

    try:
        return svg(scene, logged, with_forces=with_forces)
    except CrankcheckError:
        return ""


def show_solution(
    console: Console,
    motion: Solution,
    few: Motion | None,
    left: str = "",
    more: str = "",
    along: Sequence[Along] = (),
    *,
    clockwise: bool = False,
) -> None:
    """Print the mechanism, its extreme speeds, and the ``few`` samples of its motion, or its only
    sample in full; ``left`` says what is left out, ``more`` where to find it."""
    scene, acting = motion.scene, motion.forces is not None
    speeds = speed_facts(scene, along, clockwise=clockwise)
    say(console, heading(scene, analyse(scene), along))
    if speeds and speeds.rows:
        console.print(free_motion.speed_table(speeds), "")
    if few is None:
        _show_position(console, scene, motion)
    else:
        _show_motion(console, scene, few)
        if left:
            say(console, left, "dim")
        if acting:
            _show_largest(console, scene)
    if acting:
        say_each(console, force_tables.friction_words(scene), "")
    if more:
        say(console, more, "dim")
    told = driver.driver_place(scene, motion) is not None
    singular = singular_note(scene, motion) if told else ""
    notes = (continued_note(scene, motion), singular, *force_notes(scene, motion))
    say_each(console, filter(None, notes), "yellow")


def heading(scene: Scene, structure: Structure, along: Sequence[Along] = ()) -> str:
    """Heading of the mechanism: structure, driver, groups, and facts of the whole."""
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


def _show_position(console: Console, scene: Scene, motion: Motion) -> None:
    """Print a single position in full, with its certainty."""
    print_each(console, free_motion.position_tables(scene, free_motion.cleaned(motion)))
    told = [free_motion.certainty(motion)]
    if motion.forces is not None:
        told.append(force_certainty(scene, motion.forces))
        acting = cleaned_forces(motion.forces)
        print_each(console, force_tables.position_force_tables(scene, motion, acting))
    say(console, "\n".join(filter(None, told)), "dim")


def _show_motion(console: Console, scene: Scene, motion: Motion) -> None:
    tables = free_motion.motion_tables(scene, free_motion.cleaned(motion), console.width)
    if motion.forces is not None:
        acting = cleaned_forces(motion.forces)
        tables += force_tables.motion_force_tables(scene, motion, acting, console.width)
    print_each(console, tables)


def _show_largest(console: Console, scene: Scene) -> None:
    """Print the largest forces over a turn, closely sampled, and their means over time, where the
    driver goes through a turn."""
    try:
        turn = turn_with_forces(scene)
    except CrankcheckError:
        return
    assert turn.forces is not None
    console.print(force_tables.largest_table(scene, turn, cleaned_forces(turn.forces)), "")
    say_each(console, left_out_notes(scene, turn), "yellow")
