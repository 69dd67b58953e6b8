"""`crankcheck scenes`, `crankcheck engines`, `crankcheck export`: what there is, and its model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from analytic.kinematics import solve
from analytic.structure.groups import Bridge
from analytic.structure.mobility import analyse
from models.errors import CrankcheckError, StructureError, harmless
from models.files import KINEMATICS, find_scene, kinds, load_scene, shipped
from models.mjcf import build
from models.mjcf_options import exact
from models.motion import State
from models.scene import Scene
from reports.compare.free.kept_motion import released_state
from reports.describe.law import describe_law
from reports.judge.cell import SEGMENTS
from reports.output.columns import plain_table
from reports.output.write import check_file, write
from reports.plan.elastic import SPRINGS, held_steps, segmented
from reports.plan.free import under_control
from sim.registry import available, brought, engine


def scenes(console: Console) -> None:
    """The shipped scenes by kind: structure, driver and source."""
    for kind in kinds():
        console.print(Text(_heading(kind), "bold"))
        table = plain_table(gap=2)
        for head in ("scene", "groups", "driver", "source"):
            table.add_column(head, overflow="fold", no_wrap=head == "scene")
        for name in shipped(kind):
            scene = load_scene(name)
            table.add_row(name, _groups(scene), describe_law(scene), Text(scene.source))
        console.print(table, highlight=False)


def _groups(scene: Scene) -> str:
    """The Assur groups of a scene in solving order, a dash for one that is none of dyads."""
    try:
        parts = analyse(scene).order
        return " + ".join(part.kind for part in parts if not isinstance(part, Bridge))
    except StructureError:
        return "-"


def _heading(kind: str) -> str:
    """A kind, and how to ask for all its scenes."""
    by_name = f"all of them by `{kind}`, as in `crankcheck verify {kind}`"
    return f"{kind}: {'all of them where no scene is named' if kind == KINEMATICS else by_name}"


def engines(console: Console, settings: bool) -> None:
    """The engines: version, or the command that installs them; profiles, also with settings."""
    for entry in (*available(), *brought()):
        state = entry.version or entry.broken or f"not installed: {entry.install}"
        console.print(Text(f"{entry.name}  {state}", "bold" if entry.version else "yellow"))
        if entry.version is None:
            continue
        for profile in engine(entry.name).profiles.values():
            grid = Table.grid(padding=(0, 2, 0, 0))
            grid.add_column(no_wrap=True, min_width=12)
            grid.add_column(overflow="fold")
            grid.add_row(f"  {profile.name}", Text(profile.summary))
            if settings:
                for name, setting in profile.settings.items():
                    grid.add_row("", Text(f"{name} = {setting.value}: {setting.reason}", "dim"))
            console.print(grid)


def export(name: str, output: Path | None, close: tuple[str, ...], console: Console) -> None:
    """The MJCF of a scene, assembled at its start, into a file or to the terminal; an elastic link
    is the chain of segments that the engine is given.

    Loops are closed at the pins of ``close``, the others where `models.tree` says.
    """
    if output is not None:
        check_file(output, "-o", (".xml",), inputs=[find_scene(name)])
    own = under_control(load_scene(name))
    scene, start = opened(own)
    # Of segments the step is one that holds their fastest vibration.
    steps = (held_steps(own, SEGMENTS, SPRINGS[0]),) if own.elastic else ()
    text = build(scene, start, replace(exact(scene, *steps), close=close))
    if output is None:
        console.file.write(text)
        return
    write(output, text)
    console.print(harmless(f"{output}: MJCF of {scene.name}"), highlight=False, markup=False)


def opened(scene: Scene) -> tuple[Scene, State]:
    """What an engine is given of a scene, which of elastic links are segments, and where it begins.
    Raises CrankcheckError where it can not."""
    if scene.elastic:
        return segmented(scene)
    return scene, start_of(scene)


def start_of(scene: Scene) -> State:
    """Where a scene begins. Raises CrankcheckError where it can not."""
    try:
        return solve(scene, np.zeros(1)).state()
    except CrankcheckError:
        if not scene.is_free:
            raise
        return released_state(scene)  # of several freedoms there is no closed form
